"""What the tests that run Blender share: how to start each version, and small scenes."""

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
from PIL import Image
from repository import ROOT

HEADLESS = ROOT / "blender_addon/headless.py"
SCRIPTS = ROOT / "tests/blender"
SCREENSHOTS = ROOT / "build/screenshots"
# The environments that scripts/setup makes for Blender as a Python module.
MODULES = {"4.2.23": ".venv-bpy-4.2", "4.5.15": ".venv-bpy-4.5", "5.0.1": ".venv-bpy"}
VERSIONS = ("3.4.1", "5.0.1")
# Those in which the zips are installed: also the ones with long support between the two.
INSTALLED_VERSIONS = ("3.4.1", *MODULES)

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


def encoded(color):
    """0 to 255 on the screen, of linear colours; the same definition."""
    low = color <= 0.0031308
    return 255 * np.where(low, 12.92 * color, 1.055 * np.maximum(color, 0) ** (1 / 2.4) - 0.055)


def screenshot(name):
    """A screenshot as (rows, columns, 3), 0 to 255."""
    return np.asarray(Image.open(SCREENSHOTS / f"{name}.png").convert("RGB"), float)


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


def bpy_python(version):
    """The Python in which `import bpy` gives that Blender."""
    python = ROOT / MODULES[version] / "bin/python"
    assert python.exists(), f"no {python}: run scripts/setup --older-blenders"
    return python


def tool(script, *arguments):
    """Run one of our Python scripts with the Python that runs the tests."""
    words = [sys.executable, script, *arguments]
    return subprocess.run([str(word) for word in words], capture_output=True, text=True)


def start_script(version, script, *arguments, user_folder, env=None, cwd=None):
    """Start a Python script in a Blender version, in the folder `cwd` if it is given.

    For 3.4.1 this is the documented command without --python-exit-code, so that the exit code is
    the script's own doing.
    """
    words = [str(argument) for argument in arguments]
    if version == "3.4.1":
        command = ["blender", "-b", "-P", str(script), "--", *words]
    else:
        # The script may want its arguments after "--", as in Blender.
        command = [
            str(bpy_python(version)),
            str(script),
            *([] if script == HEADLESS else ["--"]),
            *words,
        ]
    return subprocess.Popen(
        command,
        cwd=cwd,
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


# Windows are those of Debian 12's Blender, or of that in the chroot that SARDF_WINDOW_CHROOT names:
# scripts/test-blender-matrix runs these tests so.
WINDOW_CHROOT = os.environ.get("SARDF_WINDOW_CHROOT", "")
ENTER_CHROOT = os.environ.get("SARDF_BLENDER_CHROOT", "")


def in_window_system(words, user_folder):
    """The command as it is run where Blender's windows are, and the environment it needs."""
    ours = environment(user_folder)
    if not WINDOW_CHROOT:
        return words, ours
    folders = [f"{key}={value}" for key, value in ours.items() if key.startswith("BLENDER_USER_")]
    ours["BLENDER_CHROOT_BIND"] = f"{ROOT}:{user_folder.parent}"
    ours["BLENDER_CHROOT_CWD"] = str(ROOT)
    return [ENTER_CHROOT, "exec", WINDOW_CHROOT, "env", *folders, *words], ours


def newest_zip():
    """The extension of dist/ that scripts/package made last."""
    return max((ROOT / "dist").glob("sardf_blender-*[0-9].zip"), key=os.path.getmtime)


def install_for_window(zips, user_folder):
    """Install the add-on where run_in_window finds it, without enabling it."""
    if not WINDOW_CHROOT:
        with zipfile.ZipFile(zips["3.4.1"]) as archive:
            archive.extractall(user_folder / "scripts/addons")
        return
    for kind in ("config", "scripts"):
        (user_folder / kind).mkdir(parents=True, exist_ok=True)
    words = ["blender", "-c", "extension", "install-file", "-r", "user_default", str(newest_zip())]
    words, ours = in_window_system(words, user_folder)
    done = subprocess.run(words, env=ours, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr


def addon_for_window(user_folder):
    """The add-on's folder for scripts that load it themselves: the checkout's, or, for a Blender in
    a chroot, what the newest zip holds, with all that its wheels hold beside it."""
    if not WINDOW_CHROOT:
        return ROOT / "blender_addon"
    with zipfile.ZipFile(newest_zip()) as archive:
        archive.extractall(user_folder)
    folder = user_folder / "sardf_blender"
    for wheel in (folder / "wheels").iterdir():
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(folder / "vendor")
    return folder


def run_in_window(script, *arguments, user_folder, size, limit):
    """What tests/blender/gui_window.py's `result` became in a window of `size` (width, height).
    Screenshots are in SCREENSHOTS."""
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    user_folder.mkdir(parents=True, exist_ok=True)
    result_file = user_folder / f"{script.stem.removeprefix('gui_')}.json"
    width, height = map(str, size)
    words = [str(word) for word in (*arguments, SCREENSHOTS, result_file)]
    command, ours = in_window_system(
        ["xvfb-run", "-a", "-s", f"-screen 0 {width}x{height}x24",
         "blender", "--factory-startup", "--window-geometry", "0", "0", width, height,
         "-P", str(script), "--", *words],
        user_folder,
    )  # fmt: skip
    done = subprocess.run(command, env=ours, capture_output=True, text=True, timeout=limit)
    assert result_file.is_file(), done.stdout + done.stderr
    result = json.loads(result_file.read_text())
    assert not result["errors"], result["errors"][0]
    assert "Traceback" not in done.stdout + done.stderr, done.stdout + done.stderr
    return result


def run_check(zip_file, version, folder, check, *arguments, **keywords):
    """What tests/blender/CHECK.py returns, run by part_run.py with the installed zip."""
    result = folder / f"{check}.json"
    words = (zip_file, result, check, *arguments)
    # A folder that only these runs use: a start in which the extension is not enabled removes the
    # modules that it brought.
    user = folder / "user_with_zip"
    done = run_script(version, SCRIPTS / "part_run.py", *words, user_folder=user, **keywords)
    assert result.is_file(), done.stdout + done.stderr
    assert "Traceback" not in done.stdout + done.stderr, done.stdout + done.stderr
    return json.loads(result.read_text())
