"""What is said before a bake about its time and memory, against what it takes."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
import sardf
from repository import ROOT

PROBE = Path(__file__).with_name("bake_probe.py")


def probe(scene, resolution, size, *names):
    words = [sys.executable, PROBE, ROOT, ROOT / "scenes" / scene, resolution, size, *names]
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    print(done.stdout)
    return json.loads(done.stdout)


@pytest.mark.timed
@pytest.mark.parametrize(
    ("scene", "resolution", "size"),
    [("lined_bore.json", 128, 2048), ("lined_bore.json", 300, 1024), ("cad_pins.json", 64, 2048)],
)
def test_memory_is_told_to_20_percent_and_time_to_a_factor_of_3(scene, resolution, size):
    found = probe(scene, resolution, size)
    told, took = found["seconds"]
    assert took / 3 < told < 3 * took
    told, peak = found["bytes"]
    assert 0.8 * peak < told < 1.2 * peak
    told, made = found["faces"]
    assert 0.8 * made < told < 1.25 * made
    told, baked = found["texels per unit"]
    assert 0.7 * baked < told < 1.4 * baked


SPHERE = {
    "sardf": 1,
    "fields": {"ball": {"sphere": {"radius": 5}}},
    "solid": "ball",
    "materials": {"red": {}, "blue": {}},
}


@pytest.fixture(scope="module")
def sample():
    return sardf.measure_bake(
        sardf.Scene.from_json(json.dumps(SPHERE)), ["base_color", "roughness"]
    )


def test_what_was_seen_of_a_part_is_what_it_is(sample):
    assert sample.area == pytest.approx(4 * 3.14159265 * 25, rel=0.02)
    assert sample.components == 4


def test_cost_grows_with_what_is_asked_for(sample):
    small, fine = sample.cost(64, 1024), sample.cost(256, 1024)
    large, given = sample.cost(64, 4096), sample.cost(64, 1024, atlas=False, faces=1000)
    assert fine.mesh_seconds > small.mesh_seconds
    assert fine.faces == pytest.approx(16 * small.faces, rel=0.01)
    assert large.bake_seconds == pytest.approx(16 * small.bake_seconds)
    assert large.store_seconds == pytest.approx(16 * small.store_seconds)
    assert large.texels_per_unit == pytest.approx(4 * small.texels_per_unit)
    assert large.bytes > 9 * small.bytes
    assert given.mesh_seconds == 0
    assert given.seconds < small.seconds
    known = sample.cost(64, 1024, texels_per_unit=10.0)
    assert known.texels_per_unit == 10
    assert known.bake_seconds < small.bake_seconds


def test_measuring_can_be_cancelled():
    with pytest.raises(sardf.Cancelled):
        sardf.measure_bake(sardf.Scene.from_json(json.dumps(SPHERE)), progress=lambda share: False)
