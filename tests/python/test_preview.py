"""The preview without Blender: the worker thread, and what the probe says."""

import json
import threading
import time

import numpy as np
import pytest
import sardf
from blender_runs import GRADED_SPHERE, expected_colors, expected_fractions

from blender_addon.preview import preview_reading, preview_sampler, preview_volume

Wish, Sampler = preview_volume.Wish, preview_sampler.Sampler

LIMIT = 60.0


@pytest.fixture
def sampler():
    made = Sampler(sardf)
    yield made
    made.stop()
    assert not made.running


def ball(radius=5.0):
    scene = json.loads(json.dumps(GRADED_SPHERE))
    scene["fields"]["ball"]["sphere"]["radius"] = radius
    return json.dumps(scene)


@pytest.fixture
def fine_begun(monkeypatch):
    """An event: a fine picture is at work."""
    begun, make = threading.Event(), preview_sampler.make_volume

    def make_and_tell(scene, wish, resolution, go_on):
        if resolution > preview_sampler.COARSE:
            begun.set()
        return make(scene, wish, resolution, go_on)

    monkeypatch.setattr(preview_sampler, "make_volume", make_and_tell)
    return begun


def results(sampler, count):
    """The next results, as (key, result)."""
    found, end = [], time.monotonic() + LIMIT
    while len(found) < count:
        sampler.wait(0.1)
        found += sampler.take()
        assert time.monotonic() < end
    return found


def test_coarse_comes_first_and_fine_follows(sampler):
    sampler.request("ball", Wish(ball(), resolution=96))
    (key, coarse), (_, fine) = results(sampler, 2)
    assert key == "ball"
    assert (max(coarse.counts), max(fine.counts)) == (preview_sampler.COARSE, 96)
    assert fine.scene is coarse.scene
    assert not sampler.busy
    assert 0 < coarse.seconds <= coarse.latency < fine.latency


def test_volumes_hold_the_ball_and_its_colours(sampler):
    sampler.request("ball", Wish(ball(), resolution=64, cut=True))
    fine = results(sampler, 2)[1][1]
    axes = [
        lo + (np.arange(n) + 0.5) * cell
        for lo, n, cell in zip(fine.lo, fine.counts, fine.cell, strict=True)
    ]
    z, y, x = np.meshgrid(*reversed(axes), indexing="ij")
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    np.testing.assert_allclose(
        fine.field * fine.unit, 5 - np.linalg.norm(points, axis=-1), atol=1e-5
    )
    assert np.abs(np.diff(fine.field.reshape(fine.counts[::-1]), axis=0)).max() <= 1
    color = fine.color.reshape(-1, 4)
    inside = fine.field >= 0
    assert (color[inside][:, 3] == 1).all()
    np.testing.assert_allclose(color[inside][:, :3], expected_colors(points[inside]), atol=1e-5)
    # Two samples lie outside on each side, so that the surface lies between samples.
    assert not inside.reshape(fine.counts[::-1])[:2].any()


def test_the_newest_wish_wins(sampler):
    for radius in np.linspace(3, 6, 40):
        sampler.request("ball", Wish(ball(radius), resolution=64))
    last = results(sampler, 1)
    while sampler.busy:
        last += results(sampler, 1)
    assert last[-1][1].wish.source == ball(6.0)
    assert max(last[-1][1].counts) == 64
    assert len(last) < 40


def test_what_is_new_goes_before_what_is_fine(sampler, fine_begun):
    sampler.request("large", Wish(ball(), resolution=400, cut=True))
    results(sampler, 1)
    assert fine_begun.wait(LIMIT)
    begun = time.monotonic()
    sampler.request("small", Wish(ball(2), resolution=32))
    (key, _), *_ = results(sampler, 1)
    assert key == "small"
    assert time.monotonic() - begun < 2
    (key, fine), *_ = results(sampler, 1)
    assert (key, max(fine.counts)) == ("large", 400)


def test_forgotten_parts_come_no_more(sampler):
    sampler.request("ball", Wish(ball(), resolution=300))
    sampler.forget("ball")
    sampler.request("other", Wish(ball(), resolution=64))
    assert [key for key, _ in results(sampler, 2)] == ["other", "other"]
    assert not sampler.busy


def test_the_thread_ends_at_once(fine_begun):
    sampler = Sampler(sardf)
    sampler.request("ball", Wish(ball(), resolution=500, cut=True))
    results(sampler, 1)
    assert fine_begun.wait(LIMIT)
    begun = time.monotonic()
    sampler.stop(limit=LIMIT)
    assert time.monotonic() - begun < 1  # the core's own limit is 0.1 s; the machine may be busy
    assert not [t for t in threading.enumerate() if t.name == "sardf preview"]


def test_errors_are_handed_over(sampler):
    sampler.request("bad", Wish('{"sardf": 1, "solid": "nothing"}'))
    sampler.request("none", Wish(ball(), channel="hardness"))
    errors = dict(results(sampler, 2))
    assert "nothing" in str(errors["bad"])
    assert "there is no channel 'hardness'" in str(errors["none"])
    assert all(isinstance(error, sardf.Error) for error in errors.values())
    sampler.request("bad", Wish(ball(), resolution=32))
    assert results(sampler, 1)[0][1].field.size


def test_vectors_are_refused(sampler):
    scene = dict(GRADED_SPHERE, attributes={"way": {"value": ["= x", "= y", "= z"]}})
    sampler.request("ball", Wish(json.dumps(scene), channel="way"))
    error = results(sampler, 1)[0][1]
    assert isinstance(error, preview_volume.PreviewError)
    assert "'way' has several components" in str(error)


def test_a_mesh_stands_in_where_there_are_no_textures(sampler):
    sampler.request("ball", Wish(ball(), stand_in=(((0.0, -2.0, 0.0, 0.0),),)))
    made = results(sampler, 1)[0][1]
    assert not sampler.busy
    assert made.vertices[:, 1].min() > -1e-6
    on_cut = np.abs(made.vertices[:, 1]) < 1e-6
    assert on_cut.sum() > 100
    np.testing.assert_allclose(made.colors[:, :3], expected_colors(made.vertices), atol=1e-9)
    sampler.request("ball", Wish(ball(), channel="fractions", material="red", stand_in=()))
    made = results(sampler, 1)[0][1]
    np.testing.assert_allclose(made.values, expected_fractions(made.vertices)[:, 0], atol=1e-9)
    assert made.range == (0.0, 1.0)


CORNER = ((1.0, 0.0, 0.0, 0.0), (0.0, -2.0, 0.0, 0.0), (0.0, 0.0, 0.5, 0.5))  # x > 0, y < 0, z > -1
ALL = ((0.0, 0.0, 1.0, 9.0),)


def test_cuts_leave_what_is_below_one_of_their_planes(sampler):
    """Of one cut's planes all count, and of several cuts each."""
    sampler.request("ball", Wish(ball(), stand_in=(CORNER, ((-1.0, 0.0, 0.0, -3.0),))))
    made = results(sampler, 1)[0][1]
    x, y, z = made.vertices.T
    assert not ((x > 1e-6) & (y < -1e-6) & (z > -1 + 1e-6)).any()
    assert x.min() > -3 - 1e-6
    assert (np.abs(x) < 1e-6).sum() > 20  # the corner's two sides and its floor
    assert (np.abs(y) < 1e-6).sum() > 20
    assert ((np.abs(z + 1) < 1e-6) & (x > 0) & (y < 0)).sum() > 20


def test_a_mesh_of_nothing_stands_in_where_cuts_leave_nothing(sampler):
    sampler.request("ball", Wish(ball(), stand_in=(ALL,)))
    made = results(sampler, 1)[0][1]
    assert made.vertices.shape == (0, 3)
    sampler.request("ball", Wish(ball(), channel="fractions", material="red", stand_in=(ALL,)))
    assert results(sampler, 1)[0][1].vertices.shape == (0, 3)


def test_whether_cuts_leave_anything_is_known_of_a_volume(sampler):
    sampler.request("ball", Wish(ball(), resolution=32))
    volume = results(sampler, 1)[0][1]
    assert np.linalg.norm(volume.inside, axis=1).max() < 5
    assert len(volume.inside) > 1000
    for cuts, expected in (
        ((), True), ((CORNER,), True), ((ALL,), False),
        ((((1.0, 0, 0, -0.1),), ((-1.0, 0, 0, 0.2),)), False),  # x > 0.1 and x < 0.2
        ((((1.0, 0, 0, -3.0),), ((-1.0, 0, 0, 0.2),)), True),
    ):  # fmt: skip
        assert preview_volume.is_left(sardf, volume.inside, cuts) == expected, cuts
    sampler.request("ball", Wish(ball().replace('"solid": "ball"', '"solid": "ball", "sections": '
                    '[{"remove": {"sphere": {"radius": 9}}}]'), resolution=32))  # fmt: skip
    assert len(results(sampler, 1)[0][1].inside) == 0


@pytest.fixture(scope="module")
def scene():
    return sardf.Scene.from_json(ball())


def test_probe_says_what_is_there(scene):
    told = preview_reading.lines(scene, (0.0, 0.0, 0.0))
    assert told == ["(0, 0, 0) cm", "distance 5 cm", "red 50.0 %", "steel 50.0 %"]
