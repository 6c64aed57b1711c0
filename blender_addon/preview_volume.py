# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene's samples for the preview, made in a worker thread; no bpy here.

`Sampler` takes wishes, makes a coarse volume of each at once and the fine one when no newer wish
has come for a while; whoever shows them polls `take`.
"""

import math
import threading
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

STAND_IN = 40  # cells of the mesh that stands in for textures
COARSE = 32  # samples along the longest side of the first picture
MARGIN = 2  # samples around the bounds, so that the surface lies between samples
QUIET = 0.15  # seconds without a wish before the fine picture is made
COLOR = "colour"  # what can be shown: this, "fraction of" a material, or an attribute's name
FRACTION = "fraction of "
LARGEST = 1000.0  # of the field in its own unit: half floats hold more, and it is far outside


def channel_of(show):
    """(channel, material) as sardf.Scene.sample_volume takes them, of what is to be shown."""
    if show in ("", COLOR):
        return "base_color", ""
    if show.startswith(FRACTION):
        return "fractions", show[len(FRACTION) :]
    return show, ""


class PreviewError(Exception):
    """What is wished for cannot be shown, in one sentence."""


def numbers_of(scene):
    """The names of the scene's attributes that are one number at each point."""
    lo, hi = scene.bounds
    point = [[(a + b) / 2 for a, b in zip(lo, hi, strict=True)]]
    values = {name: evaluate(point) for name, evaluate in scene.attributes.items()}
    return [name for name, of in values.items() if not isinstance(of, dict) and of.ndim == 1]


def _check(scene, wish):
    if wish.channel in scene.attributes and wish.channel not in numbers_of(scene):
        raise PreviewError(
            f"'{wish.channel}' has several components; attributes that are one number can be shown"
        )


@dataclass(frozen=True)
class Wish:
    """What to sample of a scene.

    source: a scene file's text, the pathlib.Path of one, or a sardf.Scene. resolution: samples
    along the longest side. cut: colours inside, too, for a section that moves. channel, material:
    as sardf.Scene.sample_volume takes them. plane: (a, b, c, d) in place of textures a mesh is
    wanted that is cut open there, by (0, 0, 0, 0) nowhere.
    """

    source: Any
    resolution: int = 128
    cut: bool = False
    channel: str = "base_color"
    material: str = ""
    plane: tuple | None = None
    stamp: int = 0  # of a file: when it was changed
    made: float = field(default_factory=time.monotonic, compare=False)


@dataclass
class Volume:
    """Samples of the drawn solid and its colours over the box from lo to hi (scene units).

    counts: samples along x, y and z. field: float32, x fastest, in multiples of `unit` scene units,
    no steeper than one unit for each sum of a cell's edges. color: float32, four for each sample,
    linear, times alpha. Both are None once they are textures. range: of the number that is shown,
    or of the first component, or None. latency: seconds since the wish.
    """

    scene: Any
    wish: Wish
    lo: np.ndarray
    hi: np.ndarray
    counts: tuple
    field: np.ndarray | None
    unit: float
    color: np.ndarray | None
    range: tuple | None
    seconds: float
    latency: float

    @property
    def cell(self):
        """Edges of a cell, (3,) scene units."""
        return (self.hi - self.lo) / self.counts


def grid(lo, hi, resolution):
    """(lo, hi, counts) of cubic cells around the bounds, `resolution` along the longest side."""
    lo, hi = np.asarray(lo), np.asarray(hi)
    cell = (hi - lo).max() / (resolution - 2 * MARGIN)
    counts = np.ceil((hi - lo) / cell - 1e-9).astype(int) + 2 * MARGIN
    half = 0.5 * cell * counts
    return (lo + hi) / 2 - half, (lo + hi) / 2 + half, tuple(int(n) for n in counts)


def read(sardf, source, progress=None):
    """The sardf.Scene of a Wish's source. Raises sardf.Error and sardf.Cancelled."""
    if isinstance(source, Path):
        return sardf.load(str(source), progress=progress)
    if isinstance(source, str):
        return sardf.Scene.from_json(source, progress=progress)
    return source


def make_volume(scene, wish, resolution, progress=None):
    """The Volume of a scene that was read from the wish's source."""
    begun = time.monotonic()
    lo, hi, counts = grid(*scene.bounds, resolution)
    samples = scene.sample_volume(
        lo,
        hi,
        counts,
        colors="inside" if wish.cut else "surface",
        channel=wish.channel,
        material=wish.material,
        progress=progress,
    )
    unit = samples["steepness"] * float(((hi - lo) / counts).sum())
    if not 0 < unit < math.inf:
        unit = 1.0
    values = samples["field"].reshape(-1)
    values *= np.float32(1 / unit)
    np.clip(values, -LARGEST, LARGEST, out=values)
    now = time.monotonic()
    return Volume(
        scene=scene,
        wish=wish,
        lo=lo,
        hi=hi,
        counts=counts,
        field=values,
        unit=unit,
        color=samples["color"].reshape(-1),
        range=(0.0, 1.0) if wish.channel == "fractions" else samples["range"],
        seconds=now - begun,
        latency=now - wish.made,
    )


@dataclass
class StandIn:
    """A coarse mesh with a linear colour (V, 4) at each vertex, or None where a number is shown
    whose `values` (V,) lie in `range`."""

    scene: Any
    wish: Wish
    vertices: np.ndarray
    faces: np.ndarray
    colors: np.ndarray | None
    values: np.ndarray | None
    range: tuple | None
    latency: float


def make_stand_in(sardf, scene, wish, progress=None):
    """The StandIn of a scene that was read from the wish's source."""
    shown = scene
    *normal, offset = wish.plane
    square = sum(n * n for n in normal)
    if square > 0:
        point = [-offset * n / square for n in normal]
        shown = scene.section(remove=sardf.half_space(point=point, normal=normal))
    mesh = shown.mesh(resolution=STAND_IN, size=0, progress=progress)
    vertices, faces = mesh.vertices, mesh.faces
    colors = values = None
    if wish.channel == "base_color":
        colors = np.ones((len(vertices), 4))
        colors[:, :3] = scene.fractions(vertices) @ np.array(list(scene.material_colors.values()))
    elif wish.channel == "fractions":
        if wish.material not in scene.materials:
            raise PreviewError(f"the part has no material '{wish.material}'")
        values = scene.fractions(vertices)[:, scene.materials.index(wish.material)]
    elif wish.channel in scene.attributes:
        values = scene.attributes[wish.channel](vertices)
    else:
        raise PreviewError(f"the part has no attribute '{wish.channel}'")
    span = None if values is None else (float(np.nanmin(values)), float(np.nanmax(values)))
    span = (0.0, 1.0) if wish.channel == "fractions" else span
    latency = time.monotonic() - wish.made
    return StandIn(scene, wish, vertices, faces, colors, values, span, latency)


class _Task:
    """What is still to be made for one key."""

    def __init__(self, wish):
        self.wish = wish
        self.scene = None
        self.is_fine = False  # the coarse volume was made
        self.dropped = False  # nobody waits for it any more

    @property
    def resolution(self):
        return self.wish.resolution if self.is_fine else min(COARSE, self.wish.resolution)


class Sampler:
    """Makes the volumes of some parts, each named by a key, in one worker thread."""

    def __init__(self, sardf):
        self._sardf = sardf
        self._changed = threading.Condition()
        self._open = {}  # key -> _Task; guarded, as all below
        self._scenes = {}  # key -> ((source, stamp), scene) that was read last
        self._results = []
        self._running = None
        self._last_wish = 0.0
        self._stopped = False
        self._thread = threading.Thread(target=self._run, name="sardf preview", daemon=True)
        self._thread.start()

    @property
    def busy(self):
        """Whether anything is still to be made or taken."""
        with self._changed:
            return bool(self._open or self._results)

    @property
    def running(self):
        """Whether the thread lives."""
        return self._thread.is_alive()

    def request(self, key, wish):
        """Replace what was wished for a key. A coarse volume at work is finished first, so that
        something is seen however fast wishes follow one another."""
        with self._changed:
            self._last_wish = time.monotonic()
            self._open[key] = _Task(wish)
            if self._running is not None and self._running.is_fine:
                self._running.dropped = True
            self._changed.notify_all()

    def forget(self, key):
        """Make nothing more for a key."""
        with self._changed:
            task = self._open.pop(key, None)
            self._scenes.pop(key, None)
            if task is not None:
                task.dropped = True
            self._results = [result for result in self._results if result[0] != key]

    def wait(self, limit=0.1):
        """Until there is something to take, or for `limit` seconds."""
        with self._changed:
            self._changed.wait_for(lambda: self._results, limit)

    def take(self):
        """[(key, Volume or Exception), ...] made since the last call, oldest first."""
        with self._changed:
            results, self._results = self._results, []
        return results

    def stop(self, limit=1.0):
        """End the thread; waits for it, `limit` seconds at most."""
        with self._changed:
            self._stopped = True
            self._open.clear()
            self._results.clear()
            if self._running is not None:
                self._running.dropped = True
            self._changed.notify_all()
        self._thread.join(limit)

    def _run(self):
        while True:
            found = self._next()
            if found is None:
                return
            key, task = found
            try:
                result = self._make(key, task)
            except self._sardf.Cancelled:
                with self._changed:
                    self._running = None
                continue
            except Exception as error:  # handed to whoever polls: nothing is swallowed
                result = error
            self._finish(key, task, result)

    def _next(self):
        """(key, task) to work on, coarse ones first; None: the end."""
        with self._changed:
            while not self._stopped:
                coarse = [item for item in self._open.items() if not item[1].is_fine]
                quiet = self._last_wish + QUIET - time.monotonic()
                if coarse or (self._open and quiet <= 0):
                    key, task = coarse[0] if coarse else next(iter(self._open.items()))
                    task.dropped = False
                    self._running = task
                    return key, task
                self._changed.wait(quiet if self._open else None)
            return None

    def _make(self, key, task):
        def go_on(_share):
            return not task.dropped

        with self._changed:
            known = self._scenes.get(key)
        origin = (task.wish.source, task.wish.stamp)
        if known is not None and known[0] == origin:
            task.scene = known[1]
        if task.scene is None:
            task.scene = read(self._sardf, task.wish.source, go_on)
            with self._changed:
                if key in self._open:  # not forgotten meanwhile
                    self._scenes[key] = (origin, task.scene)
        _check(task.scene, task.wish)
        if task.wish.plane is not None:
            task.is_fine = True
            return make_stand_in(self._sardf, task.scene, task.wish, go_on)
        return make_volume(task.scene, task.wish, task.resolution, go_on)

    def _finish(self, key, task, result):
        with self._changed:
            self._running = None
            if self._stopped or task.dropped:
                return
            self._results = [old for old in self._results if old[0] != key] + [(key, result)]
            self._changed.notify_all()
            if self._open.get(key) is not task:  # a newer wish came
                return
            failed = isinstance(result, Exception)
            if failed or task.resolution >= task.wish.resolution:
                del self._open[key]
            else:
                task.is_fine = True
