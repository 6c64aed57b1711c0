"""The add-on's zips installed in four Blenders."""

import json
import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest
from blender_runs import (
    GRADED_SPHERE,
    SCRIPTS,
    encoded,
    expected_colors,
    install_for_window,
    run_in_window,
    run_script,
    screenshot,
    write_scene,
)

from blender_addon.baked import job


def test_installed_zip_bakes_rebakes_and_renders(version, zips, tmp_path):
    scene = write_scene(tmp_path, GRADED_SPHERE)
    result_file = tmp_path / "result.json"
    script = SCRIPTS / "install_addon.py"
    done = run_script(
        version, script, zips[version], scene, result_file, user_folder=tmp_path / "user"
    )
    assert result_file.is_file(), done.stdout + done.stderr
    result = json.loads(result_file.read_text())
    assert result["enabled"]
    own_copy = "sardf_blender/vendor" if version == "3.4.1" else "extensions/.local/lib/python3.11"
    assert own_copy in result["core"]
    assert str(tmp_path) in result["core"]
    assert result["summary"][0] == "graded sphere"
    assert "red, steel" in result["summary"][1]
    assert result["baked"]["objects"] == ["graded sphere"]
    assert len(result["baked"]["images"]) == 5
    # Baking again renews what the add-on made and keeps what the user changed.
    assert result["rebaked"] == result["baked"]
    assert result["finer"]
    assert result["kept"] == [5.0, True]
    assert result["camera"] == "sardf camera"
    assert ".missing" in result["error"]
    assert not result["left after disabling"]


@pytest.fixture(scope="module")
def window(zips, tmp_path_factory):
    """The installed add-on driven in a window; what gui_bake.py found."""
    folder = tmp_path_factory.mktemp("window")
    user = folder / "user"
    install_for_window(zips, user)
    scene = write_scene(folder, GRADED_SPHERE)
    script = SCRIPTS / "gui_bake.py"
    return run_in_window(script, scene, user_folder=user, size=(1280, 1200), limit=400)


def test_a_click_on_bake_makes_the_part_in_one_undo_step(window):
    assert window["baked"]["objects"] == ["Camera", "Light", "graded sphere"]
    assert window["baked"]["scenes"] == ["Scene"]
    assert window["faces"] > 1000
    assert window["unit"] == "CENTIMETERS"
    assert window["objects after undo"] == ["Camera", "Light"]


@pytest.mark.timed
def test_escape_cancels_and_leaves_nothing_behind(window):
    assert 0 < window["interrupted at"] < 1
    assert window["thread was cancelled"]
    assert not window["left behind"]
    # The click, X11 and a busy machine included; the core's own limit is 0.1 s.
    assert window["seconds to cancel"] < 2
    assert window["seconds to end the thread"] < 2


def test_screenshot_shows_panel_and_baked_colours(window):
    """The viewport shows the texture's colour at each vertex, and the sidebar has text."""
    picture = screenshot("baked")
    points = np.array([point for point, _ in window["seen"]])
    column, row = np.array([pixel for _, pixel in window["seen"]]).astype(int).T
    clear = (column > 60) & (column < 700)  # of toolbar, gizmos and sidebar
    assert clear.sum() > 500
    error = np.abs(picture[row, column][clear] - encoded(expected_colors(points)[clear])).max(
        axis=1
    )
    assert np.median(error) < 2
    assert np.percentile(error, 90) < 6  # the grid's axis and the cursor cover some
    sidebar = picture[90:1000, 840:1030].min(axis=-1)
    assert 0.005 < (sidebar > 180).mean() < 0.2


class Cancelled(Exception):
    pass


def slow_core(entered):
    """A stand-in for the module whose mesher runs until it is cancelled."""

    def mesh(progress, **_):
        while progress(0.5):
            entered.set()
        raise Cancelled

    channels = dict.fromkeys(job.CHANNELS, "")
    scene = SimpleNamespace(mesh=mesh, attributes={}, channels=lambda: channels)
    return SimpleNamespace(load=lambda path, progress: scene, Cancelled=Cancelled, Error=OSError)


def test_job_stops_when_cancelled_and_keeps_errors():
    entered = threading.Event()
    running = job.Job(slow_core(entered), job.Request("part.json"))
    assert entered.wait(10)
    assert running.share == pytest.approx(0.5 * job.SHARES[0] / sum(job.SHARES))
    begun = time.monotonic()
    running.cancel()
    while running.running:
        assert time.monotonic() - begun < 10
    assert running.cancelled
    assert (running.part, running.error) == (None, None)
    failing = job.Job(SimpleNamespace(Cancelled=Cancelled), job.Request("part.json"))
    while failing.running:
        assert time.monotonic() - begun < 20
    assert isinstance(failing.error, AttributeError)
    assert not failing.cancelled
