"""The scripts that users and CI call: setup's promises and the closing line's arithmetic."""

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
from repository import ROOT


def setup(**environment: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [ROOT / "scripts/setup"], env=os.environ | environment, capture_output=True, text=True,
        stdin=subprocess.DEVNULL,
    )  # fmt: skip


@pytest.mark.timed
def test_second_setup_is_quick_and_does_nothing():
    begun = time.monotonic()
    done = setup()
    assert done.returncode == 0, done.stdout + done.stderr
    assert time.monotonic() - begun < 10
    assert len(done.stdout.splitlines()) == 1


@pytest.mark.parametrize("system", ["ID=debian\nVERSION_ID=13\n", "ID=ubuntu\n", ""])
def test_setup_stops_on_another_system(system, tmp_path):
    release = tmp_path / "os-release"
    release.write_text(system)
    done = setup(SARDF_OS_RELEASE=str(release))
    assert done.returncode == 1
    assert done.stdout == ""
    assert "prepares only Debian 12. Nothing was changed." in done.stderr
    assert "\n  nothing\n" in done.stderr  # setup has run here, so no package may be missed


def test_setup_names_what_another_system_lacks(tmp_path):
    """The same script beside a list with a program and a file that no system has."""
    copy = tmp_path / "scripts"
    copy.mkdir()
    for name in ("setup", "common.sh"):
        shutil.copy(ROOT / "scripts" / name, copy)
    packages = "# comment\n\nbash  bash\nfancy  no-such-program\nlibfancy-dev  fancy/no_such.hpp\n"
    (copy / "packages.txt").write_text(packages)
    done = subprocess.run(
        [copy / "setup"], env=os.environ | {"SARDF_OS_RELEASE": "absent"}, capture_output=True,
        text=True, stdin=subprocess.DEVNULL,
    )  # fmt: skip
    assert done.returncode == 1
    lacking = [line.strip() for line in done.stderr.splitlines() if line.startswith("  ")]
    assert lacking == ["fancy (no-such-program)", "libfancy-dev (fancy/no_such.hpp)"]


GOOGLETEST = """<testsuites><testsuite name="Box">
  <testcase name="Inside" classname="Box" status="run" result="completed"/>
  <testcase name="Gpu" classname="Box" status="run" result="skipped">
    <skipped message="no device"/></testcase>
  <testcase name="DISABLED_Old" classname="Box" status="notrun" result="suppressed"/>
</testsuite></testsuites>"""
PYTEST = """<testsuites><testsuite name="pytest">
  <testcase classname="test_a" name="test_one"/>
  <testcase classname="test_a" name="test_two">
    <failure message="assert 1 == 2">x</failure></testcase>
  <testcase classname="test_a" name="test_three"><error message="no fixture">x</error></testcase>
</testsuite></testsuites>"""


def count(folder: Path, checks: str, googletest: str, pytest_: str) -> tuple[int, list[str]]:
    for name, text in (
        ("checks.tsv", checks),
        ("googletest.xml", googletest),
        ("pytest.xml", pytest_),
    ):
        if text:
            (folder / name).write_text(text)
    names = [folder / name for name in ("checks.tsv", "googletest.xml", "pytest.xml")]
    done = subprocess.run(
        [sys.executable, ROOT / "scripts/count_tests.py", *names], capture_output=True, text=True
    )
    return done.returncode, done.stdout.splitlines()


def test_closing_line_adds_up(tmp_path):
    checks = "passed\truff\nfailed\tclang-format\nended badly\tpytest\n"
    status, lines = count(tmp_path, checks, GOOGLETEST, PYTEST)
    assert status == 1
    assert lines[-1] == "3 passed, 3 failed, 2 skipped"
    assert "skipped: Box.Gpu: no device" in lines
    assert "skipped: Box.DISABLED_Old: disabled" in lines
    assert "failed: test_a.test_two: assert 1 == 2" in lines


def test_a_suite_that_died_is_a_failure(tmp_path):
    good = PYTEST.replace("failure", "system-out").replace("error", "system-out")
    assert count(tmp_path, "passed\truff\n", GOOGLETEST, good)[0] == 0
    status, lines = count(tmp_path, "ended badly\tpytest\n", GOOGLETEST, good)
    assert (status, lines[-1]) == (1, "4 passed, 1 failed, 2 skipped")
    (tmp_path / "googletest.xml").unlink()
    status, lines = count(tmp_path, "ended badly\tgoogletest\n", "", good)
    assert (status, lines[-1]) == (1, "3 passed, 1 failed, 0 skipped")


def test_a_suite_in_two_halves_is_counted_once(tmp_path):
    names = [tmp_path / name for name in ("checks.tsv", "googletest_0.xml", "googletest_1.xml")]
    names[0].write_text("ended badly\tgoogletest\n")
    names[1].write_text(GOOGLETEST)
    names[2].write_text(GOOGLETEST)
    command = [sys.executable, ROOT / "scripts/count_tests.py", *names]
    lines = subprocess.run(command, capture_output=True, text=True).stdout.splitlines()
    assert "failed: googletest: it ended badly although no test failed" in lines
    assert lines[-1] == "2 passed, 1 failed, 4 skipped"
    names[2].unlink()
    lines = subprocess.run(command, capture_output=True, text=True).stdout.splitlines()
    assert "failed: googletest_1: no test ran" in lines
    assert lines[-1] == "1 passed, 1 failed, 2 skipped"
