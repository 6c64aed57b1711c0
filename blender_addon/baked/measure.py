# SPDX-License-Identifier: GPL-3.0-or-later
"""What there is to bake of a scene and what it will take, measured by a thread. No bpy here."""

import dataclasses
import threading
import traceback


@dataclasses.dataclass
class Info:
    """`channels`: {name: what it is}; `units`; `sample`: a sardf BakeSample; or only `error`."""

    channels: dict = dataclasses.field(default_factory=dict)
    units: str = ""
    sample: object = None
    error: str = ""


@dataclasses.dataclass(frozen=True)
class Wish:
    """`source`: a scene file's path, or a part's scene as text; `stamp`: of the file."""

    source: str
    is_file: bool
    stamp: int
    sections: bool
    channels: tuple


class Probe:
    """The measuring thread; `info` when it is done, None if it was stopped."""

    def __init__(self, sardf, wish):
        self.wish = wish
        self.info = None
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(sardf,), daemon=True)
        self._thread.start()

    @property
    def running(self):
        return self._thread.is_alive()

    def stop(self):
        self._stop.set()

    def _run(self, sardf):
        try:
            self.info = measure(sardf, self.wish, lambda share: not self._stop.is_set())
        except sardf.Cancelled:
            return
        except Exception as error:  # shown in the panel
            if not isinstance(error, (sardf.Error, OSError)):
                traceback.print_exception(error)  # ours to mend: show where
            self.info = Info(error=str(error))


def measure(sardf, wish, progress=None):
    """The Info of a Wish. Raises sardf.Error and sardf.Cancelled."""
    if wish.is_file:
        scene = sardf.load(wish.source, progress)
    else:
        scene = sardf.Scene.from_json(wish.source, {}, progress)
    channels = scene.channels()
    chosen = [name for name in wish.channels if name in channels]
    sample = sardf.measure_bake(scene, chosen, wish.sections, progress) if chosen else None
    return Info(channels, scene.units, sample)
