"""scripts/setup on a Debian 12 that has nothing of ours, in a folder made by debootstrap."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from repository import ROOT, files

# What makes the network of this machine work is needed inside as well.
BORROWED = ("etc/resolv.conf", "etc/hosts", "etc/ssl/certs/ca-certificates.crt")
ENTER = """
mount -t proc proc "$1/proc"; mount --rbind /dev "$1/dev"; mount --rbind /sys "$1/sys"
exec env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
  PIP_CERT=/etc/ssl/certs/ca-certificates.crt chroot "$1" bash -euc "$2"
"""


@pytest.fixture
def debian(tmp_path: Path) -> Path:
    if os.geteuid() != 0:
        pytest.skip("a chroot needs root")
    if not shutil.which("debootstrap"):
        pytest.skip("debootstrap is not installed")
    system = tmp_path / "debian"
    subprocess.run(
        ["debootstrap", "--variant=minbase", "--include=ca-certificates", "bookworm", system],
        check=True,
    )
    security = "deb http://deb.debian.org/debian-security bookworm-security main\n"
    (system / "etc/apt/sources.list.d/security.list").write_text(security)
    for name in BORROWED:
        shutil.copy(f"/{name}", system / name)
    for path in files():
        copy = system / "opt/sardf" / path.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, copy)
    return system


def inside(system: Path, command: str) -> str:
    """The output of a command in the system, with mounts that end with the command."""
    enter = ["unshare", "--mount", "--propagation", "private", "bash", "-euc", ENTER, "enter"]
    done = subprocess.run(
        [*enter, system, f"cd /opt/sardf; {command}"],
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout
    return done.stdout


@pytest.mark.long
def test_setup_prepares_a_bare_debian_12(debian):
    first = inside(debian, "scripts/setup")
    assert "apt packages" in first
    assert inside(debian, "scripts/setup").count("\n") == 1
    assert inside(debian, ".venv/bin/python -c 'import sardf'") == ""
    assert "sardf" in inside(debian, ".venv/bin/sardf --version")
    assert "5.0.1" in inside(debian, ".venv-bpy/bin/python -c 'import bpy, sardf; print(bpy.app)'")
    assert "Blender 3.4.1" in inside(debian, "blender --version")
    assert "POV-Ray" in inside(debian, "povray --version")
