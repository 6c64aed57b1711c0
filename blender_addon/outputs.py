# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs that appear under their names only when all are complete, and clean interruption."""

import os
import shutil
import signal
import tempfile
from pathlib import Path

from .arguments import FAILED, Stop


def make_workplace(output):
    """A folder inside `output` where files are written before they get their names.

    Its name holds our process, so that a later run can tell what a killed one left behind. The path
    is whole, as Blender wants it for what it saves.
    """
    try:
        Path(output).mkdir(parents=True, exist_ok=True)
        for left in Path(output).glob(".sardf-*-*"):
            if not is_running(left.name.split("-")[1]):
                shutil.rmtree(left)
        return Path(tempfile.mkdtemp(prefix=f".sardf-{os.getpid()}-", dir=Path(output).resolve()))
    except OSError as error:
        raise Stop(FAILED, f"{output}: cannot be written: {error.strerror}") from error


def is_running(process):
    if not process.isdigit():
        return True  # not one of our names
    try:
        os.kill(int(process), 0)
    except (ProcessLookupError, OverflowError):
        return False
    except PermissionError:
        return True
    return True


class Signals:
    """Ctrl-C and a request to end, remembered until a place where stopping is clean.

    Such places are the core's progress reports and the ends of renders; an exception thrown
    wherever the signal comes in would be lost inside foreign modules.
    """

    def __init__(self):
        self.name = ""
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._remember)

    def _remember(self, number, _frame):
        self.name = signal.Signals(number).name

    def check(self):
        if self.name:
            raise Stop(FAILED, f"stopped by {self.name}")


def publish(workplace, output):
    """Move every file of the workplace to its place in `output`; return their paths."""
    files = sorted(file for file in workplace.rglob("*") if file.is_file())
    targets = [Path(output) / file.relative_to(workplace) for file in files]
    for file, target in zip(files, targets, strict=True):
        target.parent.mkdir(exist_ok=True)
        os.replace(file, target)
    return targets
