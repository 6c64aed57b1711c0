"""Fields in Python: the two paths, operators, bounds, and what bad arguments say."""

import numpy as np
import pytest
import sardf

POINTS = np.random.default_rng(7).uniform(-6, 6, (500, 3))


def box_distance(points, half):
    """The signed distance of a block, positive inside (Hart 1996), written with numpy alone."""
    q = np.abs(points) - half
    outside = np.linalg.norm(np.maximum(q, 0), axis=1)
    return -(outside + np.minimum(q.max(axis=1), 0))


def test_double_path_is_exact():
    box = sardf.box(size=(6, 4, 2))
    np.testing.assert_allclose(box(POINTS), box_distance(POINTS, (3, 2, 1)), rtol=0, atol=1e-14)
    assert box(POINTS).dtype == np.float64


def test_float_path_follows_the_double_path():
    part = sardf.difference(
        sardf.box(size=(6, 4, 2)), sardf.cylinder(radius=1), blend=sardf.Sardf(0.5)
    )
    single = POINTS.astype(np.float32)
    values = part(single)
    assert values.dtype == np.float32
    np.testing.assert_allclose(values, part(single.astype(np.float64)), rtol=0, atol=2e-6 * 6)


def test_one_point_gives_a_number():
    assert sardf.sphere(radius=2)((0, 0, 0)) == 2.0
    assert sardf.sphere(radius=2).gradient((3, 0, 0)).tolist() == [-1, 0, 0]


def test_gradients_are_differences():
    part = sardf.union(sardf.sphere(radius=2), sardf.torus(major_radius=3, minor_radius=1))
    step, gradient = 1e-6, part.gradient(POINTS)
    for axis in range(3):
        shift = step * np.eye(3)[axis]
        numeric = (part(POINTS + shift) - part(POINTS - shift)) / (2 * step)
        assert np.quantile(np.abs(numeric - gradient[:, axis]), 0.99) < 1e-8


def test_interval_and_lipschitz_enclose():
    part = sardf.box(size=(6, 4, 2)) - sardf.cylinder(radius=1)
    low, high = part.interval((-2, -2, -1), (1, 2, 1))
    inside = POINTS[np.all((POINTS >= (-2, -2, -1)) & (POINTS <= (1, 2, 1)), axis=1)]
    values = part(inside)
    assert len(inside) > 5
    assert low <= values.min()
    assert values.max() <= high
    assert 1 <= part.lipschitz((-2, -2, -1), (1, 2, 1)) < 1.001


def test_error_bounds():
    a, b = sardf.sphere(radius=1), sardf.sphere(center=(1, 0, 0), radius=1)
    cut = 1 - 1 / np.sqrt(2)
    assert sardf.union(a, b, blend=sardf.Sardf(0.5)).error_bound() == pytest.approx(cut * 0.5)
    assert sardf.union(a, b).error_bound() == 0
    assert sardf.union(a, b, blend=sardf.RFunction()).error_bound() == np.inf
    assert sardf.union(a, b, blend=sardf.Smooth(0.8)).error_bound() == pytest.approx(0.2)


def test_exactness_labels():
    a, b = sardf.sphere(radius=1), sardf.sphere(center=(1, 0, 0), radius=1)
    assert a.exactness == ("exact", "exact")
    assert sardf.union(a, b).exactness == ("bound", "exact")
    assert sardf.intersection(a, b).exactness == ("exact", "bound")
    assert sardf.union(a, b, blend=sardf.Sardf(0.5)).exactness == ("estimate", "estimate")
    assert sardf.extrude(sardf.disc(radius=1), 2).exactness == ("exact", "exact")


def test_what_is_a_distance():
    a, b = sardf.sphere(radius=1), sardf.box(size=(1, 1, 1))
    implicit = sardf.formula("1 - x^2")
    corners = [(0, 0), (2, 0), (0, 2)]
    distances = (
        a, sardf.union(a, b, blend=sardf.Sardf(0.5)), sardf.shell(a - b, 0.1), sardf.boundary(b),
        sardf.point(at=(1, 2, 3)), sardf.trimmed_segment(a=(0, 0, 0), b=(1, 0, 0)),
        sardf.polygon(corners), sardf.extrude(sardf.polygon(corners), 2),
        sardf.normalized(implicit), sardf.at(a, point=[sardf.x, sardf.y, 0]),
        sardf.boundary(b, where=sardf.z), sardf.with_blend(a | b, blend=sardf.Smooth(0.1)),
    )  # fmt: skip
    others = (
        sardf.x, implicit, a * 2, sardf.union(a, implicit), sardf.translate(implicit, by=(1, 0, 0)),
        sardf.boundary(implicit), sardf.implicit_polygon(corners), sardf.blend_error(a | b),
        sardf.quadric(matrix=[(-1, 0, 0), (0, -1, 0), (0, 0, -1)]), sardf.gradient_length(a),
        sardf.loft([(sardf.disc(radius=1), 0), (sardf.disc(radius=2), 1)]),
    )  # fmt: skip
    assert [field.is_distance for field in distances] == [True] * len(distances)
    assert [field.is_distance for field in others] == [False] * len(others)


def test_blend_block_sets_the_operators():
    a, b = sardf.box(size=(2, 2, 2)), sardf.sphere(radius=0.8)
    with sardf.blend(sardf=0.5):
        inside = a - b
    expected = sardf.difference(a, b, blend=sardf.Sardf(0.5))
    np.testing.assert_array_equal(inside(POINTS), expected(POINTS))
    np.testing.assert_array_equal((a - b)(POINTS), sardf.difference(a, b)(POINTS))
    np.testing.assert_array_equal((a | b)(POINTS), np.maximum(a(POINTS), b(POINTS)))
    np.testing.assert_array_equal((a & b)(POINTS), np.minimum(a(POINTS), b(POINTS)))


def test_arithmetic_on_coordinates():
    x, y, z = sardf.x, sardf.y, sardf.z
    field = 4 - (x**2 + y * y) / 2 - z
    p, q, r = POINTS.T
    np.testing.assert_allclose(field(POINTS), 4 - (p**2 + q**2) / 2 - r, rtol=0, atol=1e-13)


def test_formula_with_names():
    ball = sardf.sphere(radius=2)
    field = sardf.formula("max(part, k * sin(x))", part=ball, k=3)
    expected = np.maximum(ball(POINTS), 3 * np.sin(POINTS[:, 0]))
    np.testing.assert_allclose(field(POINTS), expected, rtol=0, atol=1e-14)


def test_equal_fields_share_nodes():
    a = sardf.union(sardf.sphere(radius=1), sardf.sphere(radius=1))
    assert a((0, 0, 0)) == 1


@pytest.mark.parametrize("as_points", [list, tuple, np.array])
def test_points_of_a_plane_have_z_0(as_points):
    flat = as_points([(0.0, 1.0), (2.0, 3.0), (4.0, 1.0), (5.0, 0.0)])
    space = [(x, y, 0.0) for x, y in flat]
    at = np.random.default_rng(3).uniform(-5, 5, (50, 3))
    for make in (
        lambda points: sardf.polyline(points, closed=True),
        sardf.points,
        sardf.bspline_curve,
    ):
        np.testing.assert_array_equal(make(flat)(at), make(space)(at))
    mixed = sardf.points([(0, 0), (0, 0, 7)])
    assert mixed((0, 0, 5)) == 2


def test_second_derivatives_of_a_searched_distance():
    # A straight line as a curve: the distance in the plane across it is that to a point.
    line = sardf.bspline_curve([(-9, 0), (9, 0)], degree=1)
    bend = sardf.formula("dy(dy(line))", line=line)
    assert bend((1, 3, 4)) == pytest.approx((1 - 0.6**2) / 5, abs=1e-15)
    message = r"third derivatives of a distance found by a search \('bspline_curve'\)"
    with pytest.raises(sardf.Error, match=message):
        sardf.formula("dx(bend)", bend=bend)
    with pytest.raises(sardf.Error, match=message):
        bend.gradient((1, 3, 4))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: sardf.box(sise=1), "box has no parameter 'sise'; did you mean 'size'?"),
        (lambda: sardf.sphere(), "sphere: radius is missing; a number is accepted"),
        (lambda: sardf.sphere(radius=-1), "sphere: radius is -1; a positive number is accepted"),
        (lambda: sardf.sphere(radius="1"), "sphere: radius is '1'; a number is accepted"),
        (
            lambda: sardf.sphere(radius=float("nan")),
            "sphere: radius is nan; a positive number is accepted",
        ),
        (lambda: sardf.box(size=(1, 2)), "box: size is (1, 2); 3 numbers are accepted"),
        (
            lambda: sardf.polyline([(0, 0), (1, 2, 3, 4)]),
            "polyline: vertices is (1, 2, 3, 4); a list of points of 2 or 3 numbers is accepted",
        ),
        (lambda: sardf.polyline([(0, 0), (1, "2")]), "a list of points of 2 or 3 numbers"),
        (lambda: sardf.polyline([(0, 0), "ab"]), "a list of points of 2 or 3 numbers"),
        (lambda: sardf.translate(by=(1, 2, 3)), "field is missing; a field or a number"),
        (
            lambda: sardf.revolve(sardf.sphere(radius=1)),
            "revolve: field depends on z; a field of x and y alone is accepted here",
        ),
        (lambda: sardf.sphere(radius=1)(np.zeros((3, 2))), "points have the shape (3, 2)"),
        (lambda: sardf.sphere(radius=1)("abc"), "points are no array of numbers"),
        (lambda: sardf.blend(sardv=1), "there is no blend 'sardv'"),
    ],
)
def test_bad_arguments_say_what_is_accepted(make, message):
    with pytest.raises(sardf.Error) as caught:
        make()
    assert message in caught.value.message
