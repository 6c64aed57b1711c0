"""Long work: callbacks that raise or cancel in the middle, and forced instruction sets."""

import hashlib
import os
import subprocess
import sys

import pytest
import sardf

SCENE = """{"sardf": 1,
  "materials": {"a": {"color": "#ff0000"}, "b": {"color": "#0000ff"}},
  "solid": {"union": {"of": [{"box": {"size": [6, 5, 3]}}, {"sphere": {"radius": 2.6}}],
                      "blend": {"sardf": 0.5}}},
  "fractions": {"functions": {"a": "=0.5 + 0.4 * sin(x)", "b": "rest"}}}"""

# Prints a hash of values in float and double, and of a mesh.
PROGRAM = f"""
import hashlib, numpy, sardf
scene = sardf.Scene.from_json('''{SCENE}''')
points = numpy.random.default_rng(5).uniform(-4, 4, (5000, 3))
parts = [scene.solid(points), scene.solid(points.astype(numpy.float32)), scene.fractions(points),
         scene.mesh(resolution=24, size=0).vertices]
data = b"".join(numpy.ascontiguousarray(part).tobytes() for part in parts)
print(hashlib.sha256(data).hexdigest())
"""


class OwnError(Exception):
    """What only the caller knows."""


@pytest.fixture(scope="module")
def scene():
    return sardf.Scene.from_json(SCENE)


def works(scene):
    mesh = scene.mesh(resolution=32, size=256)
    return {
        "mesh": lambda progress=None: (
            scene.mesh(resolution=32, size=256, progress=progress).vertices
        ),
        "bake": lambda progress=None: scene.bake(mesh, size=256, progress=progress)["base_color"],
    }


@pytest.mark.parametrize("name", ["mesh", "bake"])
@pytest.mark.parametrize("after", [0, 1, 3])
def test_callbacks_that_raise_or_cancel_in_the_middle(scene, name, after):
    work = works(scene)[name]
    expected = hashlib.sha256(work().tobytes()).digest()
    reports = []

    def raise_after(share):
        reports.append(share)
        if len(reports) > after:
            raise OwnError(share)

    with pytest.raises(OwnError):
        work(raise_after)
    # It is raised once, at once: nothing is asked again.
    assert len(reports) == after + 1
    reports.clear()

    def cancel_after(share):
        reports.append(share)
        return len(reports) <= after

    with pytest.raises(sardf.Cancelled):
        work(cancel_after)
    assert hashlib.sha256(work().tobytes()).digest() == expected


def run_with(instruction_set):
    environment = {**os.environ, "SARDF_INSTRUCTION_SET": instruction_set}
    return subprocess.run(
        [sys.executable, "-c", PROGRAM], env=environment, capture_output=True, text=True
    )


def test_forced_instruction_sets_give_the_same_bits():
    runs = [run_with(name) for name in ("baseline", "avx2", "avx512")]
    assert [run.returncode for run in runs] == [0, 0, 0], runs
    assert len({run.stdout for run in runs}) == 1


def test_unknown_instruction_set_is_one_clear_error():
    run = run_with("sse9")
    assert run.returncode == 1
    message = "SARDF_INSTRUCTION_SET is 'sse9'; accepted are baseline, avx2 and avx512"
    assert run.stderr.strip().splitlines()[-1].endswith(message)
