//! Times of Fidget, for bench/compare_fidget: pictures of a .vm file, and dense evaluation and
//! meshes of the three shapes of bench/shapes.hpp, by its interpreter and its compiler.
//!
//! Times are in milliseconds, the process's processor time, and wall-clock time where there is more
//! than one thread. Each line is what was measured, by which of the two, the size, and median, least
//! and greatest time.
mod shapes;

use fidget::{
    Context,
    eval::{Function, MathFunction},
    jit::JitFunction,
    raster::pixel,
    render::{RenderHints, ThreadPool},
    shape::{BoundShape, EzShape, Shape},
    vm::VmFunction,
};
use std::hint::black_box;

fn seconds() -> f64 {
    let mut t = libc::timespec {
        tv_sec: 0,
        tv_nsec: 0,
    };
    unsafe { libc::clock_gettime(libc::CLOCK_PROCESS_CPUTIME_ID, &mut t) };
    t.tv_sec as f64 + 1e-9 * t.tv_nsec as f64
}

fn time(what: &str, by: &str, size: u32, runs: usize, mut work: impl FnMut() -> f64) {
    let mut times: Vec<f64> = (0..runs).map(|_| 1e3 * work()).collect();
    times.sort_by(f64::total_cmp);
    println!(
        "{what},{by},{size},{:.3},{:.3},{:.3}",
        times[runs / 2],
        times[0],
        times[runs - 1]
    );
}

/// The picture's time with and without making the shape from the text's context.
fn picture<F: Function + MathFunction + RenderHints + Clone>(
    by: &str,
    path: &str,
    size: u32,
    runs: usize,
) {
    let text = std::fs::read(path).expect("the .vm file can be read");
    let (context, root) = Context::from_text(&text[..]).expect("the .vm file is right");
    let config = pixel::RenderConfig {
        pixel_perfect: false,
        ..pixel::RenderConfig::from_size(size.into())
    };
    let threads = pixel::EvalConfig {
        threads: None,
        ..Default::default()
    };
    time("picture", by, size, runs, || {
        let start = seconds();
        let shape = Shape::<F>::new(&context, root).unwrap();
        let bound: BoundShape<F, f32> = shape.try_into().unwrap();
        black_box(pixel::render(bound, &config, &threads));
        seconds() - start
    });
}

fn dense<F: Function + MathFunction>(by: &str, name: &str, batch: usize, runs: usize) {
    let (tree, half) = shapes::shape(name);
    let mut context = Context::new();
    let root = context.import(&tree);
    let shape = Shape::<F>::new(&context, root).unwrap();
    let tape = shape.ez_float_slice_tape();
    let mut evaluator = Shape::<F>::new_float_slice_eval();
    let (side, slices) = (256, 64);
    let (mut x, mut y, mut z) = (vec![0f32; batch], vec![0f32; batch], vec![0f32; batch]);
    let at = |half: f32, i: usize, n: usize| half * (2.0 * i as f32 / (n - 1) as f32 - 1.0);
    time(&format!("dense {name}"), by, side as u32, runs, || {
        let mut sum = 0.0;
        for first in (0..side * side * slices).step_by(batch) {
            for i in 0..batch {
                let k = first + i;
                x[i] = at(half[0], k % side, side);
                y[i] = at(half[1], k / side % side, side);
                z[i] = at(half[2], k / side / side, slices);
            }
            let start = seconds();
            black_box(evaluator.eval(&tape, &x, &y, &z).unwrap());
            sum += seconds() - start;
        }
        sum
    });
}

/// Once; the mesh is written into the folder, if there is one, for bench/mesh_error.py.
fn mesh<F: Function + MathFunction + RenderHints + Clone>(
    by: &str,
    name: &str,
    depth: u8,
    threads: usize,
    folder: Option<&str>,
) {
    let (tree, half) = shapes::shape(name);
    let mut context = Context::new();
    let root = context.import(&-tree);
    // Fidget meshes a cube of 2^depth cells along each edge; the box's longest side gives its size,
    // so that cells are cubes as everywhere else.
    let scale = half.into_iter().fold(0.0, f32::max);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = (threads > 1).then(|| ThreadPool::Custom(pool.unwrap()));
    let wall_clock = std::time::Instant::now();
    let now = || match threads {
        1 => seconds(),
        _ => wall_clock.elapsed().as_secs_f64(),
    };
    time(&format!("mesh {name}"), by, 1 << depth, 1, || {
        let start = now();
        let shape = Shape::<F>::new(&context, root).unwrap();
        let bound: BoundShape<F, f32> = shape.try_into().unwrap();
        let settings = fidget::mesh::Settings {
            depth,
            threads: pool.as_ref(),
            world_to_model: nalgebra::Matrix4::new_scaling(scale),
            ..Default::default()
        };
        let made = black_box(
            fidget::mesh::Octree::build(&bound, &settings)
                .unwrap()
                .walk_dual(),
        );
        let took = now() - start;
        if let Some(folder) = folder {
            let mut file = std::fs::File::create(format!("{folder}/{name}.stl")).unwrap();
            made.write_stl(&mut file).unwrap();
        }
        took
    });
}

fn measure(words: &[&str]) -> Option<()> {
    match *words {
        ["pictures", path, runs] => {
            let runs = runs.parse().ok()?;
            println!("what,by,size,median,least,greatest");
            for size in [1024, 4096] {
                picture::<VmFunction>("interpreter", path, size, runs);
                picture::<JitFunction>("compiler", path, size, runs);
            }
            for name in ["S1", "S2", "S3"] {
                dense::<VmFunction>("interpreter", name, 4096, runs);
                dense::<JitFunction>("compiler", name, 16384, runs);
            }
        }
        ["meshes", threads, ref folder @ ..] if folder.len() < 2 => {
            let threads = threads.parse().ok().filter(|n| *n > 0)?;
            println!("what,by,size,median,least,greatest");
            for name in ["S1", "S2", "S3"] {
                mesh::<JitFunction>("compiler", name, 8, threads, folder.first().copied());
            }
        }
        _ => return None,
    }
    Some(())
}

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    if measure(&words).is_none() {
        eprintln!("usage: fidget_bench pictures FIELD.vm RUNS | meshes THREADS [FOLDER]");
        std::process::exit(2);
    }
}
