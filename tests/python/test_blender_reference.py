"""Parts in POV-Ray by Blender's camera and lights, and against Cycles; in four Blenders."""

import os

import pytest
from blender_runs import (
    GRADED_SPHERE,
    SCRIPTS,
    addon_for_window,
    run_in_window,
    write_scene,
)


@pytest.fixture(scope="module")
def lit(run_check, version, tmp_path_factory):
    folder = tmp_path_factory.mktemp("lights")
    return run_check(version, folder, "reference", "lights", folder)


def check_agrees(numbers, median=2.0, outline=0.999):
    assert "error" not in numbers, numbers
    assert numbers["intersection_over_union"] >= outline
    assert numbers["median"] <= median
    assert numbers["compared_pixels"] > 500


def test_cameras(run_check, version, tmp_path):
    found = run_check(version, tmp_path, "reference", "cameras")
    assert len(found) == 7
    for numbers in found.values():
        check_agrees(numbers)


LIGHTS = ("point", "soft point", "sun", "spot", "rectangle", "disk", "world")


@pytest.mark.parametrize("name", LIGHTS)
def test_lights(lit, name):
    """Matte surfaces agree in radiance; 99 % with shadows' edges, of which soft ones are steps."""
    check_agrees(lit[name], median=1.0, outline=0.998)
    assert not lit[name]["warnings"]


def test_flat(lit):
    check_agrees(lit["flat"], outline=0.998)
    assert lit["flat"]["quantile_99"] <= 2


def test_parts_turned_and_cut(run_check, version, tmp_path):
    found = run_check(version, tmp_path, "reference", "turned")
    for numbers in found.values():
        check_agrees(numbers, outline=0.998)
    assert found["cut"]["compared_pixels"] != found["whole"]["compared_pixels"]


def test_an_object_baked_from_a_scene_file(run_check, version, tmp_path):
    section = {"remove": {"half_space": {"normal": [0, -1, 0]}}}
    path = write_scene(tmp_path, GRADED_SPHERE | {"sections": [section]})
    found = run_check(version, tmp_path, "reference", "scene_file", path)
    check_agrees(found["cut"], outline=0.997)
    check_agrees(found["whole"], outline=0.997)
    assert "nothing to draw" in found["gone"]["error"]


def test_what_is_left_behind(run_check, version, tmp_path):
    found = run_check(version, tmp_path, "reference", "leaves")
    assert found["counts"][0] == found["counts"][1] == found["counts"][2]
    assert found["settings"]
    assert found["user's image"] == ["sardf reference", 4, 4]
    assert found["images"]["reference"] == "sardf reference.001"  # the user's keeps its name
    assert found["images"]["difference"] == "sardf difference ×16"
    assert found["size"] == [160, 120]
    assert found["packed"]
    assert found["kept"]
    assert found["alone"]["compared"] == ""


def test_what_cannot_be_drawn_is_told(run_check, version, tmp_path):
    found = run_check(version, tmp_path, "reference", "bad")
    assert "nothing to draw" in found["nothing"]["error"]
    assert "has no camera" in found["no camera"]["error"]
    assert "panoramic" in found["panoramic"]["error"]
    names, told = found["names"], "\n".join(found["not carried over"]["warnings"])
    for expected in (
        f"depth of field of the camera '{names['camera']}'",
        f"spread of the light '{names['area']}'",
        f"IES texture of the light '{names['ies']}'",
        "environment picture (HDRI) of the world 'sky'",
        "no parts are left out: 'floor'",
    ):
        assert expected in told
    assert "spot" not in told
    assert "cannot be compared" in found["empty"]["error"]


def test_povray_is_missing(run_check, version, tmp_path, monkeypatch):
    monkeypatch.setitem(os.environ, "POVRAY", "/no/povray")
    found = run_check(version, tmp_path, "reference", "missing")
    for numbers in (found["compared"], found["alone"]):
        assert "POV-Ray 3.7 was not found" in numbers["error"]
        assert "add-on's preferences" in numbers["error"]
    assert found["left"]


def test_the_command(run_check, version, tmp_path):
    found = run_check(version, tmp_path, "reference", "command", tmp_path)
    assert found["codes"] == [0, 2, 2]
    kinds = ("cycles", "difference", "reference")
    expected = [f"{kind}_{look}.exr" for kind in kinds for look in ("flat", "shaded")]
    assert found["files"] == sorted([*expected, "numbers_flat.json", "numbers_shaded.json"])
    for numbers in found["numbers"].values():
        check_agrees(numbers, median=1.0, outline=0.995)


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    user = tmp_path_factory.mktemp("window") / "user"
    words = (SCRIPTS / "gui_reference.py", addon_for_window(user))
    return run_in_window(*words, user_folder=user, size=(1280, 800), limit=300)


def test_escape_stops_povray(window):
    assert 0 < window["interrupted"] < 1
    assert window["cancelled"]
    assert not window["left"]
    assert window["seconds to cancel"] < 2  # the key's way through X11 and a busy machine included
    assert window["seconds to end POV-Ray"] < 2  # looked for by another program


def test_a_window_shows_difference_and_numbers(window):
    check_agrees(window["numbers"], median=1.0, outline=0.99)
    assert window["drawn"]["SARDF_PT_reference"] > 1
    assert window["image"] == "sardf difference ×16"
    assert window["scene"] == "Scene"
    assert window["reference"] == window["difference"] == ["FINISHED"]
