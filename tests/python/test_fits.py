"""Fitted functions from Python: reports, cancel, Ctrl-C, and what else runs meanwhile."""

import itertools
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
import sardf

SARDF = Path(sys.executable).with_name("sardf")
# A problem that was solved is not solved again: each test takes another weight.
WEIGHTS = itertools.count(1)
# A fit in space of this many splines takes some seconds.
SPLINES = 24


def fitted(splines=SPLINES, **rest):
    """F = x in the unit cube, from a start that is 0 and 1 on two of its faces."""
    return {
        "start": "x^2/(x^2 + (1 - x)^2)",
        "factor": "x*(1 - x)",
        "lower": (0, 0, 0),
        "upper": (1, 1, 1),
        "splines": [splines],
        "smoothness": next(WEIGHTS),
        **rest,
    }


def scene_text(count=1, splines=SPLINES):
    """A scene file with so many fitted fields."""
    fields = {"part": {"sphere": {"radius": 1}}}
    for i in range(count):
        words = fitted(splines)
        words["start"], words["factor"] = "=" + words["start"], "=" + words["factor"]
        fields[f"F{i}"] = {"fitted": words}
    return json.dumps({"sardf": 1, "fields": fields, "solid": "part"})


def from_file(tmp_path, progress=None, **of_scene):
    path = tmp_path / "scene.json"
    path.write_text(scene_text(**of_scene))
    return sardf.load(str(path), progress=progress)


def makers(tmp_path):
    """Every way to solve a fit, as functions of a progress."""
    return {
        "fitted": lambda progress=None: sardf.fitted(**fitted(), progress=progress),
        "load": lambda progress=None: from_file(tmp_path, progress),
        "from_json": lambda progress=None: sardf.Scene.from_json(scene_text(), progress=progress),
    }


WAYS = ["fitted", "load", "from_json"]


@pytest.mark.timed
@pytest.mark.parametrize("way", WAYS)
def test_progress_rises_and_cancels(tmp_path, way):
    make, shares = makers(tmp_path)[way], []
    make(shares.append)
    assert len(shares) > 10
    assert shares == sorted(shares)
    assert shares[-1] == 1
    asked = []

    def cancel(share):
        if share >= 0.3:
            asked.append(time.perf_counter())
        return share < 0.3

    with pytest.raises(sardf.Cancelled):
        make(cancel)
    assert time.perf_counter() - asked[0] < 0.1


def test_progress_rises_over_several_fits(tmp_path):
    shares = []
    from_file(tmp_path, shares.append, count=3, splines=8)
    assert shares == sorted(shares)
    # 9/10 of what is left for each.
    for low, high in itertools.pairwise((0, 0.9, 0.99, 0.999)):
        assert any(low <= share < high for share in shares)
    assert shares[-1] == 1


def test_a_scene_from_python_takes_a_progress():
    shares = []
    sardf.Scene(solid=sardf.sphere(radius=1), progress=shares.append)
    assert shares == [1]


@pytest.mark.parametrize("way", WAYS)
def test_an_error_in_the_progress_is_raised(tmp_path, way):
    with pytest.raises(ZeroDivisionError):
        makers(tmp_path)[way](lambda share: 1 / 0)


@pytest.mark.timed
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("reports", [True, False])
def test_ctrl_c_stops_a_fit_at_once(tmp_path, way, reports):
    """The signal comes to the process, as from a terminal, while the fit computes."""
    sent, started = [], threading.Event()

    def interrupt():
        started.wait(10)
        begun = time.process_time()
        while time.process_time() < begun + 0.2:
            threading.Event().wait(0.005)
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt, daemon=True)
    thread.start()
    make = makers(tmp_path)[way]
    started.set()
    with pytest.raises(KeyboardInterrupt):
        make(lambda share: True) if reports else make()
    stopped = time.perf_counter()
    thread.join()
    assert stopped - sent[0] < 0.1


@pytest.mark.timed
def test_ctrl_c_stops_a_mesh_at_once():
    scene, sent = sardf.Scene(solid=sardf.sphere(radius=1)), []

    def progress(share):
        if share > 0.1 and not sent:
            sent.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        scene.mesh(resolution=300, size=0, progress=progress)
    assert time.perf_counter() - sent[0] < 0.2


@pytest.mark.timed
@pytest.mark.parametrize("way", WAYS)
def test_other_threads_run_while_a_fit_is_solved(tmp_path, way):
    ticks, done = [], threading.Event()

    def tick():
        while not done.wait(0.005):
            ticks.append(time.perf_counter())

    thread = threading.Thread(target=tick, daemon=True)
    thread.start()
    begun = time.perf_counter()
    makers(tmp_path)[way]()
    ended = time.perf_counter()
    done.set()
    thread.join()
    during = [begun, *(t for t in ticks if begun < t < ended), ended]
    # With the GIL held there would be one gap as long as the fit.
    assert max(b - a for a, b in itertools.pairwise(during)) < 0.5 * (ended - begun)


def test_a_wrong_argument_is_named():
    with pytest.raises(sardf.Error, match="fitted has no parameter 'progres'"):
        sardf.fitted(**fitted(), progres=None)
    assert "progress: called with the share done" in sardf.fitted.__doc__
    with pytest.raises(sardf.Error, match="no parameter 'progress'"):
        sardf.sphere(radius=1, progress=None)


def test_a_solution_is_read_by_another_process(tmp_path):
    """What `sardf solve` wrote reads at once here; after a change it is refused."""
    plain, solved = tmp_path / "plain.json", tmp_path / "solved.json"
    plain.write_text(scene_text(count=2, splines=8))

    def solve(path):
        subprocess.run([str(SARDF), "solve", str(path), "-o", str(solved)], check=True)

    solve(plain)
    shares = []
    scene = sardf.load(str(solved), progress=shares.append)
    assert shares == [1]
    document = json.loads(solved.read_text())
    assert json.loads(scene.to_json())["fields"] == document["fields"]
    document["fields"]["F1"]["fitted"]["smoothness"] += 1000
    solved.write_text(json.dumps(document))
    with pytest.raises(sardf.Error, match="the coefficients solve another problem"):
        sardf.load(str(solved))
    solve(solved)
    sardf.load(str(solved))
