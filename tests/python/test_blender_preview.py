"""The add-on's preview, installed: in a window, and without one."""

import json

import numpy as np
import pytest
from blender_runs import (
    GRADED_SPHERE,
    RED,
    SCRIPTS,
    STEEL,
    encoded,
    expected_colors,
    install_for_window,
    linear,
    run_in_window,
    run_script,
    screenshot,
    write_scene,
)

WIDTH, HEIGHT = 1000, 700


@pytest.fixture(scope="module")
def window(zips, tmp_path_factory):
    """What gui_preview.py found."""
    folder = tmp_path_factory.mktemp("window")
    install_for_window(zips, folder / "user")
    scene = write_scene(folder, GRADED_SPHERE)
    return run_in_window(
        SCRIPTS / "gui_preview.py", scene,
        user_folder=folder / "user", size=(WIDTH, HEIGHT), limit=500,
    )  # fmt: skip


def at(name, place):
    column, row = (int(c) for c in place)
    return screenshot(name)[row, column]


def is_background(color):
    """The theme's grey."""
    return np.ptp(color) < 3 and 40 < color[0] < 80


def test_preview_shows_the_part(window):
    assert window["finest"] == 128
    assert is_background(at("preview_whole", window["beside"]))
    for place in ("center", "within"):
        assert not is_background(at("preview_whole", window[place]))


def test_a_cut_shows_the_exact_colours(window):
    shown = screenshot("preview_cut")
    places = np.array([place for _, place in window["cut"]]).astype(int)
    points = np.array([point for point, _ in window["cut"]])
    expected = encoded(expected_colors(points))
    error = np.abs(shown[places[:, 1], places[:, 0]] - expected).max(axis=1)
    assert len(error) > 800
    assert np.percentile(error, 95) < 3  # a few are under the gizmos
    # A smaller cut leaves what is before the middle.
    there = screenshot("preview_less_cut")[places[:, 1], places[:, 0]]
    assert np.median(np.abs(there - expected).max(axis=1)) > 5


def test_lines_are_drawn_at_whole_distances(window):
    line = at("preview_lines", window["on a line"])
    between = at("preview_lines", window["between lines"])
    assert line.sum() < 0.7 * between.sum()
    plain = at("preview_cut", window["between lines"])
    assert np.abs(between - plain).max() < 3


def test_a_part_moves_with_its_matrix_and_is_not_sampled_again(window):
    assert window["wish kept"]
    assert not window["sampled again"]
    assert is_background(at("preview_moved", window["old end"]))
    assert not is_background(at("preview_moved", window["new center"]))


def test_a_mirrored_part_is_shown_mirrored(window):
    red, steel, above = (at("preview_mirrored", place) for place in window["mirrored"])
    # What is red is at the left of the part; its mirror image has it at the right.
    assert steel[0] > 1.3 * steel[2]
    assert red[0] < 1.1 * red[2]
    assert is_background(above)


def test_other_objects_hide_it_and_are_hidden(window):
    part = at("preview_whole", window["center"])
    assert np.abs(at("preview_before_cube", window["center"]) - part).max() < 3
    assert np.abs(at("preview_behind_cube", window["center"]) - part).max() > 10


def test_a_mesh_stands_in_where_there_is_no_shader(window):
    assert window["no gpu"] == "no shader today"
    assert not window["left of the mesh"]
    red = at("preview_stand_in", window["red end"])
    assert red[0] > 1.3 * red[2]


def test_the_probe_tells_what_is_under_the_cursor(window):
    place, distance, red, steel = window["probe"]
    x, y, z = json.loads("[" + place[1 : place.index(")")] + "]")
    assert abs(x) < 0.1
    assert abs(z) < 0.1
    assert y == pytest.approx(-5, abs=1e-2)
    assert abs(float(distance.split()[1])) < 1e-3
    assert float(red.split()[1]) == pytest.approx(50, abs=1)
    assert float(steel.split()[1]) == pytest.approx(50, abs=1)


def test_the_legend_has_the_materials_colours(window):
    corner = screenshot("preview_whole")[HEIGHT // 2 :, : WIDTH // 4].reshape(-1, 3)
    for color in (RED, STEEL):
        # Blender's own shader decodes theme colours by a cubic polynomial.
        swatch = np.abs(corner - encoded(linear(color))).max(axis=1) < 7
        assert 100 < swatch.sum() < 400


def test_dragging_is_seen_while_it_goes_on(window):
    drags = np.array(window["drags"])
    sampling = np.array(window["drag sampling"])
    print(
        f"\nfrom a drag to the picture: median {np.median(drags):.3f} s, largest {drags.max():.3f} "
        f"s, of which Blender waits for samples {np.median(sampling):.3f} s; fine after "
        f"{window['seconds to the fine picture']:.2f} s more"
    )
    assert len(drags) == 12
    inside, outside = window["dragged end"]
    assert not is_background(at("preview_dragged", inside))
    assert is_background(at("preview_dragged", outside))


def test_undo_another_file_and_disabling_end_the_work(window):
    assert window["threads at work"] == ["sardf preview"]
    assert window["threads at the end"] == []
    assert window["seconds to disable"] < 2  # the core's own limit is 0.1 s; the machine is busy


def test_a_mesh_stands_in_without_a_window(version, zips, tmp_path):
    scene, result_file = write_scene(tmp_path, GRADED_SPHERE), tmp_path / "result.json"
    script = SCRIPTS / "preview_stand_in.py"
    done = run_script(
        version, script, zips[version], scene, result_file, user_folder=tmp_path / "user"
    )
    assert result_file.is_file(), done.stdout + done.stderr
    assert "Traceback" not in done.stdout + done.stderr
    result = json.loads(result_file.read_text())
    assert result["error"] == ""
    assert result["hidden from renders"]
    for name in ("whole", "cut"):
        points, colors = map(np.array, result[name])
        np.testing.assert_allclose(colors[:, :3], expected_colors(points), atol=1e-4)
    points = np.array(result["whole"][0])
    np.testing.assert_allclose(np.linalg.norm(points, axis=1), 5, atol=0.02)
    assert np.array(result["cut"][0])[:, 1].min() > -1e-3  # corners of the cut are found so far
    # Where the fraction is half, the colour is the middle of viridis: #21918c.
    points, colors = map(np.array, result["fraction"])
    half = np.abs(points[:, 0]) < 0.15
    np.testing.assert_allclose(
        encoded(colors[half][:, :3]), np.tile((33, 145, 140), (half.sum(), 1)), atol=8
    )
    assert "there is no channel" in result["unknown"] or "no attribute" in result["unknown"]
    assert result["place"] == [1, 2, 3]
    assert "the part is empty" in result["part's error"]
    assert result["before"] == result["after"] == result["disabled"]
    assert result["threads"] == []
