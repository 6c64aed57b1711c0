"""Section objects moved in a window of Blender 3.4.1: the cut in the preview follows."""

import json

import numpy as np
import pytest
from blender_runs import (
    GRADED_SPHERE,
    RED,
    SCRIPTS,
    STEEL,
    addon_for_window,
    encoded,
    linear,
    run_in_window,
    screenshot,
    write_scene,
)

WIDTH, HEIGHT = 1000, 700
# Of the ball of radius 5 in all directions the colours differ.
SCENE = GRADED_SPHERE | {"fractions": {"formulas": {"red": "=6 + y - z", "steel": "=8 - x + z"}}}


def expected_colors(points):
    """Linear base colour of SCENE."""
    x, y, z = points.T
    red, steel = np.maximum(6 + y - z, 0), np.maximum(8 - x + z, 0)
    shares = np.stack([red, steel], axis=-1) / (red + steel)[:, None]
    return shares @ np.stack([linear(RED), linear(STEEL)])


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sections-window")
    scene, user = write_scene(folder, SCENE), folder / "user"
    return run_in_window(
        SCRIPTS / "gui_sections.py", addon_for_window(user), scene,
        user_folder=user, size=(WIDTH, HEIGHT), limit=500,
    )  # fmt: skip


def errors(name, pairs):
    """How far the screenshot is from the scene's colours at points, largest component each."""
    points = np.array([point for point, _ in pairs])
    places = np.array([place for _, place in pairs]).astype(int)
    seen = screenshot(name)[places[:, 1], places[:, 0]]
    return np.abs(seen - encoded(expected_colors(points))).max(axis=1)


def test_the_cut_follows_the_plane_and_shows_the_colours_inside(window):
    assert len(window["planes"]) == 3
    for name, pairs in window["planes"].items():
        assert len(pairs) > 100
        assert np.percentile(errors(name, pairs), 95) < 3, name
    # The three cuts differ: the first picture is not that of the others' points.
    first, second, third = window["planes"].values()
    names = list(window["planes"])
    assert np.median(errors(names[0], second)) > 4
    assert np.median(errors(names[0], third)) > 4
    assert not window["sampled again"]
    print(f"seen {window['seconds']:.2f} s after the plane was moved, with two redraws")


def test_the_probe_reads_on_the_cut(window):
    place, _, red, _ = window["probed"]
    assert json.loads("[" + place[1 : place.index(")")] + "]") == pytest.approx([1, 3, 0.5])
    expected = (6 + 3 - 0.5) / (6 + 3 - 0.5 + 8 - 1 + 0.5)
    assert float(red.split()[1]) == pytest.approx(100 * expected, abs=0.1)


def test_where_the_plane_takes_everything_a_message_says_so(window):
    (column, row), note = window["nothing"]
    color = screenshot("section_nothing")[int(row), int(column)]
    assert np.ptp(color) < 3  # the theme's grey
    assert note == "the sections leave nothing of graded sphere"


@pytest.mark.parametrize("name", ["section_box", "section_corner"])
def test_a_box_and_three_planes_that_cut_together_show_three_faces(window, name):
    for axis, pairs in window["box"].items():
        assert len(pairs) > 30
        assert np.percentile(errors(name, pairs), 90) < 3, axis


def test_wireframes_follow_drivers(window):
    assert window["wire"] == pytest.approx(0.4, abs=1e-5)


def test_pieces_are_moved_apart_and_take_the_previews_place(window):
    places = window["pieces"]
    assert places["graded sphere baked"] == pytest.approx([0, 0, 0])
    assert places["graded sphere piece 1"] == pytest.approx([0, -4, 0], abs=1e-5)
    assert window["running"]
    assert not window["previewed"]
    assert window["previewed once it is changed"]
