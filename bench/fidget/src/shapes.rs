//! The shapes of bench/shapes.hpp as Fidget's trees: positive inside, with half the size of their box.
use fidget::context::Tree;

fn constant(value: f32) -> Tree {
    Tree::constant(value.into())
}

fn sphere(x0: f32, y0: f32, z0: f32, radius: f32) -> Tree {
    let (x, y, z) = Tree::axes();
    constant(radius) - ((x - x0).square() + (y - y0).square() + (z - z0).square()).sqrt()
}

fn block(center: [f32; 3], half: [f32; 3]) -> Tree {
    let (x, y, z) = Tree::axes();
    let a = (x - center[0]).abs() - half[0];
    let b = (y - center[1]).abs() - half[1];
    let c = (z - center[2]).abs() - half[2];
    let outside = (a.max(0.0).square() + b.max(0.0).square() + c.max(0.0).square()).sqrt();
    -(outside + a.max(b.max(c)).min(0.0))
}

fn hole(x0: f32, y0: f32, radius: f32) -> Tree {
    let (x, y, _) = Tree::axes();
    constant(radius) - ((x - x0).square() + (y - y0).square()).sqrt()
}

fn torus() -> Tree {
    let (x, y, z) = Tree::axes();
    let ring = (x.square() + y.square()).sqrt() - 5.0;
    constant(1.0) - (ring.square() + z.square()).sqrt()
}

/// The SARDF intersection, written with comparisons as selects.
fn rounded(x: Tree, y: Tree, r: f32) -> Tree {
    let a = x.min(y.clone());
    let b = x.max(y);
    let d = b.clone() - a.clone();
    let limited = d.min(r);
    let fixed = limited.clone() * 0.5 - r + (constant(2.0 * r * r) - limited.square()).sqrt() * 0.5;
    let inside = a.compare(0.0).max(0.0);
    let outside = constant(0.0).compare(b.clone()).max(0.0);
    let (p, n) = (a.clone(), -b);
    let (dp, dn) = (d.min(p.clone()), d.min(n.clone()));
    let root = (p.clone() * 2.0 * (p.clone() + dp.clone()) - dp.square() * 3.0).sqrt();
    let grown = inside.and((dp * 2.0 - p * 3.0 + root) * (1.0 / 7.0))
        + outside.and((n.clone() * 8.0 * (n.clone() + dn.clone())).sqrt() - n * 3.0 - dn);
    a + grown.max(fixed)
}

/// Sixteen spheres with a box taken off.
fn spheres() -> Tree {
    let mut f = sphere(-0.75, -0.75, 0.0, 0.3);
    for i in 1..16 {
        let (x, y) = (0.5 * (i / 4) as f32 - 0.75, 0.5 * (i % 4) as f32 - 0.75);
        f = f.max(sphere(x, y, 0.0, 0.3));
    }
    f.min(-block([0.0, 0.0, 0.25], [0.9, 0.25, 0.25]))
}

/// A block with five holes and a torus, joined by minima or by SARDF of radius 0.5.
fn block_with_holes(blended: bool) -> Tree {
    let join = |x: Tree, y: Tree| {
        if blended {
            rounded(x, y, 0.5)
        } else {
            x.min(y)
        }
    };
    let mut f = block([0.0; 3], [10.0, 6.0, 4.0]);
    for (x, y, r) in [
        (0.0, 0.0, 3.0),
        (8.0, 4.0, 1.0),
        (-8.0, 4.0, 1.0),
        (8.0, -4.0, 1.0),
        (-8.0, -4.0, 1.0),
    ] {
        f = join(f, -hole(x, y, r));
    }
    -join(-f, -torus())
}

/// "S1", "S2" or "S3".
pub fn shape(name: &str) -> (Tree, [f32; 3]) {
    match name {
        "S1" => (spheres(), [1.05 * 1.1, 1.05 * 1.1, 0.3 * 1.1]),
        "S2" => (block_with_holes(false), [11.0, 6.6, 4.4]),
        "S3" => (block_with_holes(true), [11.0, 6.6, 4.4]),
        _ => panic!("there is no shape '{name}'; accepted are S1, S2 and S3"),
    }
}
