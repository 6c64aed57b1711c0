"""The tables on the page of Biswas, Shapiro and Tsukanov; its words are biswas_words.txt."""

READINGS = (
    (
        "1.1 and 4.2",
        "the prism is 80 % SiC and 20 % diamond in 1.1, and 0.2 SiC and 0.8 diamond in 4.2",
        "4.2",
        "it states the numbers as formulas, and the prism is next to the diamond",
    ),
    (
        "Figure 15 and 4.2",
        "P with two indices is (material, feature) under the figure, (feature, material) in "
        "Theorem 1",
        "each where it stands",
        "only then do the three shares of each feature add up to 1",
    ),
    (
        "Theorem 1",
        "interpolated shares add up to 1 if and only if those of each feature do",
        "if; the converse holds on the features alone",
        "weights 0.3 and 0.7 and sums 1.28 and 0.88 give 1 too",
    ),
    (
        "3.2",
        "where u₁ is greater than u₂, W₁ is wanted to be greater than W₂",
        "W₁ less than W₂: the nearer feature weighs more",
        "equation (8)",
    ),
    (
        "3.1",
        "Wᵢ(p) = δᵢⱼ, without saying where",
        "for p on the feature Sⱼ",
        "the sentence after it",
    ),
    ("3.2", "“Figure 12(a) shows” the case k₁ = 2", "Figure 12(b)", "the caption"),
    (
        "3.2, Figure 12",
        "k₁ = 3 makes the curve's influence smaller",
        "only where u₁ > 1; nearer than that it grows",
        "at u₁ = u₂ = 1/2 the values for k₁ = 1, 2, 3 are 1.125, 0.8333, 0.6, and the curve's own "
        "is 0.25. Different exponents make weights depend on the unit of length",
    ),
    (
        "Equation (10)",
        "the factor of feature i is uᵢ to the power of the number of its terms, mᵢ",
        "as printed: values and derivatives up to the order mᵢ - 1 are kept",
        "the sentence after it",
    ),
    (
        "Figure 9(c)",
        "81 × 81 grid; F = 1 - u², with a remainder not written out",
        "81 B-splines along each axis, 78 cells; F = 1 - u² + u³Φ",
        "equation (2) with m = 2",
    ),
    (
        "Figure 9(d)",
        "∇F = -2: a vector equals a number",
        "∇F · ∇u = -2, the derivative along the distance",
        "the only direction that the feature gives",
    ),
    (
        "Figure 7",
        "F₀ is y exp(-1.5 u), and F₀* is F₀ conditioned",
        "F₀* is y at the closest point of the curve",
        "u is 0 there",
    ),
    (
        "Figure 8",
        "the distance to the Y is “normalized to the 12th order”",
        "u = (u₁⁻¹² + u₂⁻¹² + u₃⁻¹²)^(-1/12) of the exact distances to its three segments",
        "the order 12 is reached where only one segment is near",
    ),
    (
        "3.2, Figure 14",
        "both forms of the weights in (8) are called equivalent",
        "the one without negative powers: P = (P₁u₂ + P₂u₁)/(u₁ + u₂)",
        "the other is ∞/∞ on the features",
    ),
    (
        "Equation (1)",
        "a function normalized to the order m ≥ 2",
        "any of them: at the boundary the conditions leave what is farther away open",
        "only the order of its error can be compared, not its values",
    ),
    (
        "3.3",
        "the functional is minimised without a word on the boundary away from the features",
        "∂F/∂n = 0 there",
        "the natural condition of that functional",
    ),
)

CHOSEN = (
    (
        "1.1",
        "every size of the cutter",
        "a profile of 6 × 2.8, 1.6 wide; prism 1 × 0.6 around (0.5, 2.5), block 3 × 2 around "
        "(4.5, 1) of the profile",
    ),
    (
        "1.3 to 4",
        "the S-shaped curve",
        "a cubic B-spline with the control points (0.7, 2.6), (0.35, 3.05), (-0.75, 3), "
        "(-0.85, 2.05), (0, 1.5), (0.85, 0.95), (0.75, 0), (-0.35, -0.05), (-0.7, 0.4)",
    ),
    ("1.3", "the B-spline surface", "z = h(x, y), bicubic, 6 × 6 splines on a square of 4 × 4"),
    (
        "1.3",
        "the first-order field of Figure 2(b)",
        "24 trimmed chords, joined by R-equivalence of order 1",
    ),
    (
        "2.2",
        "the Y",
        "a stem from (0, -0.02) to (0, 0), branches from there to (-0.012, 0.02) and (0.012, 0.02)",
    ),
    ("2.3", "the domain of the splines", "-2 ≤ x ≤ 2, -0.5 ≤ y ≤ 3.5"),
    ("3 and 4.2", "the ring", "center (0, 1.5), radius 1.9"),
    ("3.2", "the distances of Figures 11 to 15", "exact, but for u₁ of the cube, of order 1"),
    (
        "3.3",
        "every size of the cube",
        "edges 2; hole of radius 0.25; spiral of radius 0.6, pitch 1 and two turns, its canal of "
        "radius 0.1",
    ),
)
