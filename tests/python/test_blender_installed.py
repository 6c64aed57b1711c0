"""The installed zips: another Python's module, a folder that cannot be written, the commands."""

import json
import os
import subprocess
import zipfile
from pathlib import Path

import pytest
from blender_runs import (
    GRADED_SPHERE,
    HEADLESS,
    MODULES,
    SCRIPTS,
    bpy_python,
    environment,
    write_scene,
)
from repository import ROOT

# A file system of its own for the process, where the folder cannot be written, even by root.
READ_ONLY = """
mount --bind "$0" "$0"; mount -o remount,ro,bind "$0"
! touch "$0/written" 2>/dev/null; exec "$@"
"""


@pytest.fixture(scope="module")
def sites(tmp_path_factory):
    """{Version: what its environment holds, without sardf}: only the zip's can be found."""
    folders = {version: tmp_path_factory.mktemp("site") for version in MODULES}
    for version, folder in folders.items():
        libraries = bpy_python(version).parent.parent / "lib"
        for path in next(libraries.glob("python3*/site-packages")).iterdir():
            if not path.name.startswith("sardf"):
                (folder / path.name).symlink_to(path)
    return folders


def run(version, script, *arguments, folder, sites, prefix=()):
    words = [str(argument) for argument in arguments]
    if version == "3.4.1":
        command = ["blender", "-b", "--python-exit-code", "3", "-P", str(SCRIPTS / script), "--"]
    else:  # -S: without the environment's own packages
        command = [str(bpy_python(version)), "-S", str(SCRIPTS / script), "--"]
    user = environment(folder / "user")
    if version in sites:
        user["PYTHONPATH"] = str(sites[version])
    for kind in ("config", "scripts"):
        (folder / "user" / kind).mkdir(parents=True, exist_ok=True)
    done = subprocess.run(
        [*prefix, *command, *words], capture_output=True, text=True, env=user, timeout=300
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done


def for_another_python(path, target):
    """The zip with its module as if it had been compiled for Python 3.9."""
    with zipfile.ZipFile(path) as source, zipfile.ZipFile(target, "w") as made:
        for name in source.namelist():
            data = source.read(name)
            if name.endswith("blender_manifest.toml"):
                data = data.replace(b"cp311", b"cp39")
            made.writestr(name.replace("cp311", "cp39").replace("cpython-311", "cpython-39"), data)
    return target


def test_a_zip_for_another_python_is_refused_in_clear_words(version, zips, sites, tmp_path):
    wrong = for_another_python(zips[version], tmp_path / "wrong.zip")
    result = tmp_path / "result.json"
    words = (result, "refused", wrong, write_scene(tmp_path, GRADED_SPHERE))
    run(version, "installed_steps.py", *words, folder=tmp_path, sites=sites)
    found = json.loads(result.read_text())
    if "by Blender" in found:
        assert version != "3.4.1"
        assert "3.9" in found["by Blender"] or "not enabled" in found["by Blender"]
        return
    for text in found.values():
        assert "'sardf' built for cp311 (this is Python 3.11) was not found" in text
        assert "this zip of the add-on brought it for cp39 only" in text, text
        assert "use a zip that has it for cp311" in text


def test_an_installed_zip_is_used_and_nothing_written_to_its_folder(version, zips, sites, tmp_path):
    if os.geteuid() != 0:
        pytest.skip("a file system that cannot be written needs root")
    common = {"folder": tmp_path, "sites": sites}
    scene = write_scene(tmp_path, GRADED_SPHERE)
    words = ("install", tmp_path / "installed.json", zips[version])
    run(version, "matrix_steps.py", *words, **common)
    (addon,) = (p for p in (tmp_path / "user").rglob("sardf_blender") if p.is_dir())
    before = {path: path.read_bytes() for path in addon.rglob("*") if path.is_file()}
    prefix = ["unshare", "--mount", "--propagation", "private", "sh", "-euc", READ_ONLY, str(addon)]
    used, reopened = (tmp_path / f"{name}.json" for name in ("used", "reopened"))
    run(version, "matrix_steps.py", "use", used, scene, tmp_path, prefix=prefix, **common)
    run(version, "matrix_steps.py", "reopen", reopened, scene, tmp_path, prefix=prefix, **common)
    used, reopened = (json.loads(path.read_text()) for path in (used, reopened))
    assert used["version"].startswith(version)
    assert reopened["state"] == used["state"]
    assert reopened["settings"] == [True, 48, "512"]
    assert sorted(reopened["baked again"]) == sorted(used["state"])
    assert used["color error"] < 0.02
    assert str(tmp_path / "user") in used["core"]
    assert (tmp_path / "part.blend").is_file()
    after = {path: path.read_bytes() for path in addon.rglob("*") if path.is_file()}
    assert after == before


@pytest.mark.parametrize("version", MODULES)
def test_commands_bake_render_and_export(version, zips, sites, tmp_path):
    """In Blenders with commands; `blender -c sardf` itself is for scripts/test-blender-matrix."""
    scene = str(write_scene(tmp_path, GRADED_SPHERE))
    small = ["--resolution", "12", "--size", "128", "--width", "24", "--height", "16"]
    runs = {
        "help": ["--help"],
        "bake": ["bake", scene, "-o", f"{tmp_path}/baked", *small, "--normal-map"],
        "render": ["render", scene, "-o", f"{tmp_path}/rendered", *small, "--samples", "1"],
        "pov": ["export", scene, "-o", f"{tmp_path}/part.pov"],
        "json": ["export", scene, "-o", f"{tmp_path}/copy.json"],
        "nothing": [],
        "unknown": ["print", scene],
        "no part": ["export", f"{tmp_path}/baked/part.blend", "-o", f"{tmp_path}/x.json"],
        "ending": ["export", scene, "-o", f"{tmp_path}/x.obj"],
        "missing": ["bake", scene + ".missing", "-o", f"{tmp_path}/none"],
    }
    result = tmp_path / "result.json"
    words = (result, "commands", zips[version], json.dumps(list(runs.values())))
    run(version, "installed_steps.py", *words, folder=tmp_path, sites=sites)
    found = json.loads(result.read_text())
    assert found["registered"] == 1
    assert found["enabled still"]
    of = dict(zip(runs, found["runs"], strict=True))
    codes = {name: code for name, (code, _, _) in of.items()}
    errors = {name: text for name, (_, _, text) in of.items()}
    assert codes == dict.fromkeys(runs, 0) | dict.fromkeys(list(runs)[5:], 2), errors
    assert "bake|render|export" in of["help"][1]
    textures = {path.name for path in (tmp_path / "baked/textures").iterdir()}
    assert textures == {f"{name}.exr" for name in (
        "base_color", "emission", "fractions_1", "metallic", "normal", "roughness")}  # fmt: skip
    assert not (tmp_path / "baked/part.png").exists()
    assert (tmp_path / "rendered/part.png").stat().st_size > 100
    assert "#include" in (tmp_path / "part.pov").read_text()
    assert json.loads((tmp_path / "copy.json").read_text())["title"] == "graded sphere"
    assert "there is no command 'print'; render, bake, export, reference are" in errors["unknown"]
    assert "part.blend: has no part" in errors["no part"]
    assert "expected a name that ends in .json or .pov" in errors["ending"]
    assert not (tmp_path / "none").exists() or not list((tmp_path / "none").iterdir())


def test_a_part_in_a_blend_is_rendered_and_exported(tmp_path):
    """headless.py takes a .blend; the parts' own tests make the file's content."""
    made = tmp_path / "parts.blend"
    code = f"""
import sys
sys.path.insert(0, {str(ROOT)!r})
import blender_addon
import bpy
blender_addon.register()
from blender_addon import core
from blender_addon.parts import part_import
bpy.ops.wm.read_homefile(use_empty=True)
part_import.import_scene(core.load(), {str(write_scene(tmp_path, GRADED_SPHERE))!r}, bpy.context)
bpy.ops.wm.save_as_mainfile(filepath={str(made)!r})
"""
    user = environment(tmp_path / "user")
    done = subprocess.run(
        [bpy_python("5.0.1"), "-c", code], capture_output=True, text=True, env=user
    )
    assert made.is_file(), done.stdout + done.stderr
    small = ["--resolution", "12", "--size", "128", "--width", "24", "--height", "16"]
    words = [bpy_python("5.0.1"), HEADLESS, made, "-o", tmp_path / "out", "--look", "flat", *small]
    done = subprocess.run(words, capture_output=True, text=True, env=user)
    assert done.returncode == 0, done.stdout + done.stderr
    written = {path.name for path in Path(tmp_path / "out").iterdir()}
    assert written == {"flat.exr", "part.blend", "camera.json", "textures"}
