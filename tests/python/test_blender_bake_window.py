"""A bake into a folder in a window of Blender 3.4.1, interrupted in every way, and its nodes."""

from itertools import combinations

import pytest
from blender_runs import GRADED_SPHERE, SCRIPTS, addon_for_window, run_in_window, write_scene

SCENE = GRADED_SPHERE | {
    "materials": {
        name: material | {"density": 2} for name, material in GRADED_SPHERE["materials"].items()
    }
}


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bake")
    user = folder / "user"
    return run_in_window(
        SCRIPTS / "gui_bake_more.py", addon_for_window(user), write_scene(folder, SCENE),
        user_folder=user, size=(1280, 1000), limit=560,
    )  # fmt: skip


def test_the_panel_tells_time_and_density_before_the_bake(window):
    assert window["drawn"]["SARDF_PT_bake"] > 3
    assert window["estimate"] > 0


def test_progress_has_the_time_left(window):
    assert window["stage"].startswith("Baking ")
    assert " left" in window["stage"]


@pytest.mark.timed
def test_escape_in_mesh_textures_and_files_stops_at_once_and_leaves_nothing(window):
    early, middle, late = window["interrupted"]
    assert 0 < early < middle < late < 1
    assert window["cancelled"]
    assert window["left by Esc"] == [False, []]
    assert min(window["seconds to cancel"]) < 0.2
    assert max(window["seconds to cancel"]) < 1  # with a window drawn in software beside it


def test_a_deleted_part_ends_its_bake_with_a_sentence(window):
    message, left = window["deleted part"]
    assert message == "the part 'graded sphere' is gone; what was baked of it is dropped"
    assert left == []


def test_an_add_on_that_is_disabled_stops_its_bake(window):
    assert window["disabled"] == [True, []]


def test_a_bake_into_a_folder_is_one_undo_step(window):
    names = ("base_color", "density", "fractions_1", "metallic", "normal", "roughness")
    assert window["files"] == [f"part_{name}.exr" for name in names]
    assert window["baked"][0] == "graded sphere"
    assert window["undone"]
    assert window["redone"]


def test_smart_uv_project_waits_for_object_mode(window):
    assert window["mode"] == "EDIT"
    assert window["smart"][:2] == ["graded sphere", "UVMap"]
    assert len(window["smart images"]) == 6


def test_drawn_nodes_do_not_overlap_and_stand_in_their_frames_apart(window):
    boxes = {name: box for name, box in window["nodes"].items() if box[5] != "FRAME"}
    assert len(boxes) > 12
    frames = {}
    for name, (left, right, bottom, top, frame, _) in boxes.items():
        assert frame or not name.startswith("sardf")
        if frame:
            a, b, c, d = frames.get(frame, (left, right, bottom, top))
            frames[frame] = (min(a, left), max(b, right), min(c, bottom), max(d, top))
    margin = 30  # of a frame around its nodes
    grown = {
        f: (a - margin, b + margin, c - margin, d + margin) for f, (a, b, c, d) in frames.items()
    }
    assert len(grown) > 5
    for group in (boxes, grown):
        for (one, a), (other, b) in combinations(group.items(), 2):
            apart = a[1] <= b[0] or b[1] <= a[0] or a[3] <= b[2] or b[3] <= a[2]
            assert apart, (one, other)
