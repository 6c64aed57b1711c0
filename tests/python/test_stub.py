"""The typed stub describes the compiled module as it is now."""

import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def test_stub_is_current(tmp_path):
    made = tmp_path / "_core.pyi"
    subprocess.run([sys.executable, ROOT / "scripts/make_stub", made], check=True)
    assert made.read_text() == (ROOT / "core/python/sardf/_core.pyi").read_text()


def test_stub_is_python():
    text = (ROOT / "core/python/sardf/_core.pyi").read_text()
    names = {line.split("(")[0][4:] for line in text.splitlines() if line.startswith("def ")}
    compile(text, "_core.pyi", "exec")
    assert {"box", "union", "Sardf", "formula", "load"} <= names
