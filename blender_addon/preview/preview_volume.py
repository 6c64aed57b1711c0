# SPDX-License-Identifier: GPL-3.0-or-later
"""What the preview shows of a scene, as arrays: samples, or a coarse mesh; no bpy here."""

import math
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..baked import job

STAND_IN = 40  # cells of the mesh that stands in for textures
MARGIN = 2  # samples around the bounds, so that the surface lies between samples
COLOR = "colour"  # what can be shown: this, "fraction of" a material, or an attribute's name
FRACTION = "fraction of "
SOME = 20000  # points in a solid that tell whether sections leave any of it
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
    as sardf.Scene.sample_volume takes them. stand_in: in place of textures a mesh is wanted that
    these cuts (see is_left) cut open.
    """

    source: Any
    resolution: int = 128
    cut: bool = False
    channel: str = "base_color"
    material: str = ""
    stand_in: tuple | None = None
    stamp: int = 0  # of a file: when it was changed
    made: float = field(default_factory=time.monotonic, compare=False)


@dataclass
class Volume:
    """Samples of the drawn solid and its colours over the box from lo to hi (scene units).

    counts: samples along x, y and z. field: float32, x fastest, in multiples of `unit` scene units,
    no steeper than one unit for each sum of a cell's edges. color: float32, four for each sample,
    linear, times alpha. Both are None once they are textures. inside: some of the solid's points,
    (N, 3). range: of the number that is shown,
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
    inside: np.ndarray
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
        inside=_points_inside(values, lo, hi, counts),
        range=(0.0, 1.0) if wish.channel == "fractions" else samples["range"],
        seconds=now - begun,
        latency=now - wish.made,
    )


def _points_inside(values, lo, hi, counts):
    """Samples in the solid, SOME of them at most, evenly taken."""
    found = np.flatnonzero(values >= 0)
    found = found[:: max(1, len(found) // SOME)]
    place = np.stack(np.unravel_index(found, counts[::-1])[::-1], axis=-1)
    return lo + (place + 0.5) * ((hi - lo) / counts)


def removed(sardf, cut):
    """The field of what a cut takes away: where a x + b y + c z + d > 0 for all its planes."""
    fields = []
    for *normal, offset in cut:
        square = sum(n * n for n in normal)
        fields.append(sardf.half_space(point=[-offset * n / square for n in normal], normal=normal))
    return fields[0] if len(fields) == 1 else sardf.intersection(fields)


def is_left(sardf, points, cuts):
    """Whether any of the points (N, 3) is left by the cuts, each a tuple of planes."""
    gone = np.zeros(len(points), bool)
    for cut in cuts:
        gone |= removed(sardf, cut)(points) >= 0
    return not gone.all()


def cut_scene(sardf, scene, cuts):
    """The scene with the cuts as sections."""
    for cut in cuts:
        scene = scene.section(remove=removed(sardf, cut))
    return scene


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
    inside: np.ndarray  # points that are left by the cuts; none where they leave nothing


def _mesh(sardf, scene, progress):
    """(vertices, faces) of a scene; none where its sections leave nothing."""
    try:
        mesh = scene.mesh(resolution=STAND_IN, size=0, progress=progress)
    except sardf.Error:
        if not job.leaves_nothing(scene):
            raise
        return np.zeros((0, 3)), np.zeros((0, 4), int)
    return mesh.vertices, mesh.faces


def make_stand_in(sardf, scene, wish, progress=None):
    """The StandIn of a scene that was read from the wish's source."""
    vertices, faces = _mesh(sardf, cut_scene(sardf, scene, wish.stand_in), progress)
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
    finite = [] if values is None else values[np.isfinite(values)]
    span = (float(finite.min()), float(finite.max())) if len(finite) else None
    span = (0.0, 1.0) if wish.channel == "fractions" else span
    latency = time.monotonic() - wish.made
    return StandIn(scene, wish, vertices, faces, colors, values, span, latency, vertices)
