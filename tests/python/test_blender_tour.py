"""The first part of docs/blender.md made in a window, and the pictures of it there."""

import pytest
from blender_runs import SCRIPTS, install_for_window, run_in_window


@pytest.fixture(scope="module")
def window(zips, tmp_path_factory):
    """What gui_tour.py found."""
    user = tmp_path_factory.mktemp("tour") / "user"
    install_for_window(zips, user)
    result, done = run_in_window(
        SCRIPTS / "gui_tour.py", user_folder=user, size=(1280, 900), limit=400
    )
    assert "Traceback" not in done.stdout + done.stderr
    return result


def test_every_step_of_the_tour_works(window):
    assert window["part"] == ["union", "difference"]
    assert window["materials"] == ["lining", "body"]
    assert window["faces"] > 1000
