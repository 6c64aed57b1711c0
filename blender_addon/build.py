# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the installable add-on: an extension for Blender 4.2 and later, an add-on for older ones.

    python blender_addon/build.py --wheel dist/sardf-0.1.0-cp311-cp311-*.whl -o dist

sardf_blender-VERSION.zip holds our modules, the manifest and the wheels, of which Blender installs
the one for its Python; sardf_blender-VERSION-legacy.zip holds our modules and, in vendor/, what the
wheel for Python 3.11 holds: the last Blender that has no extensions, 4.1, runs that. Several
wheels, one for each Python, may be given; they must be self-contained (scripts/self_contained.py).
The version is that of CMakeLists.txt. Prints the paths of the zips.
"""

import argparse
import os
import re
import sys
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
FOLDER = "sardf_blender"  # not "sardf": add-on folders are modules, and that name is the core's
LEFT_OUT = {"build.py"}
LEGACY_PYTHON = "cp311"
# sardf._image links OpenImageIO; Blender brings its own and must not load a second one.
IMAGE_MODULE = re.compile(r"^sardf/_image\.")
WHEEL_NAME = re.compile(
    r"^sardf-(?P<version>[0-9.]+)-(?P<python>cp3[0-9]+)-cp3[0-9]+-(?P<platform>[a-z0-9_.]+)\.whl$"
)
PLATFORMS = (  # part of a wheel's platform tag -> Blender's name
    (re.compile(r"linux.*x86_64"), "linux-x64"),
    (re.compile(r"win_amd64"), "windows-x64"),
    (re.compile(r"win_arm64"), "windows-arm64"),
    (re.compile(r"macosx.*x86_64"), "macos-x64"),
    (re.compile(r"macosx.*arm64"), "macos-arm64"),
)


class BuildError(Exception):
    """The zip cannot be made, in one sentence."""


def addon_version():
    """The version that CMakeLists.txt, blender_manifest.toml and bl_info all state."""
    project = _match(HERE.parent / "CMakeLists.txt", r"^project\(sardf VERSION ([0-9.]+)")
    manifest = _match(HERE / "blender_manifest.toml", r'^version = "([0-9.]+)"$')
    numbers = _match(HERE / "__init__.py", r'^    "version": \(([0-9, ]+)\),$')
    if not project == manifest == numbers.replace(", ", "."):
        raise BuildError(
            f"CMakeLists.txt says version {project}, but blender_manifest.toml {manifest} and "
            f"bl_info in __init__.py ({numbers})"
        )
    return project


def check_wheel(wheel, version):
    """The wheel's Python, such as cp311, and Blender's name of its platform."""
    found = WHEEL_NAME.match(wheel.name)
    if not wheel.is_file() or not found:
        raise BuildError(
            f"{wheel}: expected an existing file sardf-VERSION-cp3XX-cp3XX-PLATFORM.whl"
        )
    if found["version"] != version:
        raise BuildError(f"{wheel.name}: the add-on is version {version}")
    for pattern, name in PLATFORMS:
        if pattern.search(found["platform"]):
            with zipfile.ZipFile(wheel) as archive:
                if any(IMAGE_MODULE.match(file) for file in archive.namelist()):
                    raise BuildError(
                        f"{wheel.name} needs OpenImageIO; scripts/self_contained.py makes one that "
                        "does not"
                    )
            return found["python"], name
    raise BuildError(f"{wheel.name}: Blender has no platform '{found['platform']}'")


def manifest_with(wheels, platforms):
    """The manifest's text with the lines that depend on the wheels, ahead of its first table."""
    text = (HERE / "blender_manifest.toml").read_text()
    names = ", ".join(f'"./wheels/{wheel.name}"' for wheel in wheels)
    known = ", ".join(f'"{platform}"' for platform in sorted(platforms))
    lines = f"platforms = [{known}]\nwheels = [{names}]\n\n"
    head, table, rest = text.partition("[permissions]")
    return head.rstrip() + "\n" + lines + table + rest


def vendored(wheel):
    """The wheel's package as {name below vendor/: bytes}."""
    with zipfile.ZipFile(wheel) as archive:
        names = [n for n in archive.namelist() if n.startswith("sardf/") or "/licenses/" in n]
        content = {name: archive.read(name) for name in names}
    if "sardf/__init__.py" not in content:
        raise BuildError(f"{wheel.name} holds no package 'sardf'")
    return content


def build(wheels, output):
    """Write the zips into the folder `output` and return their paths. Raises BuildError."""
    version = addon_version()
    found = {wheel: check_wheel(wheel, version) for wheel in wheels}
    platforms = {platform for _, platform in found.values()}
    own = {
        file.relative_to(HERE).as_posix(): file.read_bytes()
        for file in sorted([*HERE.rglob("*.py"), HERE / "LICENSE"])
        if file.name not in LEFT_OUT
    }
    extension = own | {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}
    extension["blender_manifest.toml"] = manifest_with(wheels, platforms).encode()
    legacy = [wheel for wheel, (python, _) in found.items() if python == LEGACY_PYTHON]
    output.mkdir(parents=True, exist_ok=True)
    paths = [write(output / f"{FOLDER}-{version}.zip", extension)]
    if legacy:
        addon = own | {f"vendor/{name}": data for name, data in vendored(legacy[0]).items()}
        paths.append(write(output / f"{FOLDER}-{version}-legacy.zip", addon))
    return paths


def write(path, content):
    """Write {name: bytes} as a zip of one folder; it gets its name when it is complete."""
    unfinished = path.with_suffix(f".{os.getpid()}.tmp")
    try:
        with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as archive:
            for name in sorted(content):  # fixed order and time: equal input, equal zip
                archive.writestr(_entry(f"{FOLDER}/{name}"), content[name])
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)
    return path


def _entry(name):
    entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
    entry.compress_type = zipfile.ZIP_DEFLATED
    entry.external_attr = 0o644 << 16
    return entry


def _match(path, pattern):
    found = re.search(pattern, path.read_text(), re.MULTILINE)
    if not found:
        raise BuildError(f"{path.name} states no version")
    return found[1]


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--wheel", type=Path, action="append", required=True, help="repeatable")
    parser.add_argument("-o", "--output", type=Path, default=Path("dist"), help="folder (dist)")
    options = parser.parse_args(arguments)
    try:
        print(*build(options.wheel, options.output), sep="\n")
    except (BuildError, OSError, zipfile.BadZipFile) as error:
        print(f"build.py: {error}", file=sys.stderr)
        return 2 if isinstance(error, BuildError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
