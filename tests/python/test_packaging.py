"""The wheels and zips of the Blender add-on: what is in them, and what they need."""

import csv
import hashlib
import importlib.util
import io
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from base64 import urlsafe_b64encode
from pathlib import Path

import pytest
from blender_runs import GRADED_SPHERE, bpy_python, build_zips, tool, write_scene
from repository import ROOT

BUILD, SELF_CONTAINED = ROOT / "blender_addon/build.py", ROOT / "scripts/self_contained.py"
VERSION = re.search(r"project\(sardf VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
# What Debian 12 has. Debian 12, Ubuntu 22.04 (but for glibc, 2.35) and later systems have them;
# official Blenders use the system's libraries.
NEWEST = {"GLIBC": (2, 36), "GLIBCXX": (3, 4, 30), "CXXABI": (1, 3, 13), "GCC": (12, 0, 0)}
OURS = "libsardf_tbb.so.12"
OF_THE_SYSTEM = {
    "libc.so.6",
    "libm.so.6",
    "libgcc_s.so.1",
    "libstdc++.so.6",
    "ld-linux-x86-64.so.2",
}


@pytest.fixture(scope="module")
def built():
    wheels = list((ROOT / "build/dist").glob("sardf-*.whl"))
    assert len(wheels) == 1, "scripts/setup builds one wheel"
    return wheels[0]


@pytest.fixture(scope="module")
def zips(built, tmp_path_factory):
    return build_zips(built, tmp_path_factory.mktemp("dist"))


@pytest.fixture(scope="module")
def wheel(zips):
    (path,) = (zips[0].parent / "wheels").iterdir()
    return path


@pytest.fixture(scope="module")
def unpacked(wheel, tmp_path_factory):
    folder = tmp_path_factory.mktemp("unpacked")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
    return folder


def compiled(unpacked):
    (module,) = (unpacked / "sardf").glob("_core.*.so")
    return {"module": module, "tbb": unpacked / "sardf" / OURS}


def output_of(*words):
    return subprocess.run(
        [str(w) for w in words], check=True, capture_output=True, text=True
    ).stdout


def test_wheel_needs_only_what_every_system_has(unpacked):
    for name, file in compiled(unpacked).items():
        needed = set(re.findall(r"NEEDED.*\[(.*)\]", output_of("readelf", "-W", "-d", file)))
        assert needed <= OF_THE_SYSTEM | ({OURS} if name == "module" else set())
        assert (OURS in needed) == (name == "module")
        for family, version in re.findall(
            r"Name: ([A-Z]+)_([0-9.]+)", output_of("readelf", "-VW", file)
        ):
            assert tuple(map(int, version.split("."))) <= NEWEST[family], (
                f"{name}: {family}_{version}"
            )
    assert not list(unpacked.rglob("_image.*"))
    assert not list(unpacked.rglob("*.data"))


def test_wheel_shows_no_symbols_of_others_and_takes_none_of_theirs(unpacked):
    """Blender's process has a TBB of its own; names that it knows would be bound to it."""
    files = compiled(unpacked)
    shown = output_of("nm", "-D", "--defined-only", files["module"]).split()[2::3]
    assert shown == ["PyInit__core"]
    wanted = output_of("nm", "-D", "--undefined-only", files["module"]).split()
    of_tbb = [name for name in wanted if "3tbb" in name]
    assert of_tbb
    assert all(name.startswith("sardf_") for name in of_tbb)
    offered = output_of("nm", "-D", "--defined-only", files["tbb"]).split()[2::3]
    assert set(of_tbb) <= set(offered)
    assert all(name.startswith("sardf_") for name in offered)


def test_another_tbb_in_the_process_changes_nothing(unpacked, tmp_path):
    """With the system's libtbb loaded first, for all to see, as Blender's is."""
    scene = write_scene(tmp_path, GRADED_SPHERE)
    theirs = "libtbb.so.12"
    code = f"""
import ctypes, sys
ctypes.CDLL({theirs!r}, ctypes.RTLD_GLOBAL)
sys.path.insert(0, {str(unpacked)!r})
import sardf
assert sardf.__file__.startswith({str(unpacked)!r})
print(len(sardf.load({str(scene)!r}).mesh(resolution=32).vertices))
"""
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env={"LD_DEBUG": "bindings"}
    )
    assert done.returncode == 0, done.stderr[-2000:]
    assert int(done.stdout) > 500
    bound = re.findall(r"binding file (\S*_core\S*) \[0\] to (\S*tbb\S*) ", done.stderr)
    assert {Path(library).name for _, library in bound} == {OURS}


def test_wheel_is_one_that_pip_accepts(wheel, built):
    pattern = rf"sardf-{re.escape(VERSION)}-cp311-cp311-manylinux_2_[0-9]+_x86_64\.whl"
    assert re.fullmatch(pattern, wheel.name)
    with zipfile.ZipFile(wheel) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    info = f"sardf-{VERSION}.dist-info"
    tag = wheel.stem.split("-", 2)[2]
    assert f"Tag: {tag}\n" in content[f"{info}/WHEEL"].decode()
    rows = {row[0]: row[1] for row in csv.reader(io.StringIO(content[f"{info}/RECORD"].decode()))}
    assert set(rows) == set(content)
    for name, data in content.items():
        digest = urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        assert rows[name] == ("" if name.endswith("RECORD") else f"sha256={digest}")
    assert b"Intel" in content[f"{info}/licenses/{OURS}.txt"]
    # Its Python files are those of the wheel that everybody gets.
    with zipfile.ZipFile(built) as archive:
        theirs = {n: archive.read(n) for n in archive.namelist() if n.endswith(".py")}
    assert theirs == {n: data for n, data in content.items() if n.endswith(".py")}


def test_extension_holds_wheels_and_the_older_addon_their_content(zips, wheel, unpacked):
    extension, legacy = zips
    assert extension.name == f"sardf_blender-{VERSION}.zip"
    assert legacy.name == f"sardf_blender-{VERSION}-legacy.zip"
    with zipfile.ZipFile(extension) as archive:
        names = archive.namelist()
        manifest = tomllib.loads(archive.read("sardf_blender/blender_manifest.toml").decode())
        assert archive.read(f"sardf_blender/wheels/{wheel.name}") == wheel.read_bytes()
    assert manifest["wheels"] == [f"./wheels/{wheel.name}"]
    assert manifest["version"] == VERSION
    assert manifest["platforms"] == ["linux-x64"]
    assert list(manifest["permissions"]) == ["files"]
    assert len(manifest["permissions"]["files"]) > 10
    with zipfile.ZipFile(legacy) as archive:
        older = archive.namelist()
        module = f"sardf_blender/vendor/sardf/{compiled(unpacked)['module'].name}"
        assert archive.read(module) == compiled(unpacked)["module"].read_bytes()
    assert f"sardf_blender/vendor/sardf/{OURS}" in older
    assert "sardf_blender/blender_manifest.toml" not in older
    for listed in (names, older):
        assert {name.split("/")[0] for name in listed} == {"sardf_blender"}
        assert not [n for n in listed if "__pycache__" in n or n.endswith(("/build.py", ".tmp"))]
    modules = ROOT / "blender_addon"
    own = {f"sardf_blender/{path.relative_to(modules)}" for path in modules.rglob("*.py")}
    own.remove("sardf_blender/build.py")
    assert own <= set(names)
    assert own <= set(older)


def test_blender_finds_the_extension_valid(zips):
    checker = next(ROOT.glob(".venv-bpy/lib/*/site-packages/bpy/*/scripts/**/cli/blender_ext.py"))
    words = [bpy_python("5.0.1"), checker, "validate", zips[0]]
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_equal_wheels_give_equal_zips(zips, wheel, tmp_path):
    assert tool(BUILD, "--wheel", wheel, "-o", tmp_path).returncode == 0
    for path in zips:
        assert (tmp_path / path.name).read_bytes() == path.read_bytes()


def test_zips_refuse_wheels_that_do_not_fit(built, wheel, tmp_path):
    for name in ("sardf-9.9.9-cp311-cp311-linux_x86_64.whl", "other-0.1.0-py3-none-any.whl"):
        shutil.copy(wheel, tmp_path / name)
        done = tool(BUILD, "--wheel", tmp_path / name, "-o", tmp_path / "dist")
        assert done.returncode == 2
        assert name in done.stderr
    done = tool(BUILD, "--wheel", built, "-o", tmp_path / "dist")
    assert done.returncode == 2
    assert "needs OpenImageIO; scripts/self_contained.py makes one" in done.stderr
    assert tool(BUILD, "--wheel", tmp_path / "missing.whl").returncode == 2
    assert not (tmp_path / "dist").exists()


def test_a_wheel_is_made_self_contained_once(wheel, built, tmp_path):
    done = tool(SELF_CONTAINED, wheel, "-o", tmp_path)
    assert done.returncode == 2
    assert "expected a wheel for linux on a system with glibc" in done.stderr
    again = tmp_path / built.name
    shutil.copy(wheel, again)
    done = tool(SELF_CONTAINED, again, "-o", tmp_path / "out")
    assert done.returncode == 2
    assert "was this done already?" in done.stderr
    assert not (tmp_path / "out").exists()


def test_one_version_number(tmp_path):
    """CMakeLists.txt says it; a manifest or bl_info that says another is an error."""
    spec = importlib.util.spec_from_file_location("build", BUILD)
    build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(build)
    assert build.addon_version() == VERSION
    copy = tmp_path / "blender_addon"
    copy.mkdir()
    for name in ("__init__.py", "blender_manifest.toml"):
        shutil.copy(ROOT / "blender_addon" / name, copy)
    (tmp_path / "CMakeLists.txt").write_text("project(sardf VERSION 7.8.9 LANGUAGES CXX)\n")
    build.HERE = copy
    with pytest.raises(build.BuildError, match=r"CMakeLists.txt says version 7\.8\.9, but"):
        build.addon_version()


@pytest.mark.long
def test_package_makes_both_zips():
    done = subprocess.run([ROOT / "scripts/package"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    made = [Path(line) for line in done.stdout.splitlines() if line.endswith(".zip")]
    assert [path.name for path in made] == [
        f"sardf_blender-{VERSION}.zip", f"sardf_blender-{VERSION}-legacy.zip",
    ]  # fmt: skip
    with zipfile.ZipFile(ROOT / made[0]) as archive:
        names = [name for name in archive.namelist() if name.endswith(".whl")]
    assert any("-cp311-" in name for name in names)
    assert all("manylinux_2_" in name for name in names)
    assert list((ROOT / "dist").glob("*.tmp")) == []
