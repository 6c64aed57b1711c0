"""The first part of docs/blender.md made in a window, and the pictures of it there."""

import numpy as np
import pytest
from blender_runs import SCREENSHOTS, SCRIPTS, WINDOW_CHROOT, install_for_window, run_in_window
from PIL import Image
from repository import ROOT

PICTURES = sorted((ROOT / "docs/images").glob("blender_*.png"))


@pytest.fixture(scope="module")
def window(zips, tmp_path_factory):
    """What gui_tour.py found."""
    user = tmp_path_factory.mktemp("tour") / "user"
    install_for_window(zips, user)
    for path in SCREENSHOTS.glob("tour_*.png"):
        path.unlink()
    return run_in_window(SCRIPTS / "gui_tour.py", user_folder=user, size=(1280, 900), limit=400)


def test_every_step_of_the_tour_works(window):
    assert window["part"] == ["union", "difference"]
    assert window["materials"] == ["lining", "body"]
    assert window["faces"] > 1000
    overlap, median, _ = window["reference"]
    assert overlap >= 0.999
    assert median <= 2  # of 255


def small(path):
    """The picture as numbers, in squares of 10 x 10 pixels, which a line does not change much."""
    picture = np.asarray(Image.open(path).convert("RGB"), float)
    rows, columns, _ = picture.shape
    return picture.reshape(rows // 10, 10, columns // 10, 10, 3).mean(axis=(1, 3))


@pytest.mark.skipif(bool(WINDOW_CHROOT), reason="the pictures are of Debian 12's Blender")
def test_the_document_shows_what_is_seen_today(window):
    """scripts/make_blender_pictures writes them again."""
    names = [path.name.replace("blender", "tour") for path in PICTURES]
    assert names == sorted(path.name for path in SCREENSHOTS.glob("tour_[0-9]*.png"))
    for path, name in zip(PICTURES, names, strict=True):
        changed = np.abs(small(path) - small(SCREENSHOTS / name)).max(axis=-1) > 25
        assert changed.mean() < 0.01, name
