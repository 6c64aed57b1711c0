"""EXR files, the store of a bake and its clock, without Blender: files are whole or not there, and
nothing of anybody's is written over."""

import json
import os
import subprocess
import sys
import threading

import numpy as np
import pytest
import sardf
from repository import ROOT
from sardf import _image

from blender_addon.baked import clock, job, store

SCENE = {
    "sardf": 1,
    "fields": {"ball": {"sphere": {"radius": 5}}},
    "solid": "ball",
    "materials": {"red": {"color": "#c03020", "density": 2}, "blue": {"density": 3}},
    "fractions": {"inverse_distance": {"features": [
        {"at": {"point": {"at": [-8, 0, 0]}}, "material": "red"},
        {"at": {"point": {"at": [8, 0, 0]}}, "material": "blue"},
    ]}},
    "attributes": {"four": ["=x", "=y", "=z", 1], "heat": {"value": "=x", "unit": "K"}},
}  # fmt: skip


@pytest.mark.parametrize("shape", [(1, 1, 1), (35, 7, 3), (16, 33, 2), (100, 300, 3)])
def test_another_reader_finds_the_same_numbers(shape, tmp_path):
    """OpenImageIO reads with the OpenEXR library, which shares nothing with our writer."""
    array = np.random.default_rng(5).normal(size=shape).astype(np.float32) * 1e3
    array[0, 0] = [np.float32(1e-38), -0.0, 3e38][: shape[2]]
    array[: shape[0] // 2] = 0.5  # runs are compressed, noise is not
    path = tmp_path / "image.exr"
    sardf.write_exr(path, array)
    expected = np.zeros((*shape[:2], 1 if shape[2] == 1 else 3), dtype=np.float32)
    expected[..., : shape[2]] = array
    found = np.asarray(_image.read(str(path)))[..., : expected.shape[2]]
    np.testing.assert_array_equal(found, expected)
    information = subprocess.run(
        ["oiiotool", "--info", "-v", str(path)], capture_output=True, text=True, check=True
    ).stdout
    assert f"channel list: {'Y' if shape[2] == 1 else 'R, G, B'}" in information
    assert os.listdir(tmp_path) == ["image.exr"]


def test_a_cancelled_or_failed_file_leaves_what_was_there(tmp_path):
    path = tmp_path / "image.exr"
    path.write_text("the user's")
    noise = np.random.default_rng(6).random((256, 256, 3), dtype=np.float32)
    with pytest.raises(sardf.Cancelled):
        sardf.write_exr(path, noise, lambda share: share < 0.5)
    with pytest.raises(OSError, match="No such file"):
        sardf.write_exr(tmp_path / "missing" / "image.exr", noise)
    with pytest.raises(sardf.Error, match=r"shape \(2, 2, 4\); \(height, width, 1 to 3\)"):
        sardf.write_exr(path, np.zeros((2, 2, 4)))
    assert path.read_text() == "the user's"
    assert os.listdir(tmp_path) == ["image.exr"]


FULL = """
import resource, signal, sys, numpy as np, sardf
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
sys.path.insert(0, sys.argv[1])
import json
from blender_addon.baked import job, store
request = job.Request("", size=512, resolution=8, channels=("base_color",),
                      scene=json.loads(sys.argv[2]), store=store.Store(sys.argv[3], "part"))
try:
    job.make_part(sardf, request)
except store.StoreError as error:
    print(error)
"""


def test_where_files_cannot_grow_nothing_is_left(tmp_path):
    """A limit of the process stands in for a full disk: the same place fails."""
    target = tmp_path / "new" / "folder"
    done = subprocess.run(
        [sys.executable, "-c", FULL, str(ROOT), json.dumps(SCENE), str(target)],
        capture_output=True, text=True,
    )  # fmt: skip
    assert "textures cannot be written" in done.stdout, done.stdout + done.stderr
    assert "Traceback" not in done.stderr
    assert not os.listdir(tmp_path)


def test_no_space_is_said_so():
    error = store.failure("out", OSError(28, "No space left on device"))
    assert str(error) == "out: there is no space left for the textures"


def write(target, *channels):
    target.open()
    for channel in channels:
        target.path(channel).write_text(f"new {channel}")


def test_a_store_publishes_all_of_its_files_or_none(tmp_path):
    folder = tmp_path / "out"
    target = store.Store(folder, "my part: 1/2")
    write(target, "base_color", "roughness")
    assert [p.name for p in folder.iterdir() if not p.name.startswith(".")] == []
    paths = target.publish(["base_color", "roughness"])
    assert sorted(os.listdir(folder)) == [
        "my part_ 1_2_base_color.exr", "my part_ 1_2_roughness.exr",
    ]  # fmt: skip
    assert paths["roughness"].read_text() == "new roughness"
    with pytest.raises(store.StoreError, match="is there already; tick Replace Files"):
        store.Store(folder, "my part: 1/2").check(["metallic", "roughness"])
    appeared = store.Store(folder, "other")
    write(appeared, "roughness")
    (folder / "other_roughness.exr").write_text("the user's")
    with pytest.raises(store.StoreError, match="is there already"):
        appeared.publish(["roughness"])
    appeared.discard()
    assert (folder / "other_roughness.exr").read_text() == "the user's"
    again = store.Store(folder, "other", replace=True)
    write(again, "roughness")
    again.publish(["roughness"])
    assert (folder / "other_roughness.exr").read_text() == "new roughness"
    assert len(os.listdir(folder)) == 3


def test_a_discarded_store_leaves_no_folder_that_it_made(tmp_path):
    target = store.Store(tmp_path / "a" / "b")
    write(target, "base_color")
    target.discard()
    assert not os.listdir(tmp_path)
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "mine").write_text("the user's")
    target = store.Store(tmp_path / "a" / "b")
    write(target, "base_color")
    target.discard()
    assert os.listdir(tmp_path / "a") == ["mine"]
    file = tmp_path / "a" / "mine"
    with pytest.raises(store.StoreError, match="mine"):
        store.Store(file / "b").open()
    assert file.read_text() == "the user's"


def request(folder, **more):
    values = {"path": "", "size": 256, "resolution": 8, "scene": SCENE}
    return job.Request(**values | {"store": store.Store(folder), **more})


def test_channels_are_those_that_the_core_lists(tmp_path):
    scene = sardf.Scene.from_json(json.dumps(SCENE))
    known = scene.channels()
    assert list(known) == ["base_color", "roughness", "metallic", "emission", "fractions", "field",
                           "normal", "density", "four", "heat"]  # fmt: skip
    assert known["heat"] == "attribute: a number; in K"
    assert all(known.values())
    part = job.make_part(sardf, request(tmp_path, channels=(*known, "nothing")))
    assert list(part.maps) == [
        "base_color", "roughness", "metallic", "emission", "fractions_1", "field", "normal",
        "density", "four_1", "four_2", "heat",
    ]  # fmt: skip
    assert part.warnings == ["left out: nothing, of which this scene has nothing"]
    paths = part.store.publish(part.maps)
    density = np.asarray(_image.read(str(paths["density"])))[..., 0]
    fractions = np.asarray(_image.read(str(paths["fractions_1"])))
    np.testing.assert_allclose(density, fractions[..., :2] @ [2, 3], rtol=1e-5)
    with pytest.raises(sardf.Error, match="did you mean 'base_color'"):
        job.make_part(sardf, request(tmp_path, channels=("base_colour",)))


def test_density_is_offered_where_every_material_has_one():
    plain = SCENE | {"materials": {"red": {"density": 2}, "blue": {}}}
    own = SCENE | {"attributes": {"density": "=7 + x"}}
    for scene, there in ((plain, False), (SCENE, True), (own, True)):
        made = sardf.Scene.from_json(json.dumps(scene))
        assert ("density" in made.channels()) is there
    assert made.channels()["density"] == "attribute: a number"  # what the scene itself means


@pytest.mark.parametrize("at", [0.1, 0.6, 0.9])
def test_a_cancelled_job_leaves_nothing(at, tmp_path):
    with pytest.raises(sardf.Cancelled):
        job.make_part(sardf, request(tmp_path / "out"), lambda share: share < at)
    assert not os.listdir(tmp_path)


def test_a_job_that_is_cancelled_when_it_is_done_drops_its_files(tmp_path):
    running = job.Job(sardf, request(tmp_path / "out"))
    while running.running:
        threading.Event().wait(0.01)
    assert running.part is not None
    running.cancel()
    assert not os.listdir(tmp_path)


def test_time_left_follows_the_estimate_first_and_the_work_later():
    now = [0.0]
    known = clock.Clock(100.0, lambda: now[0])
    assert known.left(0.0) == 100
    now[0] = 10.0
    assert known.left(0.0) == 90
    assert known.left(0.5) == pytest.approx(10)  # half in 10 s: 10 more
    assert 10 < known.left(0.1) < 90.001  # between 90 s by both
    unknown = clock.Clock(None, lambda: now[0])
    now[0] = 20.0
    assert unknown.left(0.0) is None
    assert unknown.left(0.25) == pytest.approx(30)
    assert known.left(1.0) == 0


def test_times_and_sizes_are_said_shortly():
    assert [clock.seconds_text(s) for s in (0.2, 12.4, 200, 7300)] == [
        "under a second", "12 s", "3 min", "2 h",
    ]  # fmt: skip
    assert [clock.bytes_text(b) for b in (10, 5e7, 3e9)] == ["1 MB", "48 MB", "2.8 GB"]
    assert clock.progress_text(0.426, None) == "43 %"
    assert clock.progress_text(0.5, 8.2) == "50 %, 8 s left"
    assert [len(clock.bar(share)) for share in (-1, 0, 0.4, 2)] == [clock.BAR] * 4
