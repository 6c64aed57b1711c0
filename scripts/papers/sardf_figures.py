"""The figures of Fayolle et al. 2004: what each shows, and how ours is drawn."""

from papers.paper import Figure, Part

CORNER = "docs/papers/scenes/corner.json --section z=0"
PLATE = "scenes/cad_plate.json --section z=0"
SLICE = "scenes/tooth_slice.json --section z=0"
PINS = "scenes/cad_pins.json"
ZONES = "--outline growing_arcs fixed_arcs --no-outline"
BLENDS = "--blend sardf=0.5 sardf_c1=0.5 min_max r_function smooth=0.5"

OPERATIONS = Part(
    "Section 2: the operations",
    "The corner x ≥ 0 and y ≥ 0, whose fields are x and y, is "
    "[corner.json](scenes/corner.json), with R = 1. Its level lines are what the "
    "operations are made of: {F = d} is the corner {min = d} rounded by an arc.",
    (
        Figure(
            "Figure 1",
            "Level lines of min(x, y): every one of them turns at a right angle on the diagonal.",
            (
                f"{CORNER} --window=-1,4,-1,4 --field corner --blend min_max --no-outline --lines "
                "0.5",
            ),
            "Levels: every 0.5.",
        ),
        Figure(
            "Figure 2",
            "The idea: one level line with its sharp corner, and the same line with an arc in "
            "its place.",
            (f"{CORNER} --window=-1,4,-1,4 --field corner_min corner --no-outline --lines 1.5,",),
            "The level: 1.5.",
        ),
        Figure(
            "Figure 3",
            "Without a limit the arc's radius is the level itself, so that the rounding, and "
            "with it the error, grows without bound.",
            (
                f"{CORNER} --window=-1,8,-1,8 --field corner --blend sardf=100 sardf=1 "
                "--no-outline --bands 0.5",
            ),
            "R = 100 on the left: within the window the limit is never reached. On the right R = "
            "1.",
        ),
        Figure(
            "Figure 4",
            "The first quadrant's zones: I, where arcs grow (B, between two lines through the "
            "origin with slopes 2 and 1/2; A and C beside it), and II beyond the arc {F = R}, "
            "where the radius stays R between the lines y = x ± R.",
            (f"{CORNER} --window=0,4,0,4 --field corner {ZONES}",),
            "R = 1. The fields `growing_arcs` (zone B) and `fixed_arcs` (the band of zone II) "
            "outline the zones.",
        ),
        Figure(
            "Figure 5",
            "As Figure 2, for the growing arc of zone I.",
            (
                f'{CORNER} --window=0,2.5,0,2.5 --blank --outline "=corner_min - 0.7" level_1 '
                "--no-outline",
            ),
            "The level: d = 0.7, drawn once as {min = d} and once as {F = d}.",
        ),
        Figure(
            "Figure 6",
            "A level in zone B as part of a circle: centre (2d, 2d), radius d, tangent to both "
            "rays where they cross the two lines of slope 2 and 1/2.",
            (
                f"{CORNER} --window=0,2.5,0,2.5 --blank --outline level_1 circle_1 growing_arcs "
                "--no-outline",
            ),
            "d = 0.7.",
        ),
        Figure(
            "Figure 7",
            "A level in zone II: the circle has the radius R and the centre (d + R, d + R).",
            (
                f"{CORNER} --window=0,4,0,4 --blank --outline level_2 circle_2 fixed_arcs "
                "--no-outline",
            ),
            "d = 1.6, R = 1.",
        ),
        Figure(
            "Figure 8",
            "The third quadrant's zones: III, where arcs grow (E; D and F beside it), and IV "
            "beyond the arc {F = -2R}, where the radius stays R between y = x ± R.",
            (f"{CORNER} --window=-4,0,-4,0 --field corner {ZONES}",),
            "R = 1.",
        ),
        Figure(
            "Figure 9",
            "A level in zone E: with e = -d the circle has the centre (-e/2, -e/2) and the "
            "radius e/2.",
            (
                f"{CORNER} --window=-3,0.2,-3,0.2 --blank --outline level_3 circle_3 growing_arcs "
                "--no-outline",
            ),
            "d = -1.4.",
        ),
        Figure(
            "Figure 10",
            "A level in zone IV: radius R, centre (d + R, d + R), whose coordinates are negative "
            "here.",
            (
                f"{CORNER} --window=-4,0,-4,0 --blank --outline level_4 circle_4 fixed_arcs "
                "--no-outline",
            ),
            "d = -2.6, R = 1.",
        ),
    ),
)

ERROR = Part(
    "Section 3: the error of one operation",
    "This is the error against min and max; the one against the true distance is "
    "[below](#how-exact-is-the-distance).",
    (
        Figure(
            "Figure 11",
            "Figure 4 again, as the place where the error is looked for: only in zone B and in "
            "the band is F not min.",
            (f"{CORNER} --window=0,4,0,4 --field corner_min corner {ZONES}",),
            "R = 1; min on the left for comparison.",
        ),
        Figure(
            "Figure 12",
            "(a) The error at a point: how far the rounded level is from the sharp one. (b) The "
            "error across the band: none at its edges, most on the diagonal, where it is (1 - "
            "1/√2) R = 0.292893 R.",
            (
                f'{CORNER} --window=1.2,3.2,1.2,3.2 --blank --outline "=corner_min - 1.6" level_2 '
                "--no-outline",
                f'{CORNER} --window=0,4,0,4 --segment "1.5,3.5,0" "3.5,1.5,0" --field corner '
                "--error --no-outline",
            ),
            "Drawn along the segment from (1.5, 3.5) to (3.5, 1.5), R = 1. The sign is that of F "
            "- min.",
        ),
    ),
)

UNIONS = Part(
    "Section 5: unions of two ellipsoids",
    "[two_ellipsoids.json](../../scenes/two_ellipsoids.json): centres and radii are the paper's.",
    (
        Figure(
            "Figure 14",
            "Level lines inside the union, joined by SARDF, max and the R-function (a, b, c), "
            "and enlarged where the two ellipsoids meet (d, e, f). SARDF and max differ only "
            "near the seam, where SARDF has no corners; the R-function's values are up to twice "
            "the distance.",
            (
                "scenes/two_ellipsoids.json --section y=0 --window=-1,11,-11,3 --only inside "
                f"{BLENDS} --bands 0.25 --separate-scales",
                f"scenes/two_ellipsoids.json --section y=0 --window=5.5,8.5,-4.2,-0.8 {BLENDS} "
                "--bands 0.15",
            ),
            "R = 0.5, the window, the enlarged part and the levels: every 0.25, below every 0.15.",
        ),
        Figure(
            "Figure 15",
            "The same outside: max has corners on level lines around the concave edges, SARDF "
            "rounds them, and far away the R-function's levels are too wide apart.",
            (
                "scenes/two_ellipsoids.json --section y=0 --window=-3,13,-13,5 --only outside "
                f"{BLENDS} --bands 0.5",
            ),
            "R = 0.5, the window and the levels, every 0.5.",
        ),
    ),
)

TREE_16 = """\
The tree, Figure 16b:

```text
part = difference, sardf R = 0.5      (x without y: the intersection of x and -y)
├── plate: box                        the paper's Box_G
└── hole: disc                        the paper's Cylinder_G
```
"""

CAD_2D = Part(
    "Section 6.1: a plate in two dimensions",
    "[cad_plate.json](../../scenes/cad_plate.json). The paper prints the trees and no "
    "sizes; its dimensions are ours in all of these figures: plate 10 × 6, hole of "
    "radius 1 at (1.5, 0), borders of radius 1.5 and 2.5, R = 0.5.",
    (
        Figure(
            "Figure 16",
            "(a) The part: a rectangle with a round hole. (b) Its tree.",
            (f"{PLATE} --field part",),
            "All sizes; see above.",
            TREE_16,
        ),
        Figure(
            "Figure 17",
            "The partitions SP₁ and SP₂, where the materials exist (a, b); the features M₁ and "
            "M₂, where each is pure (c, d); and the zone where they blend (e).",
            (
                f'{PLATE} --field "=space_1 >= 0" "=space_2 >= 0" "=feature_1 >= 0" "=feature_2 '
                '>= 0" "=blend_zone >= 0" --bands 2 --lines none --colors Blues --columns 3 '
                '--title "" --resolution 800',
            ),
            "M₁ = SP₁ without SP₂, M₂ = SP₂ without SP₁, the zone = SP₁ and SP₂: what the figure "
            "and the text imply.",
        ),
        Figure(
            "Figure 18",
            "The distance d₁ to the first feature by R-functions (a) and by SARDF (b).",
            (f"{PLATE} --field d1 --blend r_function sardf=0.5 --only inside --bands 0.25",),
            "One scale for both; levels every 0.25. d₁ is 0 inside the feature.",
        ),
        Figure(
            "Figure 19",
            "The distance d₂ to the second feature by R-functions (a) and by SARDF (b). At the "
            "left edge the R-function gives three times the distance.",
            (f"{PLATE} --field d2 --blend r_function sardf=0.5 --only inside --bands 1.0",),
            "One scale for both; levels every 1.",
        ),
        Figure(
            "Figure 20",
            "Both materials' weights along a line through the part: 1 in one's own feature, 0 in "
            "the other's, a ramp in between. M₁ = M₂ = 1, so weights are fractions.",
            (f'{PLATE} --segment "-5.5,0.4,0" "5.5,0.4,0" --fraction steel bronze --only inside',),
            "The line: y = 0.4. Nothing is drawn in the hole.",
        ),
        Figure(
            "Figure 21",
            "The materials in colours with stripes, trees joined by SARDF (a) and by R-functions "
            "(b), whose stripes are of uneven widths.",
            (f"{PLATE} --materials --stripes 11 --blend sardf=0.5 r_function",),
            "Eleven stripes, so that both pure materials are light.",
        ),
    ),
)

CAD_3D = Part(
    "Section 6.2: a block with four pins",
    "[cad_pins.json](../../scenes/cad_pins.json). The trees are the paper's, every size "
    "is ours, and y and z are exchanged, so that the pins stand upright. R = 0.3. The "
    "paper's SP₁ is `block` without `insert`, SP₂ is `blend_region`, M₁ is `matrix` and "
    "M₂ is `insert`.",
    (
        Figure(
            "Figure 22",
            "The two partitions of space: the block without plate and pins (a), a wider region "
            "around plate and pins (b); the gradient of colours is the common part.",
            (
                f'{PINS} --isosurface --field "=min(block, min(-insert, y + 2))" '
                '"=min(blend_region, y + 2)" --view "0.5,-1,0.6" --resolution 96',
            ),
            "Both are cut open by y ≥ -2 to show what is inside.",
        ),
        Figure(
            "Figure 23",
            "The features: pure first material, cut open (a), plate and pins with one pin "
            "enlarged (b), both together (c). A pin is an ellipsoid without the union of four "
            "slimmer ones.",
            (
                f'{PINS} --isosurface --field "=min(matrix, y + 2)" insert "=min(insert, 1.1 - '
                'length(x - 2, y + 2))" "=min(max(matrix, insert), y + 2)" --view "0.5,-1,0.6" '
                "--resolution 96 --columns 2",
            ),
            "Cut open by y ≥ -2; the pin at (2, -2) with the plate below it.",
        ),
        Figure(
            "Figure 24",
            "The materials on sections through the object, blue for the first and red for the "
            "second, and enlarged around one pin.",
            (
                "scenes/cad_pins_cut.json --isosurface --resolution 96",
                f"{PINS} --section y=-2 --fraction copper --materials --outline insert --columns 1",
                f"{PINS} --section z=-0.3 --window=0.2,3.8,0.2,3.8 --materials --stripes 11 "
                "--outline insert blend_region",
            ),
            "The planes: text and caption disagree (x = 0 and z = 0, x = 0 and y = 0), and in "
            "our axes the pins are cut by y = -2 and z = -0.3. Stripes are added to the enlarged "
            "part.",
        ),
    ),
)

TOOTH = Part(
    "Section 6.3: a tooth with an inlay",
    "[tooth_slice.json](../../scenes/tooth_slice.json), and as a solid "
    "[tooth.json](../../scenes/tooth.json). The paper draws the contours by hand over a "
    "photograph and prints no coordinates: ours are chosen. R = 0.5 is printed.",
    (
        Figure(
            "Figure 25",
            "A photograph of a tooth with the three contours drawn over it: the tooth, the "
            "inlay, and the middle contour that ends the blend.",
            (f"{SLICE} --blank --outline middle inlay",),
            "All contours; there is no photograph.",
        ),
        Figure(
            "Figure 26",
            "The contours as fields: tooth (a), inlay (b), middle contour (c).",
            (f"{SLICE} --field outer inlay middle --no-outline --bands 0.5 --lines 0,",),
            "A contour's field is the monotone formula over the lines of its edges, not the "
            "distance to the polygon; the line is its zero level.",
        ),
        Figure(
            "Figure 27",
            "The share of the inlay's material, the darker the more, by SARDF (a) and by "
            "R-functions (b).",
            (
                f'{SLICE} --field "=w2" --blend sardf=0.5 r_function --only inside --colors '
                "bone_r --outline middle inlay",
                "scenes/tooth_cut.json --isosurface --resolution 128",
            ),
            "The second picture is ours: the contours lofted into a molar of enamel and dentin, "
            "cut open.",
        ),
        Figure(
            "Figure 28",
            "Figure 27a with stripes, and a circle around what Figure 29 enlarges.",
            (
                f'{SLICE} --field "=w2" --only inside --window=-4.6,4.6,-0.8,5.4 --stripes 20 '
                "--limits=0,1 --colors coolwarm",
            ),
            "20 stripes, as bands of colour; the roots are left out. The materials of "
            "`tooth_slice.json` have stripes of their own, for Blender and POV-Ray; they are "
            "in Figure 29.",
        ),
        Figure(
            "Figure 29",
            "Part of Figure 28 enlarged, by SARDF (a) and by R-functions, (c) in the caption. "
            "SARDF's stripes follow the contour and are evenly spaced; the R-function's bunch up "
            "at the inlay.",
            (
                f"{SLICE} --window=0.5,3.2,0,4.6 --materials --blend sardf=0.5 r_function "
                "--resolution 900",
            ),
            "The enlarged part: the right side of the inlay.",
        ),
        Figure(
            "Figure 30",
            "Both materials' shares along y = 2: the contours with the line above, below it the "
            "tooth's share and the inlay's.",
            (
                f'{SLICE} --segment "-4.5,2,0" "4.5,2,0" --field "=w1" "=w2" --separate-scales '
                "--only inside --blank --outline middle inlay",
            ),
            "y = 2 is printed; the contours are ours.",
        ),
    ),
)

CREASE = Figure(
    "crease",
    "The length of the gradient, in the plane and along x = y",
    (
        f"{CORNER} --window=-4,4,-4,4 --field corner corner_c1 --gradient --no-outline",
        'docs/papers/scenes/corner.json --segment "-3,-3,0" "3,3,0" --field corner corner_c1 '
        "--gradient",
    ),
)

TREE_ERROR = Figure(
    "error",
    "Error of the plate and of the tooth's contour",
    (
        f"{PLATE} --field part --error",
        f"{SLICE} --field outer --error",
    ),
)

PARTS = {
    "operations": OPERATIONS,
    "error": ERROR,
    "unions": UNIONS,
    "cad_2d": CAD_2D,
    "cad_3d": CAD_3D,
    "tooth": TOOTH,
}
