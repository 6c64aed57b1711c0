"""Parts made of Blender objects, in four Blenders: objects as fields, files."""

import json
import os
import re

import numpy as np
import pytest
import sardf
from repository import ROOT
from scene_json import load_document

ADDON = ROOT / "blender_addon"
SCENES = [*sorted((ROOT / "scenes").glob("*.json")), ROOT / "tests/scenes/everything.json"]

QUICK = [path for path in SCENES if path.stem != "cube_spiral"]  # it solves for thousands


@pytest.fixture(scope="module")
def shapes(run_check, version, tmp_path_factory):
    folder = tmp_path_factory.mktemp("shapes")
    return run_check(version, folder, "part_shapes", folder)


def inside(kind, values, points):
    """Whether points in an object's own frame are inside a primitive, by its definition."""
    x, y, z = points.T
    across = np.hypot(x, y)
    if kind in ("sphere", "ellipsoid", "formula"):
        return x**2 + y**2 + z**2 <= 1
    if kind in ("box", "block"):
        return np.abs(points).max(axis=1) <= 1
    if kind == "cylinder":
        return (across <= 1) & (abs(z) <= 1)
    if kind == "cone":
        bottom, top = values["radius_bottom"], values["radius_top"]
        return (across <= bottom + (top - bottom) * (z + 1) / 2) & (abs(z) <= 1)
    if kind == "torus":
        return np.hypot(across - values["major_radius"], z) <= values["minor_radius"]
    if kind == "half_space":
        return z >= 0
    return None


def local_points(case, points):
    back = np.linalg.inv(np.array(case["matrix"]))
    return points @ back[:3, :3].T + back[:3, 3]


def solid_of(scene):
    """The solid's field; a half space needs an end to be a scene."""
    ball = {"intersection": {"of": [scene["solid"], {"sphere": {"radius": 60}}]}}
    return sardf.Scene.from_json(json.dumps(scene | {"solid": ball})).solid


def test_every_kind_of_object_is_inside_where_its_own_shape_is(shapes):
    rng = np.random.default_rng(3)
    checked = 0
    for case in shapes:
        assert case["off"] < 1e-5, case
        matrix = np.array(case["matrix"])
        # In a box a little larger than the object: about as many points inside as outside.
        local = rng.uniform(-1.3, 1.3, (3000, 3))
        points = local @ matrix[:3, :3].T + matrix[:3, 3]
        expected = inside(case["kind"], case["values"], local_points(case, points))
        if expected is None:
            continue
        values = solid_of(case["scene"])(points)
        wrong = (values >= 0) != expected
        assert np.abs(values[wrong]).max(initial=0) < 2e-5, (case["kind"], case["transform"])
        assert 0.01 < expected.mean() < 0.99
        checked += 1
    assert checked == 8 * 8 + 7  # rounded_box and capsule have a test of their own


def test_capsules_and_rounded_boxes_have_their_surfaces_where_the_transform_puts_them(shapes):
    for case in shapes:
        if case["kind"] not in ("capsule", "rounded_box") or case["transform"] == "sheared":
            continue
        matrix = np.array(case["matrix"])
        axes, sizes = matrix[:3, :3], np.linalg.norm(matrix[:3, :3], axis=0)
        middle, directions = matrix[:3, 3], axes / sizes
        solid = solid_of(case["scene"])
        if case["kind"] == "rounded_box":  # its radius stays in scene units
            corner = middle + directions @ (sizes - 0.25 + 0.25 / np.sqrt(3))
            surface = [middle + axes[:, i] for i in range(3)] + [corner]
        elif abs(sizes[0] - sizes[1]) > 1e-6:
            continue
        else:
            end = middle + axes[:, 2]
            surface = [middle + 0.5 * axes[:, 0], end + 0.5 * sizes[0] * directions[:, 2],
                       end + 0.5 * axes[:, 1]]  # fmt: skip
        np.testing.assert_allclose(solid(np.array(surface)), 0, atol=2e-5)


def test_uneven_scale_keeps_the_field_a_bound_and_says_that_it_is_no_distance(shapes):
    rng = np.random.default_rng(4)
    for case in shapes:
        if '"at"' not in json.dumps(case["scene"]):
            continue
        field = sardf.Scene.from_json(json.dumps(case["scene"])).solid
        assert "estimate" in field.exactness
        if case["kind"] == "formula":
            continue
        points = np.array(case["matrix"])[:3, 3] + rng.uniform(-4, 4, (500, 3))
        other = points + rng.uniform(-1, 1, (500, 3))
        change = np.abs(field(points) - field(other))
        assert (change <= np.linalg.norm(points - other, axis=1) * 1.0001).all()


@pytest.fixture(scope="module")
def files(run_check, version, tmp_path_factory):
    found = run_check(version, tmp_path_factory.mktemp("files"), "part_files",
                      tmp_path_factory.mktemp("saved"), *SCENES)  # fmt: skip
    return {path: found[str(path)] for path in SCENES}


@pytest.mark.parametrize("path", SCENES, ids=lambda path: path.stem)
def test_import_and_export_lose_nothing(path, files):
    found = files[path]
    original = load_document(path)
    assert found["document"] == original
    assert found["exported"] == original
    assert list(found["exported"].get("materials", ())) == list(original.get("materials", ()))


@pytest.mark.parametrize("path", QUICK, ids=lambda path: path.stem)
def test_objects_give_the_fields_that_the_file_says(path, files):
    """With everything that objects and lists give in place of the file's words, nothing changes."""
    original, made = load_document(path), files[path]["generated"]
    replaced = original | {"fields": original.get("fields", {}) | made["fields"]}
    replaced |= {key: made[key] for key in ("solid", "fractions", "sections") if key in made}
    here = os.getcwd()
    os.chdir(path.parent)
    try:
        first, second = (sardf.Scene.from_json(json.dumps(s)) for s in (original, replaced))
    finally:
        os.chdir(here)
    low, high = map(np.array, first.bounds)
    points = np.random.default_rng(5).uniform(low, high, (400, 3))
    size = np.linalg.norm(high - low)
    for name in made["fields"]:
        np.testing.assert_allclose(
            second.fields[name](points), first.fields[name](points), atol=1e-6 * size
        )
    np.testing.assert_allclose(second.drawn(points), first.drawn(points), atol=1e-6 * size)
    np.testing.assert_allclose(second.fractions(points), first.fractions(points), atol=1e-4)


def test_moving_an_object_changes_its_field_alone(files):
    for path, found in files.items():
        if found["changed"] is None:
            continue
        original, changed = load_document(path), found["changed"]["document"]
        name = found["changed"]["field"]
        assert changed["fields"].pop(name) != original["fields"].pop(name), path
        assert changed == original, path
    assert sum(found["changed"] is not None for found in files.values()) > 10


def test_a_file_gives_objects(files):
    assert files[ROOT / "scenes/lined_bore.json"]["objects"] == 6
    assert files[ROOT / "scenes/cad_pins.json"]["objects"] > 10


@pytest.fixture(scope="module")
def life(run_check, version, tmp_path_factory):
    folder = tmp_path_factory.mktemp("life")
    return run_check(version, folder, "part_life", folder)


def untitled(scene):
    return {key: value for key, value in scene.items() if key != "title"}


def test_a_part_made_by_operators_is_the_scene_that_it_shows(life):
    scene = life["scene"]
    assert scene["fields"]["Box"] == {"box": {"size": [4, 3, 2]}}
    assert scene["fields"]["Cylinder"] == {"cylinder": {"radius": 0.5, "height": 6}}
    assert scene["fields"]["solid"] == {"difference": {"of": ["Box", "Cylinder"]}}
    made = sardf.Scene.from_json(json.dumps(scene))
    near, far = made.fractions([(0.6, 0, 0), (1.9, 1.4, 0.9)])
    assert made.materials == ["lining", "body"]
    np.testing.assert_allclose([near, far], [[1, 0], [0, 1]])


def test_undo_and_redo_bring_the_scene_back(life):
    found = life["undo"]
    assert found["undone"] == found["before"] == life["scene"]
    assert found["redone"] == found["after"] != found["before"]
    moved = {"cylinder": {"center": [0.75, 0, 0], "radius": 0.5, "height": 6}}
    assert found["after"]["fields"]["Cylinder"] == moved
    assert list(found["after"]["materials"]) == ["lining", "body", "third"]


def test_a_copy_is_a_part_of_its_own(life):
    found = life["copy"]
    assert untitled(found["same"]) == untitled(life["scene"])
    assert found["changed"]["fields"]["Cylinder"]["cylinder"]["center"] == [0.5, 0, 0]
    assert found["original"] == life["scene"]


def test_a_bake_leaves_a_mesh_under_the_part(life):
    found = life["bake"]
    assert found["parent"] == "Part"
    assert found["matrix"] == np.eye(4).tolist()
    assert found["wireframes"]
    points = np.array(found["points"])
    block = np.abs(points) / (2, 1.5, 1)
    on_bore = np.abs(np.hypot(points[:, 0], points[:, 1]) - 0.5) < 0.02
    assert ((np.abs(block.max(axis=1) - 1) < 0.02) | on_bore).all()
    assert 0.05 < on_bore.mean() < 0.95
    assert found["again"]
    before, first, second = found["counts"]
    assert second == first
    assert first["objects"] == before["objects"] + 1
    assert found["loaded"] == life["scene"]
    assert found["baked after loading"] == "Part baked"


def test_append_and_link_bring_the_part_with_its_entries(life):
    for kind in ("append", "library"):
        found = life[kind]
        assert found["scene"] == life["scene"], kind
        assert found["request"]
        assert len(found["baked"]) == 1, kind
    assert "linked from" in life["library"]["error"]


def test_every_property_and_operator_has_a_tooltip(run_check, version, tmp_path):
    found = run_check(version, tmp_path, "tooltips")
    assert len(found["properties"]) > 80
    assert found["missing"] == []
    # Those of primitives are the operations' own words, without the sentence's full stop.
    text = (ROOT / "docs/operations.md").read_text()
    torus = text[text.index("### torus") :].split("### ")[1]
    (said,) = re.findall(r"\| `minor_radius` \|.*\| (.*) \|", torus)
    assert said in found["properties"]["SardfPrimitive.torus_minor_radius"]
