"""The figures of Biswas, Shapiro and Tsukanov: what each shows, and how ours is drawn.

A figure is added here alone: as a Figure in the Part of its section, and a section as a Part in
PARTS, both in the order of the paper. scripts/make_papers --only biswas_fig08 then draws it.
"""

from papers.paper import Figure, Part

CUTTER = "scenes/diamond_cutter.json"
OURS = "docs/papers/scenes/biswas"
PLANE = "--section z=0 --window=-2,2,-0.5,3.5 --no-outline"

SECTION_1_1 = Part(
    "Section 1.1: a cutting tool of two materials",
    f"[diamond_cutter.json](../../{CUTTER}): a chip of diamond on a shank, which at the prism "
    "under the chip is 20 % silicon carbide and 80 % diamond, at the block at its other end "
    "silicon carbide alone, and in between a mixture by the distances to both.",
    (
        Figure(
            "Figure 1",
            "(a) The tool with its chip, block, prism and the region in between. (b) The share of "
            "each material on the section through the middle: it changes linearly from prism to "
            "block, and both shares add up to 1.",
            (
                f"{CUTTER} --isosurface --resolution 96",
                f"{CUTTER} --section y=0 --fraction silicon_carbide diamond --outline prism block "
                "--columns 1",
            ),
            "Every size. The chip is a part of its own, of pure diamond. Exponent 1 at both "
            "features, which is linear along a straight line from one to the other.",
        ),
    ),
)

SECTION_1_3 = Part(
    "Section 1.3: distances",
    "An S-shaped curve serves the paper for whatever is shown in the plane: it is a cubic "
    "B-spline, in the paper's words of the 4th order, in "
    "[s_curve.json](../../scenes/s_curve.json).",
    (
        Figure(
            "Figure 2",
            "(a) Level lines of the exact distance to the curve, with kinks where two of its "
            "points are equally near. (b) The same of a smooth field that is normalised to the "
            "first order. (c) A section through a field normalised to the second order, of a "
            "B-spline surface.",
            (
                f"scenes/s_curve.json {PLANE} --field u --bands 0.2",
                f"{OURS}_chords.json {PLANE} --field u --bands 0.1",
                "scenes/spline_surface.json --section x=1 --window=-2,2,-1.5,1.5 --no-outline "
                '--field "=abs(u)" --bands 0.2',
            ),
            "Both sets of control points. (b) How the field is made: of 24 chords of the curve in "
            "[biswas_chords.json](scenes/biswas_chords.json), each a line that is trimmed at its "
            "ends, joined by R-equivalence of order 1. On a chord the slope is 1; away from the "
            "curve the values are less than the distance, and at the ends of chords the level "
            "lines near the curve come closer to it. (c) The surface is the graph of a bicubic "
            "B-spline h(x, y), in [spline_surface.json](../../scenes/spline_surface.json), and the "
            "field is z - h normalised to the order 2; the plane of the section.",
        ),
        Figure(
            "Figure 3",
            "The distances to prism and block on the same section, approximated so that the first "
            "two derivatives are those of the distance at the feature.",
            (
                f'{CUTTER} --section y=0 --field "=max(0, -prism)" "=max(0, -block)" --only inside '
                "--outline prism block --columns 1 --bands 0.5",
            ),
            "The exact distances, 0 within the feature; one scale for both; levels every 0.5. Both "
            "features go on through the tool's whole width.",
        ),
    ),
)

SECTION_2 = Part(
    "Section 2: one feature",
    "Functions of the exact distance u to the curve are in "
    "[biswas_functions.json](scenes/biswas_functions.json), those with a fitted remainder in "
    "[biswas_fits.json](scenes/biswas_fits.json). They are drawn on a square of 4 × 4 around the "
    "curve.",
    (
        Figure(
            "Figure 4",
            "(a) The scheme of the expansion: a function near the curve is a series in the powers "
            "of u. (b) Exp(-1.5 u), given through the distance alone.",
            (f'scenes/s_curve.json {PLANE} --field "=exp(-1.5*u)" --bands 0.1',),
            "The curve. Of (a), which has no numbers, figures 5 and 6 are the picture.",
        ),
        Figure(
            "Figure 5",
            "The first four terms of the canonical form of exp(-1.5 u): 1, -1.5 u, 1.125 u², "
            "-0.5625 u³.",
            (
                f"{OURS}_functions.json {PLANE} --attribute term_1 term_2 term_3 term_4 "
                "--separate-scales --columns 2 --colors viridis --size 8.4,8.2",
            ),
            "The curve. Each term is made by `taylor` from the function's text; each has its own "
            "scale.",
        ),
        Figure(
            "Figure 6",
            "The sums of the first two (a) and of the first four terms (b).",
            (
                f"{OURS}_functions.json {PLANE} --attribute two_terms four_terms "
                "--limits=-1.4,1 --bands 0.2 --colors viridis --size 8.8,4.7",
            ),
            "The curve; one scale for both.",
        ),
        Figure(
            "Figure 7",
            "(a) F₀ = y exp(-1.5 u), which varies along the curve. (b) F₀ conditioned: F₀* has the "
            "same values on the curve and does not change across it. (c) F₀* - 4 u has the slope "
            "-4 there besides.",
            (
                f"{OURS}_functions.json {PLANE} --attribute F0 F0_conditioned F "
                "--separate-scales --columns 2 --colors viridis --size 8.4,8.2",
            ),
            "The curve, whose lowest points have y near 0. Reading: F₀* is F₀(p - u∇u), which is y "
            "at the closest point of the curve. It jumps where that point jumps; the paper's "
            "condition is about the curve alone.",
        ),
        Figure(
            "Figure 8",
            "A light guide that branches like a Y, with the refractive index 0.02 - 50 u². (a) The "
            "solid. (b) The section through its axes, enlarged, as a surface over the plane: "
            "smooth where two axes are equally near too.",
            (
                "scenes/grin_guide.json --isosurface --attribute refractive_index --resolution 96",
                "scenes/grin_guide.json --section z=0 --attribute refractive_index",
            ),
            "Every size in [grin_guide.json](../../scenes/grin_guide.json), so that 50 u² is of "
            "the order of 0.02. Reading: “normalized to the 12th order” is the R-equivalence of "
            "order 12 of the exact distances to three segments. (a) The solid is cut open at z = "
            "0, and ends where u is 0.008. (b) Level lines instead of a surface.",
        ),
        Figure(
            "Figure 9",
            "(a) 1 - u², which becomes negative. (b) What is wanted instead: 1 - u/(1 + u). (c) A "
            "function that is (a) near the curve and as near to (b) elsewhere as the remainder "
            "lets it be, by least squares. (d) One that is (a) near the curve and whose slope away "
            "from the curve is as near to -2 as can be.",
            (
                f"{OURS}_fits.json {PLANE} --attribute near wanted fitted_values fitted_slope "
                "--separate-scales --columns 2 --colors viridis --size 8.4,8.2",
            ),
            "The curve, the square of the splines, and 4 × 4 Gauss points on each of its 78 × 78 "
            "cells. Readings: F = 1 - u² + u³Φ with 81 × 81 bicubic B-splines for Φ, and ∇F · ∇u = "
            "-2 for (d). The root of the mean squared difference from (b) is 0.46 for (a) and "
            "0.0022 for (c), and (c) is nowhere less than 0.38. (d) reaches -2.1 and is ragged "
            "where the direction ∇u jumps, which no spline follows.",
        ),
    ),
)

SECTION_3 = Part(
    "Section 3: two features",
    "The curve, 1, and a ring around it, 2. Figures 10, 11(a) and 12 are in "
    "[biswas_two_features.json](scenes/biswas_two_features.json), 11(b) is "
    "[s_and_ring.json](../../scenes/s_and_ring.json). All distances are exact, where the paper has "
    "some that are normalised to the first order: on the features these agree to that order, away "
    "from them the values differ.",
    (
        Figure(
            "Figure 10",
            "The two features, each with its own distance and its own function.",
            (
                f"{OURS}_two_features.json --section z=0 --materials --resolution 900",
                f"{OURS}_two_features.json --section z=0 --field u1 u2 --only inside --bands 0.2 "
                "--size 8.8,4.8",
            ),
            "The curve; the ring of radius 1.9 around its middle. In the first picture each "
            "feature is as wide as what is nearer than 0.06.",
        ),
        Figure(
            "Figure 11",
            "P₁ = 1 on the curve and P₂ = 0.5 exp(-u₂²) on the ring (a) by inverse distances; (b) "
            "with the influences λ₁ = exp(60 u₁) and λ₂ = 1, by which the curve counts in its "
            "immediate neighbourhood only.",
            (
                f"{OURS}_two_features.json --section z=0 --attribute P --bands 0.05",
                "scenes/s_and_ring.json --section z=0 --fraction copper --bands 0.05 "
                "--colors viridis",
            ),
            "The features. k = 1 for both; the weights are (λu)⁻¹ as in 3.3, so that a large λ "
            "makes a feature count less. In (b) the function is the share of copper.",
        ),
        Figure(
            "Figure 12",
            "P₁ = 1 - 1.5 u₁ for the curve and P₂ = 2 for the ring, with k₂ = 1 and (a) k₁ = 1, "
            "where the slope of P₁ is lost on the curve; (b) k₁ = 2, where it is kept; (c) k₁ = 3.",
            (
                f"{OURS}_two_features.json --section z=0 --attribute k_1 k_2 k_3 "
                "--limits 0.2,2 --bands 0.2 --size 11,4.4",
            ),
            "The features; one scale for all. Readings: the text's “Figure 12(a)” for k₁ = 2 is "
            "(b); a larger k₁ makes the curve's influence smaller only where u₁ > 1, and greater "
            "where it is nearer than that.",
        ),
        Figure(
            "Figure 13",
            "A cube with a round hole and a spiral canal. The first feature is all vertical faces, "
            "the hole's too, with P₁ = 1 - u₁²/2; the second is the canal, with "
            "P₂ = 0.1 exp(-u₂²).",
            (
                f"{OURS}_cube.json --isosurface --field opened canal --resolution 80 "
                "--size 8.8,4.8",
                "scenes/cube_spiral.json --section z=0.1 --field u1 u2 --only inside "
                "--separate-scales --bands 8",
            ),
            "Every size; the canal has two turns and the radius 0.1. In "
            "[biswas_cube.json](scenes/biswas_cube.json) the cube is opened for the pictures. u₁ "
            "is the R-equivalence of order 1 of the distances to the four planes and the hole, u₂ "
            "the exact distance to the canal.",
        ),
        Figure(
            "Figure 14",
            "The interpolated function on the opened solid: (a) by inverse distances, (b) with a "
            "remainder by which it is near to a solution of Laplace's equation.",
            (
                f'{OURS}_cube.json --title "by inverse distances" --isosurface --fraction matrix '
                "--colors viridis --resolution 96",
                f'{OURS}_cube_smooth.json --title "with the remainder" --isosurface '
                "--fraction matrix --colors viridis --resolution 96",
                f'{OURS}_cube_smooth.json --section z=0.1 --field "=inverse_distance" "=smooth" '
                "--only inside --bands 0.1 --size 8.8,4.8",
            ),
            "Every size. The share of the matrix is (F - 0.1)/0.9; the last picture shows F "
            "itself. Readings: F = (P₁u₂ + P₂u₁)/(u₁ + u₂), which is defined on the features too; "
            "for (b) u₁u₂Φ is added, and the integral of |∇F|² over the solid is minimised, which "
            "leaves ∂F/∂n = 0 on top and bottom. Φ is made of 31³ tricubic B-splines "
            "as in the paper, in [biswas_cube_smooth.json](scenes/biswas_cube_smooth.json), which "
            "is solved when it is read; the integral falls from 22.82 to 21.15. "
            "[cube_spiral.json](../../scenes/cube_spiral.json) does with 16³.",
        ),
    ),
)

SECTION_4 = Part(
    "Section 4: fractions of three materials",
    "On the features of section 3. (a) is "
    "[biswas_three_materials.json](scenes/biswas_three_materials.json), (b) is "
    "[three_materials.json](../../scenes/three_materials.json).",
    (
        Figure(
            "Figure 15",
            "The shares of three materials, given on each feature so that they add up to 1 there, "
            "interpolated (a) by inverse distances, (b) with the influences "
            "λ₁ = 0.1 + 10 exp(-5 u₁²) and λ₂ = 0.5 + exp(-u₂²/2). They add up to 1 everywhere.",
            tuple(
                f"{scene}.json --section z=0 --fraction alumina zirconia steel "
                "--limits 0,0.75 --bands 0.05 --colors viridis --size 11,4.4"
                for scene in (f"{OURS}_three_materials", "scenes/three_materials")
            ),
            "The features, k = 1 and the materials' names. Reading: in P with two indices the "
            "first is the material, the second the feature, as under the paper's figure.",
        ),
    ),
)

PARTS = {
    "section_1_1": SECTION_1_1,
    "section_1_3": SECTION_1_3,
    "section_2": SECTION_2,
    "section_3": SECTION_3,
    "section_4": SECTION_4,
}
