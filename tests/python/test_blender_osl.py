"""OSL shaders of scenes, run by Cycles in bpy, against the core. Debian's has no OSL."""

import json
import os
import re

import numpy as np
import pytest
import sardf
from blender_runs import (
    GRADED_SPHERE,
    SCRIPTS,
    expected_colors,
    run_script,
    write_scene,
)
from repository import ROOT
from scene_json import load_document

EVERYTHING = ROOT / "tests/scenes/everything.json"
# Fields whose values come from a search, a file or a sum of splines: no formula.
DATA = {"vein", "loop", "sheet", "tube", "corner", "slope_of_corner", "away", "between", "hill",
        "solved", "unsolved"}  # fmt: skip
FORMULAS = {
    "f_trigonometry": "=sin(x) + 2*cos(y) + tan(0.3*z)",
    "f_inverse": "=asin(x/4) + acos(y/4) + atan2(x, y + 0.01)",
    "f_powers": "=exp(0.3*x) + log(abs(y) + 0.1) + pow(abs(z) + 0.1, 1.7) + x^3 + sqrt(abs(x))",
    "f_steps": "=floor(1.3*x) + min(x, y) - max(y, z) + clamp(z, -1, 0.5)",
    "f_quotient": "=x / (2 + y^2) - -z",
    "f_pieces": "=fract(x) + sign(y) + step(0.2, z) + smoothstep(-1, 1, x) + mod(y, 0.7)",
    "f_equal": "=(floor(x) == 1) * z",
}
MATERIALS = {"a": {"roughness": 0.1}, "b": {"roughness": 0.9}, "c": {"roughness": 0.4}}
BALL, CUBE = {"sphere": {"radius": 2}}, {"box": {"center": [1, 1, 0], "size": [3, 3, 3]}}
BLENDS = ({"sardf": 0.8}, {"sardf_c1": 0.8}, {"smooth": 0.5}, "r_function", "min_max")
MORE = {
    f"blend_{place}_{kind}": {kind: {"of": [BALL, CUBE], "blend": blend}}
    for place, blend in enumerate(BLENDS)
    for kind in ("union", "intersection", "difference")
} | {
    "half": {"half_space": {"point": [0.1, 0, 0], "normal": [1, 2, 3]}},
    "lofted": {"loft": {"sections": [
        {"field": {"disc": {"radius": 1}}, "z": -2},
        {"field": {"box2d": {"size": [2, 1]}}, "z": 0},
        {"field": {"disc": {"radius": 2}}, "z": 1.5},
    ]}},
    "copies": {"repeat": {"field": {"sphere": {"radius": 0.5}}, "spacing": [2, 0, 0]}},
    "shares": {"value_of": {"rule": {"inverse_distance": {"features": [
        {"at": {"point": {"at": [-2, 0, 0]}}, "value": 1, "exponent": 2},
        {"at": {"point": {"at": [2, 1, 0]}}, "value": 5, "exponent": 2},
        {"at": {"point": {"at": [0, 3, 1]}}, "value": 3, "exponent": 2},
    ]}}}},
}  # fmt: skip


def scene_of(document, attributes):
    used = document | {"attributes": attributes, "solid": {"sphere": {"radius": 9}}}
    for key in ("sections", "view", "bounds", "lipschitz", "blend"):
        used.pop(key, None)
    used |= {"materials": MATERIALS, "fractions": {"inverse_distance": {"features": [
        {"at": {"point": {"at": at}}, "material": name, "exponent": 2}
        for name, at in zip(MATERIALS, ([-2, 0, 0], [2, 1, 0], [0, 3, 1]), strict=True)
    ]}}}  # fmt: skip
    return sardf.Scene.from_json(json.dumps(used))


@pytest.fixture(scope="module")
def fields():
    """(document, {field: what a shader cannot do with it}) of every constructor's scene."""
    document = load_document(EVERYTHING)
    document["fields"] |= MORE
    here = os.getcwd()
    os.chdir(EVERYTHING.parent)  # where its meshes are
    try:
        refused = {}
        for name in document["fields"]:
            try:
                scene_of(document, {f"a_{name}": name}).osl([f"a_{name}"])
            except sardf.Error as error:
                refused[name] = str(error)
        names = [name for name in document["fields"] if name not in refused]
        attributes = {f"a_{name}": name for name in names} | FORMULAS
        yield scene_of(document, attributes), list(attributes), refused
    finally:
        os.chdir(here)


def test_what_has_no_formula_is_named(fields):
    _, _, refused = fields
    assert set(refused) <= DATA
    assert {"vein", "corner", "hill"} <= set(refused)
    for name, text in refused.items():
        assert "has no formula that OSL could evaluate; bake it into textures instead" in text, name


def test_a_shader_has_no_normals_and_names_wrong_channels():
    scene = sardf.Scene.from_json(json.dumps(GRADED_SPHERE))
    with pytest.raises(sardf.Error, match="'normal' is no channel of a shader"):
        scene.osl(["normal"])
    with pytest.raises(sardf.Error, match="did you mean 'base_color'"):
        scene.osl(["base_colour"])


def test_outputs_have_names_of_their_own():
    document = GRADED_SPHERE | {
        "materials": {"red": {}, "fraction red": {}, "color": {}},
        "fractions": {"constant": {"red": 1}},
        "attributes": {"P": ["=x", "=y", 0], "fraction_red": "=z"},
    }
    scene = sardf.Scene.from_json(json.dumps(document))
    _, outputs = scene.osl(["fractions", "P", "fraction_red", "base_color"])
    assert outputs == {
        "fraction_red": "red", "fraction_fraction_red": "fraction red", "fraction_color": "color",
        "P_1": "P_1", "P_2": "P_2", "P_3": "P_3", "fraction_red_2": "fraction_red",
        "base_color": "base_color",
    }  # fmt: skip


def operations():
    """The names of all operations, as their structs say them; blends have three, shares and sums
    are of two or more."""
    names = set()
    for header in (ROOT / "core/sardf").glob("ops_*.hpp"):
        names |= set(re.findall(r'name = "(\w+)"', header.read_text()))
    blends = {"sardf", "sardf_c1", "smooth", "r_function", "min_max"}
    numbered = {"inverse_share_", "weighted_sum_"}
    assert blends | numbered < names
    booleans = {f"{blend}_{join}" for blend in blends for join in ("union", "difference")}
    of_three = {"inverse_share_3_1", "inverse_share_3_2", "inverse_share_3_3", "weighted_sum_3"}
    return names - blends - numbered | booleans | of_three


def test_cycles_computes_what_the_core_computes(fields, tmp_path):
    """At 1024 points for each field of everything.json, which has every constructor, and for each
    function of formulas."""
    scene, names, _ = fields
    text, outputs = scene.osl([*names, "roughness", "fractions"])
    shader, result = tmp_path / "fields.osl", tmp_path / "values.npz"
    shader.write_text(text)
    done = run_script("5.0.1", SCRIPTS / "osl_fields.py", shader, result,
                      user_folder=tmp_path / "user")  # fmt: skip
    assert result.is_file(), done.stdout + done.stderr
    with np.load(result) as arrays:
        found = dict(arrays)
    assert list(found["names"]) == list(outputs)
    points = found["positions"]
    assert np.ptp(points, axis=0).min() > 2
    shares = scene.fractions(points)
    known = dict(zip(MATERIALS, shares.T, strict=True)) | {"roughness": shares @ [0.1, 0.9, 0.4]}
    worst = {}
    for column, name in enumerate(outputs.values()):
        expected = known[name] if name in known else scene.attributes[name](points)
        error = np.abs(found["values"][:, column] - expected)
        allowed = 2e-4 * (1 + np.abs(expected))
        # Where a value jumps or is not defined, a rounding decides.
        worst[name] = [float(np.nanpercentile(error / allowed, 97)), float(np.nanmax(error))]
    print(json.dumps(worst, indent=0))
    assert {name: w for name, w in worst.items() if w[0] > 1} == {}
    assert not operations() - set(re.findall(r"float sardf_([a-z]\w+?)_\d+\(", text))


@pytest.fixture(scope="module")
def exact(run_check, version, tmp_path_factory):
    folder = tmp_path_factory.mktemp("exact")
    found = run_check(version, folder, "bake_exact", write_scene(folder, GRADED_SPHERE))
    return version, found


def test_a_rendered_part_has_the_same_pixels_by_shader_and_by_textures(exact):
    version, found = exact
    if version == "3.4.1":
        assert not found["is there"]
        assert found["nodes"] == []
        assert found["finished"]  # with textures alone
        return
    assert found["is there"]
    assert found["nodes"] == ["sardf exact", "sardf exact switch"]
    assert found["switch"] == 1
    points = np.array(found["positions"])
    inside = np.linalg.norm(points, axis=-1) > 4  # of a ball of radius 5; 0 beside it
    assert inside.sum() > 500
    by_shader, by_textures = (np.array(found[kind])[inside] for kind in ("shader", "textures"))
    expected = expected_colors(points[inside])
    print(np.abs(by_shader - expected).max(), np.abs(by_textures - expected).max())
    assert np.abs(by_shader - expected).max() < 1e-5
    assert np.abs(by_textures - by_shader).max() < 0.004
    assert np.abs(by_textures - by_shader).max() > 1e-6  # they are two ways


def test_baking_again_without_the_shader_connects_the_textures(exact):
    version, found = exact
    if version != "3.4.1":
        assert found["nodes after"] == []
    assert found["base color from"] == "sardf base_color"
