"""What parts are made of, in four Blenders: curves, parts, features, animation."""

import json

import numpy as np
import pytest
import sardf
from repository import ROOT

LINED_BORE = ROOT / "scenes/lined_bore.json"


@pytest.fixture(scope="module")
def kinds(run_check, version, tmp_path_factory):
    return run_check(version, tmp_path_factory.mktemp("kinds"), "part_kinds", LINED_BORE)


def load(scene):
    return sardf.Scene.from_json(json.dumps(scene))


def test_curves_are_where_blender_draws_them(kinds):
    for name, found in kinds["curves"].items():
        assert found["operation"] == "none"
        fields = load(found["scene"]).fields
        drawn = np.array(found["drawn"])
        assert len(drawn) >= 6
        distance = fields[name](drawn)
        assert distance.max() < 2e-5, name
        # Nowhere is the curve far from what is drawn: chords of a sixth of a unit at most.
        others = drawn + np.random.default_rng(1).normal(size=drawn.shape)
        nearest = np.linalg.norm(others[:, None] - _dense(drawn, name)[None], axis=2).min(axis=1)
        np.testing.assert_allclose(fields[name](others), nearest, atol=0.05)
        origin = fields["origin"]  # an Empty is a point, here at the world's origin
        np.testing.assert_allclose(origin([(-3.0, -1, 0), (-3, -1, 2)]), [0, 2], atol=1e-6)


def _dense(drawn, name):
    ends = np.roll(drawn, -1, axis=0)
    pairs = list(zip(drawn, ends, strict=True))
    pairs = pairs if name in ("ring", "closed", "loop") else pairs[:-1]
    steps = np.linspace(0, 1, 40)[:, None]
    return np.concatenate([a + (b - a) * steps for a, b in pairs])


def test_a_bevelled_curve_is_swept(kinds):
    solid = load(kinds["swept"]).solid
    points = [(3, 0, 0), (3, 0.5, 0), (6.5, 0, 0), (-0.5, 0, 0), (3, 0, 1.5)]
    # From (0, 0, 0) to (6, 0, 0) at twice the bevel depth of 0.25, seen from a part at (3, 1, 0).
    relative = np.array(points) - (3, 1, 0)
    np.testing.assert_allclose(solid(relative), [0.5, 0, 0, 0, -1], atol=1e-6)


def test_parts_in_parts_stand_where_their_empties_do(kinds):
    solid = load(kinds["nested"]["scene"]).solid
    turn = np.array([[np.cos(0.5), -np.sin(0.5), 0], [np.sin(0.5), np.cos(0.5), 0], [0, 0, 1]])
    local = np.array([(1.01, 0, 0), (0.99, 0, 0), (1.01, 0.5, 0), (0.99, 0.5, 0.5), (0, 0, 1.01)])
    expected = [False, False, False, True, False]
    points = 2 * local @ turn.T + (4, 0, 0)
    assert (solid(points) >= 0).tolist() == expected
    assert "contains itself: outer > middle > inner > outer" in kinds["nested"]["error"]


def test_an_imported_part_brings_its_names_along(kinds):
    original, made = sardf.load(str(LINED_BORE)), load(kinds["imported inside"])
    low, high = map(np.array, original.bounds)
    points = np.random.default_rng(2).uniform(low, high, (1000, 3))
    np.testing.assert_allclose(made.solid(points + (1000, 0, 0)), original.solid(points), atol=1e-4)
    assert made.solid([(0.0, 0, 0), (5.5, 0, 0)]).tolist() == [5, -0.5]


def test_features_make_the_rules(kinds):
    point = {"point": {"at": [1, 0, 0]}}
    skin = {"boundary": {"solid": "block"}}
    scenes = kinds["features"]
    rule = scenes["inverse_distance"]["fractions"]["inverse_distance"]["features"]
    assert rule[0] == {"at": point, "material": "red", "exponent": 2, "influence": "=exp(u/3)"}
    name = rule[1]["at"]
    assert scenes["inverse_distance"]["fields"][name] == skin
    mixture = {"functions": {"blue": f"=exp(-{name}^2)", "red": "rest"}}
    assert rule[1]["fractions"] == mixture
    name = scenes["ramp"]["fractions"]["ramp"]["field"]
    assert scenes["ramp"]["fields"][name] == point
    assert [stop["at"] for stop in scenes["ramp"]["fractions"]["ramp"]["stops"]] == [0, 0.5]
    assert scenes["partition"]["fractions"]["partition"]["of"][1]["solid"] == "block"
    materials = scenes["ramp"]["materials"]
    assert materials["red"]["color"] == [0.25, 0.5, 0.75]
    (section,) = scenes["ramp"]["sections"]
    normal = section["remove"]["half_space"]["normal"]
    np.testing.assert_allclose(normal, [0, -1, 0], atol=1e-6)
    for rule in ("inverse_distance", "blend_between"):
        made = load(scenes[rule])
        shares = made.fractions(np.random.default_rng(3).uniform(-1, 1, (50, 3)))
        np.testing.assert_allclose(shares.sum(axis=1), 1)


def test_drivers_and_keyframes_are_followed(kinds):
    scenes = kinds["animated"]["scenes"]
    for frame, minor, radius in (("1", 0.1, 0.5), ("11", 0.3, 1.5)):
        fields = scenes[frame]
        assert fields["ball"]["sphere"]["radius"] == pytest.approx(int(frame) / 2)
        assert fields["ring"]["torus"]["minor_radius"] == pytest.approx(minor)
        assert fields["solid"]["union"]["blend"]["sardf"] == pytest.approx(radius)
    between = scenes["6"]["ring"]["torus"]["minor_radius"]
    assert 0.1 < between < 0.3
    for frame, width in kinds["animated"]["half widths"].items():
        assert width == pytest.approx(max(int(frame) / 2, 1.15), rel=0.15)
