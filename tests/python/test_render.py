"""`sardf render` and `sardf.render`: POV-Ray's pictures, and files as they were asked for."""

import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sardf
from sardf import _image

ROOT = Path(__file__).resolve().parents[2]
COMMAND = Path(sys.executable).with_name("sardf")
WIDTH, HEIGHT = 160, 120
# A graded bushing cut open, a cutter of sharp edges, and the thin walls of a gyroid.
COMPARED = ["cad_plate_cut", "diamond_cutter", "gyroid_sandwich"]


def run(*arguments, code=0):
    done = subprocess.run([COMMAND, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    path = tmp_path_factory.mktemp("render") / "ball.json"
    path.write_text('{"sardf": 1, "solid": {"sphere": {"radius": 2}}}')
    return path


def near_an_edge(picture, mask):
    """Pixels beside the outline, or beside one of another colour."""
    edge = np.zeros(mask.shape, bool)
    for axis, step in [(0, 1), (0, -1), (1, 1), (1, -1)]:
        there = np.roll(picture, step, axis)
        edge |= ~np.roll(mask, step, axis) | (np.abs(there - picture).max(-1) > 8 / 255)
    return edge


@pytest.mark.skipif(not shutil.which("povray"), reason="needs POV-Ray")
@pytest.mark.parametrize("name", COMPARED)
def test_the_flat_picture_is_povrays(name, tmp_path):
    scene = ROOT / "scenes" / f"{name}.json"
    size = ["--width", WIDTH, "--height", HEIGHT]
    theirs = tmp_path / "povray.exr"
    run("povray", scene, "-o", tmp_path / "a.pov", "--look", "flat", "--render", theirs, *size)
    ours = tmp_path / "sardf.exr"
    run("render", scene, "-o", ours, "--look", "flat", "--size", f"{WIDTH}x{HEIGHT}", "--bits", 32)
    reference, picture = _image.read(str(theirs)), _image.read(str(ours))
    mask, reference_mask = picture[..., 3] >= 0.5, reference[..., 3] >= 0.5
    both = mask & reference_mask
    assert both.sum() > 4000
    assert both.sum() >= 0.999 * (mask | reference_mask).sum()
    compared = both & ~near_an_edge(reference[..., :3], reference_mask)
    assert compared.sum() > 0.6 * both.sum()
    assert np.abs(picture - reference)[compared].max() <= 2 / 255


@pytest.mark.parametrize(("file", "bits", "places"), [("a.png", 8, 2), ("a.png", 16, 4)])
def test_pictures_as_png(ball, tmp_path, file, bits, places):
    path = tmp_path / file
    run("render", ball, "-o", path, "--size", "64x48", "--bits", bits, "--look", "flat")
    picture = _image.read(str(path))
    assert picture.shape == (48, 64, 4)
    assert picture[0, 0].tolist() == [0, 0, 0, 0]
    # The colour of a scene without materials.
    assert np.abs(picture[24, 32] - [0.8, 0.8, 0.8, 1]).max() < 10.0**-places


def test_depth_and_normals_as_exr(ball, tmp_path):
    path = tmp_path / "a.exr"
    run("render", ball, "-o", path, "--size", "64x48", "--bits", 32, "--depth", "--normals")
    picture = _image.read(str(path), color=False)
    assert picture.shape == (48, 64, 8)
    assert np.isinf(picture[0, 0, 4])
    array = sardf.load(str(ball)).render(64, 48, depth=True, normals=True)
    hit = array[..., 3] == 1
    assert np.array_equal(picture[hit][:, 4:], array[hit][:, 4:])
    assert np.allclose(np.linalg.norm(array[hit][:, 5:], axis=1), 1, atol=1e-6)


def test_the_command_and_python_give_the_same(ball, tmp_path):
    by_command, by_python = tmp_path / "a.exr", tmp_path / "b.exr"
    run("render", ball, "-o", by_command, "--size", "64x48", "--threads", 1)
    picture = sardf.render(str(ball), by_python, size=(64, 48))
    assert np.array_equal(_image.read(str(by_command)), _image.read(str(by_python)))
    # Half precision in the file.
    assert np.abs(_image.read(str(by_python)) - picture).max() < 1e-3
    assert picture[0, 0].tolist() == pytest.approx([0.9, 0.92, 0.95, 1])


def test_a_camera_of_ones_own(ball):
    scene = sardf.load(str(ball))
    camera = scene.camera(64, 48)
    camera.update(type="ORTHO", ortho_scale=8)
    mask = scene.render(64, 48, look="flat", camera=camera)[..., 3]
    # A disc of radius 2, 8 pixels to a unit: its area, to the pixels that its outline crosses.
    assert mask.sum() == pytest.approx(np.pi * 4 * 8**2, abs=8)


def test_cancel(ball):
    with pytest.raises(sardf.Cancelled):
        sardf.load(str(ball)).render(2000, 1000, progress=lambda share: False)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["-o", "a.jpg"], "the picture ends in '.jpg'; .png and .exr are accepted"),
        (["-o", "a.png", "--bits", "32"], "--bits 32 needs a picture that ends in .exr"),
        (["-o", "a.png", "--depth"], "--depth and --normals need a picture that ends in .exr"),
        (["-o", "a.exr", "--bits", "8"], "--bits 8 needs a picture that ends in .png"),
        (["-o", "a.png", "--size", "64"], "WIDTHxHEIGHT"),
        (["-o", "a.png", "--look", "flatt"], "flatt"),
        (["-o", "a.png", "--tolerance", "-1"], "tolerance"),
        (["-o", "/no/such/folder/a.png"], "/no/such/folder"),
    ],
)
def test_wrong_usage(ball, tmp_path, arguments, message):
    done = subprocess.run(
        [COMMAND, "render", ball, *arguments], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode in (1, 2)
    assert message in done.stderr
    assert not list(tmp_path.iterdir())


def test_python_says_what_is_accepted(ball):
    scene = sardf.load(str(ball))
    with pytest.raises(sardf.Error, match="there is no look 'flatt'; accepted are flat, shaded"):
        scene.render(64, 48, look="flatt")
    with pytest.raises(sardf.Error, match="64 x 0 pixels"):
        scene.render(64, 0)
    with pytest.raises(sardf.Error, match="'.jpg'; .png and .exr"):
        sardf.render(scene, "a.jpg")
    with pytest.raises(sardf.Error, match="bits is 32; 8 and 16"):
        sardf.render(scene, "a.png", bits=32)
