"""A bake of 8192² texels stays within 2 GiB."""

import subprocess
import sys
from pathlib import Path

import pytest
import sardf

ROOT = Path(__file__).resolve().parents[2]
SARDF = Path(sys.executable).with_name("sardf")
# Runs a command and prints the most memory that it had, in KiB.
MEASURE = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], check=True)
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
"""


@pytest.mark.long
def test_memory_of_an_8k_bake(tmp_path):
    scene = ROOT / "scenes" / "lined_bore.json"
    assert len(sardf.load(str(scene)).materials) == 3
    bake = [SARDF, "bake", scene, "-o", tmp_path, "--size", "8192"]
    done = subprocess.run(
        [sys.executable, "-c", MEASURE, *map(str, bake)], capture_output=True, text=True, check=True
    )
    assert int(done.stdout.splitlines()[-1]) * 1024 < 2 * 2**30
    assert {path.stem for path in tmp_path.glob("*.exr")} >= {"base_color", "fractions_1"}
