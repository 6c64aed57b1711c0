# SPDX-License-Identifier: GPL-3.0-or-later
"""What takes long and needs no bpy: baking what is not baked, and POV-Ray."""

import os
import shutil
import tempfile
import threading
from dataclasses import dataclass, field
from pathlib import Path

from ..baked import job
from ..progress import between

LOOKS = {"flat": "flat", "shaded": "lit"}  # ours -> the core's
BAKE_SHARE = 0.5  # of the progress, where something must be baked


@dataclass
class Order:
    """`program`: the path of POV-Ray, or "" to look for it; `bake`: whether missing bakes are
    made."""

    stage: object
    looks: tuple = ("flat",)
    bake: bool = True
    samples: int = 256
    light_samples: int = 4
    program: str = ""


@dataclass
class Made:
    """`pictures`: {look: bytes of POV-Ray's EXR}; `baked`: {index of a part: job.Part}."""

    pictures: dict = field(default_factory=dict)
    baked: dict = field(default_factory=dict)
    sentences: list = field(default_factory=list)


def make(sardf, order, progress=None):
    """The Made of an Order. POV-Ray's files lie in a temporary folder, which goes.

    `progress(share)` returns False to cancel: POV-Ray is then stopped, and sardf.Cancelled raised.
    Raises sardf.Error, also where POV-Ray is missing.
    """
    made = Made()
    missing = [(i, p) for i, p in enumerate(order.stage.parts) if order.bake and p.request]
    start = BAKE_SHARE if missing else 0.0
    folder = Path(tempfile.mkdtemp(prefix=f"sardf-{os.getpid()}-"))
    try:
        _draw(sardf, order, folder, made, between(progress, 0.0, 1.0 - start))
        for place, (index, part) in enumerate(missing):
            share = start / len(missing)
            begin = 1.0 - start + place * share
            told = between(progress, begin, begin + share)
            made.baked[index] = job.make_part(sardf, part.request, told)
    except BaseException:
        for part in made.baked.values():
            part.store.discard()
        raise
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return made


def _draw(sardf, order, folder, made, progress):
    count = len(order.looks)
    for place, look in enumerate(order.looks):
        picture = folder / f"{look}.exr"
        said = sardf.povray_stage(
            order.stage.text,
            str(folder / f"{look}.pov"),
            render=str(picture),
            look=LOOKS[look],
            width=order.stage.width,
            height=order.stage.height,
            samples=order.samples,
            light_samples=order.light_samples,
            program=order.program,
            progress=between(progress, place / count, (place + 1) / count),
        )
        made.sentences += [sentence for sentence in said if sentence not in made.sentences]
        made.pictures[look] = picture.read_bytes()


class Work:
    """make() in a worker thread that the user interface polls.

    `share` is the progress, `running` tells whether the thread is at work; afterwards exactly one
    of `made`, `error` and `cancelled` is set.
    """

    def __init__(self, sardf, order):
        self.share = 0.0
        self.made = None
        self.error = None
        self.cancelled = False
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(sardf, order), daemon=True)
        self._thread.start()

    @property
    def running(self):
        return self._thread.is_alive()

    def cancel(self):
        """Ask the thread to stop; POV-Ray ends within 0.1 s."""
        self._stop.set()

    def _run(self, sardf, order):
        try:
            made = make(sardf, order, self._progress)
        except sardf.Cancelled:
            self.cancelled = True
        except Exception as error:  # shown by the operator, which polls: nothing is swallowed
            self.error = error
        else:
            self.made = made

    def _progress(self, share):
        self.share = share
        return not self._stop.is_set()
