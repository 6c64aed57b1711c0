"""A part that keyframes and drivers move, rendered without a window by the documented command."""

import json
import math

import numpy as np
import pytest
from blender_runs import HEADLESS, run_script

WIDTH, HEIGHT = 96, 72
ORTHO_SCALE = 3.0  # scene units along the picture's width
CAMERA = {
    "type": "ORTHO", "ortho_scale": ORTHO_SCALE,
    # From the front: right is x, up is z.
    "matrix_world": [[1, 0, 0, 0], [0, 0, -1, -10], [0, 1, 0, 0], [0, 0, 0, 1]],
}  # fmt: skip
SMALL = ("--width", WIDTH, "--height", HEIGHT, "--samples", 2, "--resolution", 24, "--size", 64,
         "--look", "shaded,normals")  # fmt: skip
ALONE = 17


@pytest.fixture(scope="module")
def rendered(run_check, version, tmp_path_factory):
    """(version, what the file says, what all frames show, what one frame shows that was rendered
    alone, their folder)."""
    folder = tmp_path_factory.mktemp("animation")
    blend, camera = folder / "part.blend", folder / "camera.json"
    said = run_check(version, folder, "animation", "make", blend)
    camera.write_text(json.dumps(CAMERA))
    words = (blend, "-o", folder / "all", *SMALL, "--camera", camera, "--frames", 1, 24)
    done = run_script(version, HEADLESS, *words, user_folder=folder / "user", limit=1500)
    assert done.returncode == 0, done.stdout + done.stderr
    # As a command of Blender 4.2 and later, which is run here in a session of its own.
    words = ("render", blend, "-o", folder / "alone", *SMALL, "--camera", camera)
    code = run_check(version, folder, "animation", "command", *words, "--frames", ALONE, ALONE)
    assert code == 0
    shown = [run_check(version, folder, "animation", "read", folder / name)
             for name in ("all", "alone")]  # fmt: skip
    return version, said, *shown, folder


def test_every_frame_is_there_and_nothing_else(rendered):
    folder = rendered[-1]
    names = {path.name for path in (folder / "all").iterdir()}
    expected = {f"part_{n:04d}.png" for n in range(1, 25)}
    assert names == expected | {f"normals_{n:04d}.exr" for n in range(1, 25)} | {"camera.json"}
    assert len(list((folder / "alone").iterdir())) == 3


def test_the_cut_grows_as_plane_and_radius_say(rendered):
    """The cut of a ball of radius r at y is a disc of radius sqrt(r² - y²); the ring lies behind
    the cuts."""
    _, said, shown, _, _ = rendered
    pixel = (ORTHO_SCALE / WIDTH) ** 2
    counted = [shown[str(frame)][:2] for frame in range(1, 25)]
    for frame, (whole, cut) in enumerate(counted, 1):
        radius, y, _, _ = said[str(frame)]
        area = math.pi * (radius**2 - y**2) / pixel
        # The outline lies on other pixels' centres by chance, and the mesh's edges are straight.
        assert abs(cut - area) < 0.03 * area + 10, frame
        assert abs(whole - math.pi * radius**2 / pixel) < 0.02 * area + 25, frame
    assert (np.diff(np.array(counted), axis=0) > 0).all()


def test_a_frame_alone_is_that_of_the_animation(rendered):
    _, _, shown, alone, _ = rendered
    assert alone == {str(ALONE): shown[str(ALONE)]}


def test_wireframes_follow_driven_properties(rendered):
    for radius, top in (values[2:] for values in rendered[1].values()):
        assert top == pytest.approx(radius, rel=1e-5)
    assert rendered[1]["24"][3] == pytest.approx(0.1 + 0.005 * 24, rel=1e-5)


def test_wrong_frames_are_told(version, tmp_path):
    part = tmp_path / "part.json"
    for words, said in (
        (("--frames", 5, 1), "the first comes after the last"),
        (("--frames", 1, 2), "--frames is for parts in .blend files"),
        (("--pieces",), "--pieces is for --frames"),
    ):
        done = run_script(version, HEADLESS, part, "-o", tmp_path / "out", *words,
                          user_folder=tmp_path / "user")  # fmt: skip
        assert done.returncode == 2
        assert said in done.stderr
    assert not (tmp_path / "out").exists()
