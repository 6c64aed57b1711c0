"""An operation added in C++ alone is a Python function: its name, parameters, words and checks."""

import subprocess
import sys
from pathlib import Path

MODULE = Path(__file__).resolve().parents[2] / "build/release/tests/made_up_module"
# In a process of its own: the module has the same C++ types as sardf._core.
PROGRAM = """
import sys
sys.path.insert(0, sys.argv[1])
import made_up
pear = made_up.pear(center=(1, 0, 0), radius=2, taper=0.5)
print(pear((1, 3, 4)))
print(made_up.formula("wobble(x, y)")((0, 1, 0)))
print("thinner at the top" in made_up.pear.__doc__, "taper" in made_up.pear.__doc__)
try:
    made_up.pear(radius=-1)
except made_up.Error as error:
    print(error)
scene = made_up.Scene.from_json('{"sardf": 1, "solid": {"pear": {"radius": 2}}}')
print(scene.solid((0, 0, 0)))
"""


def test_a_made_up_operation_is_a_python_function():
    assert list(MODULE.glob("made_up*.so")), "scripts/test builds it"
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(MODULE)], capture_output=True, text=True
    )
    assert done.stderr == ""
    # At (1, 3, 4) from the centre (1, 0, 0): 2 - 0.5 * 4 - 5.
    lines = done.stdout.splitlines()
    assert float(lines[0]) == -5
    assert float(lines[1]) == 0
    assert lines[2] == "True True"
    assert lines[3] == "pear: radius is -1; a positive number is accepted"
    assert float(lines[4]) == 2
