# SPDX-License-Identifier: GPL-3.0-or-later
"""Make the installable add-on: one zip for Blender 3.4 and later.

    python blender_addon/build.py --wheel dist/sardf-0.1.0-cp311-*.whl -o dist

The zip holds the folder sardf_blender with our modules, the wheels as an extension of Blender 4.2
and later wants them, and the wheels' content unpacked in vendor/ for older versions. Several
wheels, one for each Python, may be given. Prints the path of the zip.
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
# sardf._image links OpenImageIO; Blender brings its own and must not load a second one.
IMAGE_MODULE = re.compile(r"^sardf/_image\.")
WHEEL_NAME = re.compile(
    r"^sardf-(?P<version>[0-9.]+)-cp3[0-9]+-cp3[0-9]+-(?P<platform>[a-z0-9_.]+)\.whl$"
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
    """The version that blender_manifest.toml and bl_info both state."""
    manifest = _match(HERE / "blender_manifest.toml", r'^version = "([0-9.]+)"$')
    numbers = _match(HERE / "__init__.py", r'^    "version": \(([0-9, ]+)\),$')
    if manifest != numbers.replace(", ", "."):
        raise BuildError(f"blender_manifest.toml says {manifest} but bl_info says ({numbers})")
    return manifest


def check_wheel(wheel, version):
    """Blender's name of the platform that the wheel is for."""
    found = WHEEL_NAME.match(wheel.name)
    if not wheel.is_file() or not found:
        raise BuildError(
            f"{wheel}: expected an existing file sardf-VERSION-cp3XX-cp3XX-PLATFORM.whl"
        )
    if found["version"] != version:
        raise BuildError(f"{wheel.name}: the add-on is version {version}")
    for pattern, name in PLATFORMS:
        if pattern.search(found["platform"]):
            return name
    raise BuildError(f"{wheel.name}: Blender has no platform '{found['platform']}'")


def manifest_with(wheels, platforms):
    """The manifest's text with the lines that depend on the wheels, ahead of its first table."""
    text = (HERE / "blender_manifest.toml").read_text()
    names = ", ".join(f'"./wheels/{wheel.name}"' for wheel in wheels)
    known = ", ".join(f'"{platform}"' for platform in sorted(platforms))
    lines = f"platforms = [{known}]\nwheels = [{names}]\n\n"
    head, table, rest = text.partition("[permissions]")
    return head.rstrip() + "\n" + lines + table + rest


def vendored(wheels):
    """Unpacked content of all wheels as {name: bytes}, without the image module."""
    content = {}
    for wheel in wheels:
        with zipfile.ZipFile(wheel) as archive:
            for name in archive.namelist():
                if name.startswith("sardf/") and not IMAGE_MODULE.match(name):
                    content[name] = archive.read(name)
    if "sardf/__init__.py" not in content:
        raise BuildError("the wheels hold no package 'sardf'")
    return content


def build(wheels, output):
    """Write OUTPUT/sardf_blender-VERSION.zip and return its path. Raises BuildError."""
    version = addon_version()
    platforms = {check_wheel(wheel, version) for wheel in wheels}
    content = {"blender_manifest.toml": manifest_with(wheels, platforms).encode()}
    for file in sorted([*HERE.glob("*.py"), HERE / "LICENSE"]):
        if file.name not in LEFT_OUT:
            content[file.name] = file.read_bytes()
    content |= {f"wheels/{wheel.name}": wheel.read_bytes() for wheel in wheels}
    content |= {f"vendor/{name}": data for name, data in vendored(wheels).items()}
    output.mkdir(parents=True, exist_ok=True)
    path = output / f"{FOLDER}-{version}.zip"
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
        print(build(options.wheel, options.output))
    except (BuildError, OSError, zipfile.BadZipFile) as error:
        print(f"build.py: {error}", file=sys.stderr)
        return 2 if isinstance(error, BuildError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
