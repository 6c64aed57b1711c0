"""What the tests that run Blender share: how to start each version, and small scenes."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from repository import ROOT

BPY_PYTHON = ROOT / ".venv-bpy/bin/python"
HEADLESS = ROOT / "blender_addon/headless.py"
SCRIPTS = ROOT / "tests/blender"
VERSIONS = ("3.4.1", "5.0.1")

RED, STEEL = "#c03020", "#8a8f98"
GRADED_SPHERE = {
    "sardf": 1,
    "title": "graded sphere",
    "units": "cm",
    "fields": {"ball": {"sphere": {"radius": 5}}},
    "solid": "ball",
    "materials": {
        "red": {"color": RED, "roughness": 0.25},
        "steel": {"color": STEEL, "metallic": 1, "roughness": 0.75},
    },
    "fractions": {
        "inverse_distance": {
            "features": [
                {"at": {"point": {"at": [-8, 0, 0]}}, "material": "red", "exponent": 2},
                {"at": {"point": {"at": [8, 0, 0]}}, "material": "steel", "exponent": 2},
            ]
        }
    },
}
BOX = {
    "sardf": 1,
    "units": "mm",
    "fields": {"brick": {"box": {"size": [4, 3, 2]}}},
    "solid": "brick",
    "materials": {"clay": {"color": "#a0522d"}},
    "fractions": {"constant": {"clay": 1}},
}


def linear(color):
    """A "#rrggbb" colour in linear Rec. 709, by the definition of sRGB (IEC 61966-2-1)."""
    encoded = np.array([int(color[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def expected_fractions(points):
    """Inverse squared distances to the two feature points of GRADED_SPHERE, normalised."""
    weights = np.stack(
        [1 / np.sum((points - [at, 0, 0]) ** 2, axis=-1) for at in (-8.0, 8.0)], axis=-1
    )
    return weights / weights.sum(axis=-1, keepdims=True)


def expected_colors(points):
    """Linear base colour of GRADED_SPHERE."""
    return expected_fractions(points) @ np.stack([linear(RED), linear(STEEL)])


def write_scene(folder, scene, name="part.json"):
    path = Path(folder) / name
    path.write_text(json.dumps(scene))
    return path


def environment(user_folder):
    """The process's environment with a Blender user folder of its own and no SARDF_PYTHON."""
    result = {k: v for k, v in os.environ.items() if k != "SARDF_PYTHON"}
    result["BLENDER_USER_RESOURCES"] = str(user_folder)
    for kind in ("SCRIPTS", "CONFIG", "DATAFILES"):
        result[f"BLENDER_USER_{kind}"] = f"{user_folder}/{kind.lower()}"
    return result


def build_zips(wheel, folder):
    """The extension's and the older Blenders' zip of a wheel as scripts/setup builds it."""
    script = ROOT / "scripts/self_contained.py"
    made = tool(script, wheel, "-o", folder / "wheels")
    assert made.returncode == 0, made.stderr
    done = tool(ROOT / "blender_addon/build.py", "--wheel", made.stdout.strip(), "-o", folder)
    assert done.returncode == 0, done.stderr
    return [Path(line) for line in done.stdout.splitlines()]


def tool(script, *arguments):
    """Run one of our Python scripts with the Python that runs the tests."""
    words = [sys.executable, script, *arguments]
    return subprocess.run([str(word) for word in words], capture_output=True, text=True)


def start_script(version, script, *arguments, user_folder, env=None):
    """Start a Python script in a Blender version.

    For 3.4.1 this is the documented command without --python-exit-code, so that the exit code is
    the script's own doing.
    """
    words = [str(argument) for argument in arguments]
    if version == "3.4.1":
        command = ["blender", "-b", "-P", str(script), "--", *words]
    else:
        # The script may want its arguments after "--", as in Blender.
        command = [str(BPY_PYTHON), str(script), *([] if script == HEADLESS else ["--"]), *words]
    return subprocess.Popen(
        command,
        env=environment(user_folder) | (env or {}),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def run_script(version, script, *arguments, limit=300, **keywords):
    """Run a script as start_script does; returns the finished process."""
    with start_script(version, script, *arguments, **keywords) as process:
        try:
            output, errors = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
    return subprocess.CompletedProcess(process.args, process.returncode, output, errors)
