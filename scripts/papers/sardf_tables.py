"""The tables on the page of Fayolle et al. 2004; its words are sardf_words.txt."""

# The seconds that the paper prints, on a Pentium 4: SARDF, min or max, R-function.
TIMES = (
    ("1001²", (0.05, 0.01, 0.02), (0.05, 0.01, 0.02)),
    ("10001²", (5.29, 1.42, 2.52), (4.97, 1.38, 2.56)),
    ("20001²", (21.18, 5.65, 10.09), (19.59, 5.53, 10.07)),
    ("30001²", (47.47, 12.66, 22.75), (44.07, 12.46, 22.72)),
)

OURS_WRITTEN = "[table1.md](table1.md)."
OURS_TO_MEASURE = (
    "the same grid, evaluated as sardf evaluates the nodes of a tree; the program prints the table."
)

JUMP_FORMULAS = ("(√2 - 1) / (√2 (2√2 - 1))", "3/√2 - 2")

TYPOS = (
    (
        "2.1",
        "in quadrants II and IV union and intersection equal “min and max”, in this order",
        "union = max, intersection = min",
        "cases 2 and 4 of 2.2.3 and 2.3",
    ),
    ("2.2.1, below (2)", "x₀ = d tan α, y₀ = d tan α", "d cotan α = 2d", "equation (3)"),
    (
        "2.2.1",
        "± before both roots",
        "+: the larger d, whose arc is the one nearest the origin",
        "continuity with min at the edges of cone and band",
    ),
    (
        "2.2.2",
        "± before both roots, with a minus before the quotient",
        "D = -d solves the quadratic; its smaller root",
        "as above",
    ),
    (
        "2.2.2, zone IV",
        "the centre's coordinates are d + R in magnitude",
        "D - R in magnitude: both are d + R",
        "the quadratic printed after it",
    ),
    ("2.2.3, case 1", "a minus before both quotients", "none, root +", "2.2.1; F > 0 there"),
    (
        "2.2.3, case 3, E₂",
        "f₂/f₁ ≤ 1/2 gives f₂, ≥ 2 gives f₁",
        "exchanged",
        "F = min there; zones D and F of 2.2.2",
    ),
    ("2.3, case 1", "a minus before both quotients", "none, root - in both", "f ∨ g = -(-f ∧ -g)"),
    (
        "2.3, case 3",
        "b₂ = 2f₁ + 2f₂ - 4R",
        "2f₁ + 2f₂ + 4R, minus before the quotient, root +",
        "at (-3, -3), R = 1, the printed one gives 7.54 or 0.46 in magnitude; right is 2.7071",
    ),
    (
        "2.3, case 3, not E₄",
        "f₂ < f₁ - R gives f₂, f₂ > f₁ + R gives f₁",
        "exchanged",
        "F = max there",
    ),
    ("2.2.1, 2.2.2", "a branch for a = 0", "never taken", "a is 7 or 1/4"),
    (
        "1.3.2, 3.2",
        "min and max of exact distances are the exact distance",
        "a union is exact outside only, an intersection inside only",
        "x ≥ 0 and y ≥ 0 at (-3, -4): -4, and -5 is true",
    ),
    (
        "abstract, 1, 7",
        "C1 except where both arguments are 0",
        "also not on the arcs {F = R} and {F = -2R}",
        "[above](#where-sardf-is-not-c1)",
    ),
    ("5", "a reference to “section ??”", "sections 2.2 and 2.3", "what they define"),
    (
        "6.2",
        "sections x = 0 and z = 0 in the text, x = 0 and y = 0 under Figure 24",
        "cannot be decided; chosen through the pins",
        "the figure",
    ),
    (
        "6.1, (6) and (7)",
        "dᵢ is the distance to the feature's boundary",
        "dᵢ = max(0, -f): 0 inside the feature",
        "mᵢ = Mᵢ in all of the feature",
    ),
    (
        "6.1 to 6.3",
        "features and partitions are shown, not defined",
        "M₁ = SP₁ without SP₂, M₂ = SP₂ without SP₁, the blend = SP₁ and SP₂",
        "Figures 17 and 26",
    ),
    (
        "Table 1",
        "“subdivisions 1001 * 1001”",
        "1001 points along each axis, ends included",
        "assumed",
    ),
    ("Figure 29", "parts (a) and (c)", "(a) and (b)", "the text of 6.3"),
)

CHOSEN = (
    ("5", "R; windows and levels of Figures 14 and 15", "R = 0.5; as in the commands"),
    (
        "6.1",
        "every size, R",
        "plate 10 × 6; hole of radius 1 at (1.5, 0); borders of radius 1.5 and 2.5; R = 0.5",
    ),
    ("6.1", "the line of Figure 20", "y = 0.4"),
    (
        "6.2",
        "every size, R",
        "block 10 × 10 × 6; plate 7 × 7 × 0.8 at z = -2.2; pins (0.9, 0.9, 2.2) with "
        "four grooves (0.45, 0.45, 1.2); around them a plate 8.6 × 8.6 × 1.4 and "
        "ellipsoids (1.5, 1.5, 2.6); R = 0.3; y and z exchanged",
    ),
    (
        "6.3",
        "the contours",
        "18 vertices for the tooth, 7 for the inlay, 9 for the middle contour; R = 0.5 is printed",
    ),
    ("6.3", "a solid tooth", "the contours scaled and lofted; dentin is added"),
    (
        "6",
        "materials outside the object",
        "not drawn; in sardf fractions are defined in all of space",
    ),
    ("4", "R of Table 1", "1"),
)
