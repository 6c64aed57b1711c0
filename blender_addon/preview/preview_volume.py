# SPDX-License-Identifier: GPL-3.0-or-later
"""What the preview shows of a scene, as arrays: samples, or a coarse mesh; no bpy here."""

import math
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

STAND_IN = 40  # cells of the mesh that stands in for textures
MARGIN = 2  # samples around the bounds, so that the surface lies between samples
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


def check(scene, wish):
    """Raises PreviewError where a wish cannot be shown."""
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
