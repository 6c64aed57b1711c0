"""Rules as fields, attributes with constraints, and warnings, in Python."""

import numpy as np
import pytest
import sardf

POINTS = np.array([[1.0, 0, 0], [0.0, 0, 0], [4.0, 0, 0], [0.5, 2, -1]])
MATERIALS = {"a": {}, "b": {}}


def test_value_of_takes_a_dictionary_with_fields():
    near, far = sardf.point(at=(0, 0, 0)), sardf.point(at=(4, 0, 0))
    value = 1 - 1.5 * near
    rule = {
        "inverse_distance": {
            "features": [
                {"at": near, "value": value, "exponent": 2},
                {"at": far, "value": 3, "influence": "=exp(0.5*u)"},
            ]
        }
    }
    field = sardf.value_of(rule, scale=10)
    u, v = np.linalg.norm(POINTS, axis=1), np.linalg.norm(POINTS - [4, 0, 0], axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        a, b = u**-2.0, 1 / (v * np.exp(0.5 * v))
        expected = (a * (1 - 1.5 * u) + b * 3) / (a + b)
    expected[1:3] = 1, 3
    np.testing.assert_allclose(field(POINTS), expected, atol=1e-14)
    scene = sardf.Scene(solid=sardf.sphere(radius=2), attributes={"hardness": field})
    again = sardf.Scene.from_json(scene.to_json())
    np.testing.assert_array_equal(again.attributes["hardness"](POINTS), field(POINTS))


def test_value_of_says_what_is_wrong():
    with pytest.raises(sardf.Error, match="there is no rule 'inverse_distanc'"):
        sardf.value_of({"inverse_distanc": {}})
    with pytest.raises(sardf.Error, match="needs 'value'"):
        sardf.value_of({"inverse_distance": {"features": [{"at": sardf.x}]}})
    with pytest.raises(sardf.Error, match="scale is -1"):
        sardf.value_of({"ramp": {"field": sardf.x, "stops": [{"at": 0, "value": 1}]}}, scale=-1)
    with pytest.raises(sardf.Error, match="rule is missing"):
        sardf.value_of()


def test_boundary_has_faces_and_a_trimming_field():
    box = sardf.box(size=(2, 2, 2))
    top = sardf.boundary(box, faces=[5])
    np.testing.assert_allclose(top(np.array([[0.0, 0, 3], [0, 3, 1]])), [2, 2])
    with pytest.raises(sardf.Error, match="there is no face 6"):
        sardf.boundary(box, faces=[6])
    half = sardf.boundary(sardf.sphere(radius=1), where=sardf.z)
    np.testing.assert_allclose(half(np.array([[0.0, 0, 1], [0, 0, -1]])), [0, 1], atol=1e-15)


def test_attributes_may_be_unit_vectors_or_have_names():
    scene = sardf.Scene(
        solid=sardf.sphere(radius=2),
        attributes={
            "grain": {"value": [sardf.x, sardf.y, 0], "unit_vector": True, "fallback": "y"},
            "stress": {"value": {"components": {"xx": 1, "xy": sardf.x}}},
        },
    )
    grain = scene.attributes["grain"](np.array([[3.0, 4, 0], [0, 0, 1]]))
    np.testing.assert_allclose(grain, [[0.6, 0.8, 0], [0, 1, 0]])
    stress = scene.attributes["stress"](POINTS)
    assert list(stress) == ["xx", "xy"]
    np.testing.assert_array_equal(stress["xx"], 1)
    np.testing.assert_array_equal(stress["xy"], POINTS[:, 0])


def test_scenes_warn_of_contradictions():
    def crossing(height):
        return sardf.Scene(
            solid=sardf.sphere(radius=2),
            materials=MATERIALS,
            fractions={
                "inverse_distance": {
                    "features": [
                        {"at": sardf.segment(a=(-1, 0, 0), b=(1, 0, 0)), "material": "a"},
                        {"at": sardf.segment(a=(0, -1, height), b=(0, 1, height)), "material": "b"},
                    ]
                }
            },
        )

    (warning,) = crossing(0).warnings()
    assert warning.startswith("the fractions: features 1 and 2 touch at (0, 0, 0)")
    assert crossing(0.1).warnings() == []
    with pytest.raises(sardf.Cancelled):
        crossing(0).warnings(progress=lambda share: False)


def test_functions_must_sum_to_one():
    def scene(a, b):
        return sardf.Scene(
            solid=sardf.box(size=(1, 1, 1)),
            materials=MATERIALS,
            fractions={"functions": {"a": a, "b": b}},
        )

    u = sardf.point(at=(0, 0, 0))
    values = scene(0.2 + 0.3 * u, 0.8 - 0.3 * u).fractions(POINTS[:1])
    np.testing.assert_allclose(values, [[0.5, 0.5]])
    np.testing.assert_allclose(scene(0.25 + 0 * u, "rest").fractions(POINTS[:1]), [[0.25, 0.75]])
    with pytest.raises(sardf.Error, match="they must sum to 1"):
        scene(0.2 + 0.3 * u, 0.8 - 0.2 * u)
