"""Attributes of scenes in Blender 3.4.1 and bpy 5.0.1: of points, and as brushed metal."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
import sardf
from blender_runs import HEADLESS, SCRIPTS, VERSIONS, run_script, write_scene
from repository import ROOT

HALF = 2.2  # of the plate's edge
PLATE = {
    "sardf": 1,
    "title": "brushed plate",
    "fields": {"plate": {"box": {"size": [2 * HALF, 2 * HALF, 0.5]}}},
    "solid": "plate",
    "materials": {
        "steel": {"color": "#c0c0c0", "metallic": 1, "roughness": 0.35},
        "normal": {"color": "#000000"},
    },
    "attributes": {
        "grain_direction": ["=-3*y", "=3*x", 0],
        "along_x": [2, 0, 0],
        "flat": ["=x*y", "=y - 1"],
        "heat": {"value": "=20 + x", "unit": "°C"},
        "four": ["=x", "=y", "=z", 1],
        "stress": {"value": {"components": {"xx": "=x", "xy": "=y"}}},
        "steel": "=z",
        "pole": "=0*x/0",
        "position": ["=z", 0, 0],
        "material_index": "=x",
    },
}
SMALL = ("--resolution", 16, "--size", 64, "--width", 16, "--height", 12, "--samples", 1)


def headless(version, folder, *words):
    return run_script(version, HEADLESS, *words, *SMALL, user_folder=folder / "user")


@pytest.fixture(scope="module", params=VERSIONS)
def plate(request, tmp_path_factory):
    """Version, folder and output folder of a run with the plate."""
    folder = tmp_path_factory.mktemp(f"plate-{request.param}")
    done = headless(request.param, folder, write_scene(folder, PLATE), "-o", folder / "out")
    assert done.returncode == 0, done.stdout + done.stderr
    return request.param, folder, folder / "out"


def result_of(script, version, folder, *words):
    result = folder / f"{script}.npz"
    done = run_script(version, SCRIPTS / script, *words, result, user_folder=folder / "user")
    assert result.is_file(), done.stdout + done.stderr
    with np.load(result) as arrays:
        return dict(arrays)


def test_attributes_stand_at_the_points_under_their_names(plate):
    version, folder, output = plate
    arrays = result_of("inspect_blend.py", version, folder, output)
    kinds = json.loads(str(arrays["facts"]))["attributes"]
    x, y, z = arrays["vertices"].astype(float).T
    nothing = np.zeros_like(x)
    expected = {
        "grain_direction": [-3 * y, 3 * x, nothing],
        "along_x": [nothing + 2, nothing, nothing],
        "flat": [x * y, y - 1, nothing],
        "heat": [20 + x],
        "four_1": [x],
        "stress_xx": [x],
        "stress_xy": [y],
        "four_4": [nothing + 1],
        "steel": [nothing + 1],  # the material's fraction; the attribute comes after it
        "normal.001" if version == "3.4.1" else "normal": [nothing],
        "steel.001": [z],
        "pole": [nothing],
        "position.001": [z, nothing, nothing],
        "material_index.001": [x],
    }
    for name, columns in expected.items():
        kind = "FLOAT_VECTOR" if len(columns) == 3 else "FLOAT"
        assert kinds[name] == [kind, "POINT"], name
        values = arrays[f"attribute {name}"].reshape(len(x), -1)
        np.testing.assert_allclose(values, np.transpose(columns), rtol=0, atol=1e-5, err_msg=name)
    assert not {"four", "four_5", "pole.001", "stress"} & set(kinds)


def test_metal_is_brushed_along_the_attribute(plate):
    """Principled gets unit vectors in the world's axes, and its reflections stretch across them."""
    version, folder, output = plate
    arrays = result_of("brushed_metal.py", version, folder, output / "part.blend")
    links = json.loads(str(arrays["links"]))
    assert links["attribute"] == "grain_direction"
    assert links["Tangent"] == ["sardf tangent", "Vector"]
    assert links["Anisotropic"] == ["sardf anisotropic", "Value"]
    middles = (np.arange(60) + 0.5) / 60 * 4 - 2
    x, y = np.meshgrid(middles, -middles)
    clear = np.hypot(x, y) > 0.6  # of the middle, where a cell of the mesh holds every direction
    wanted = np.stack([-y, x, 0 * x], axis=-1) / np.hypot(x, y)[..., None]
    assert np.abs(arrays["tangents"] - wanted)[clear].max() < 0.03
    assert np.abs(arrays["turned"] - [0, 1, 0]).max() < 0.01
    light = arrays["highlight"].mean(axis=-1).astype(float)
    spread_x, spread_y = (np.sqrt((light * c**2).sum() / light.sum()) for c in (x, y))
    assert light.max() > 0.01
    assert spread_y > 1.4 * spread_x


def test_another_attribute_can_be_named(version, tmp_path):
    output = tmp_path / "out"
    scene = write_scene(tmp_path, PLATE)
    done = headless(version, tmp_path, scene, "-o", output, "--tangent", "along_x")
    assert done.returncode == 0, done.stdout + done.stderr
    arrays = result_of("brushed_metal.py", version, tmp_path, output / "part.blend")
    assert json.loads(str(arrays["links"]))["attribute"] == "along_x"


def test_baking_again_changes_the_attribute_and_keeps_the_rest(version, tmp_path):
    attributes = {name: PLATE["attributes"][name] for name in ("along_x", "heat")}
    scene = write_scene(tmp_path, PLATE | {"attributes": attributes | {"around": ["=-y", "=x", 0]}})
    result = tmp_path / "result.json"
    words = (HEADLESS.parent, scene, result, "", "along_x", "around", "", "around")
    script = SCRIPTS / "rebake_tangent.py"
    done = run_script(version, script, *words, user_folder=tmp_path / "user")
    assert result.is_file(), done.stdout + done.stderr
    found = json.loads(result.read_text())
    plain, first, second, ended, again = found["states"]
    assert (first["attribute"], second["attribute"]) == ("along_x", "around")
    assert [s["strength"] for s in (first, second, again)] == pytest.approx([0.8, 0.3, 0.8])
    assert first["linked"] == second["linked"] == again["linked"] == [True, True]
    assert (
        first["nodes"] == second["nodes"] == again["nodes"] == plain["nodes"] + 5
    )  # and their frame
    assert plain["linked"] == [False, False]
    assert plain["anisotropic"] == 0
    assert ended == plain
    assert found["summary"][-1] == "attributes: along_x, heat, around"
    assert "accepted are along_x, heat, around; did you mean 'along_x'?" in found["error"]


WRONG = {
    "along_z": "there is no attribute 'along_z'; accepted are grain_direction, along_x",
    "grain_direktion": "did you mean 'grain_direction'?",
    "heat": "the attribute 'heat' is a number",
    "stress": "the attribute 'stress' is made of the components xx, xy",
    "flat": "the attribute 'flat' is a vector of 2 components",
}


def test_wrong_tangents_have_exit_code_2(tmp_path):
    scene = write_scene(tmp_path, PLATE)
    for name, said in WRONG.items():
        done = headless("5.0.1", tmp_path, scene, "-o", tmp_path / "out", "--tangent", name)
        (line,) = [line for line in done.stderr.splitlines() if line.startswith("sardf: ")]
        assert done.returncode == 2
        assert said in line
    assert not list((tmp_path / "out").iterdir())


@pytest.fixture
def job(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT))
    from blender_addon.baked import job

    return job


def test_the_convention_is_a_vector_of_that_name(job):
    for attributes, wanted in (
        ({"grain_direction": [1, 0, 0]}, "grain_direction"),
        ({"grain_direction": [1, 0]}, ""),
        ({"grain_direction": 1}, ""),
        ({"along": [1, 0, 0]}, ""),
        ({}, ""),
    ):
        scene = sardf.Scene(solid=sardf.sphere(radius=1), attributes=attributes)
        assert job.tangent_of(scene, "") == wanted
    with pytest.raises(sardf.Error, match="the scene has none"):
        job.tangent_of(SimpleNamespace(attributes={}), "along")


def test_vector_attributes_are_baked(tmp_path):
    """As channels from Python and as files of the command line, beside the place they depend on."""
    attributes = {"place": ["=x", "=y", "=z"], "grain": ["=-y", "=x", 0]}
    path = write_scene(tmp_path, PLATE | {"attributes": attributes})
    scene = sardf.load(str(path))
    mesh = scene.mesh(resolution=16, size=64)
    maps = scene.bake(mesh, size=64, channels=("place", "grain"))
    x, y, _ = np.moveaxis(maps["place"].astype(float), -1, 0)
    assert maps["grain"].shape == (64, 64, 3)
    assert np.ptp(x) > 2
    expected = np.stack([-y, x, 0 * x], axis=-1)
    np.testing.assert_allclose(maps["grain"], expected, rtol=0, atol=1e-5)
