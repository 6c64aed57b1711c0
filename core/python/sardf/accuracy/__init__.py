"""How far a field is from the true distance to its surface, measured with a fine mesh.

    import sardf.accuracy
    measured = sardf.accuracy.measure(part, samples=32)
    print(measured.text())
    measured.inside.max, measured.inside.where

`Field.error_bound()` is proven, but tells only how far blends move a field from minima and maxima.
Those are themselves no distances: x >= 0 and y >= 0 gives -4 at (-3, -4), which is 5 away. Here the
field is compared with closest points, found by libigl, on a mesh of its zero set. That is measured
at points, not proven; `reference.error` says how well the mesh is known.
"""

from dataclasses import dataclass

import numpy as np

from sardf._command import located_error
from sardf._core import Field, Scene
from sardf.accuracy._reference import Reference, reference
from sardf.accuracy._table import Side, csv_of, side_of, summary_of, text_of

__all__ = ["Accuracy", "Reference", "Section", "Side", "measure", "measure_section", "reference"]


@dataclass
class Accuracy:
    """A field beside the true distance. Arrays have one entry for each point.

    error = |field| - |true|: negative where the field is the smaller one. The sign of `true` is the
    field's, because the solid is where the field is at least 0.
    """

    points: np.ndarray
    field: np.ndarray
    true: np.ndarray
    error: np.ndarray
    reference: Reference
    error_bound: float  # proven: how far the blends move the field from minima and maxima
    exactness: tuple  # the labels inside and outside, by construction
    units: str
    name: str

    @property
    def inside(self):
        return side_of(self, self.field >= 0)

    @property
    def outside(self):
        return side_of(self, self.field < 0)

    def summary(self):
        """Everything but the arrays, as JSON data."""
        return summary_of(self)

    def text(self):
        """The table, with units and with what of it is proven."""
        return text_of(self)

    def csv(self):
        """One line for each point: x,y,z,field,true,error."""
        return csv_of(self)


@dataclass
class Section(Accuracy):
    """On a plane; `grid(error)` is (rows, columns), to be drawn over `across` and `up`."""

    axes: tuple  # what runs along columns and rows, such as ("x", "z")
    across: np.ndarray
    up: np.ndarray

    def grid(self, values):
        return values.reshape(len(self.up), len(self.across))


def measure(what, bounds=None, resolution=128, samples=40, points=None, reference=None):
    """A field's error against the true distance.

    what: a scene, of which the solid is taken, or a solid's field.
    bounds: (lowest corner, highest corner) of the points; by default the solid's, grown by a
        quarter of the longest side.
    resolution: cells of the reference mesh along its longest side.
    samples: points along the longest side of the bounds.
    points: (N, 3) to measure at instead of a grid.
    reference: what `sardf.accuracy.reference` gave, to use it again.

    Needs libigl: pip install 'sardf[accuracy]'.
    """
    scene, field, surface = prepared(what, resolution, reference)
    if points is None:
        points = grid_points(*axes_of(bounds, surface, samples))
    return Accuracy(**compared(scene, field, surface, np.array(points, dtype=float)))


def measure_section(what, axis="y", at=0.0, bounds=None, resolution=128, samples=200, **options):
    """The same on the plane `axis` = `at`: a Section, whose arrays are grids."""
    if axis not in ("x", "y", "z"):
        raise located_error(f"a section across '{axis}'; accepted are x, y and z")
    scene, field, surface = prepared(what, resolution, options.pop("reference", None))
    if options:
        raise TypeError(f"measure_section() takes no '{next(iter(options))}'")
    every = axes_of(bounds, surface, samples)
    fixed = "xyz".index(axis)
    a, b = (i for i in range(3) if i != fixed)
    points = np.empty((len(every[b]), len(every[a]), 3))
    points[..., fixed] = at
    points[..., a], points[..., b] = np.meshgrid(every[a], every[b])
    found = compared(scene, field, surface, points.reshape(-1, 3))
    return Section(**found, axes=("xyz"[a], "xyz"[b]), across=every[a], up=every[b])


def prepared(what, resolution, surface):
    """The scene, its solid's field, and the reference surface."""
    if not isinstance(what, (Scene, Field)):
        raise located_error(f"a {type(what).__name__} was given; a Scene or a Field is accepted")
    field = what.solid if isinstance(what, Scene) else what
    return what, field, surface or reference(what, resolution)


def compared(scene, field, surface, points):
    if points.ndim != 2 or points.shape[1] != 3 or not len(points):
        raise located_error(f"points have the shape {points.shape}; (N, 3) is accepted")
    values = field(points)
    distances = surface.distances(points)
    return {
        "points": points,
        "field": values,
        "true": np.where(values >= 0, distances, -distances),
        "error": np.abs(values) - distances,
        "reference": surface,
        "error_bound": field.error_bound(),
        "exactness": field.exactness,
        "units": scene.units if isinstance(scene, Scene) else "",
        "name": scene.title if isinstance(scene, Scene) else "",
    }


def axes_of(bounds, surface, samples):
    """Coordinates along x, y and z in even steps, none of them wider than asked for."""
    if samples < 2:
        raise located_error(f"samples is {samples}; at least 2 is accepted")
    if bounds is None:
        low, high = surface.bounds
        margin = (high - low).max() / 4
        low, high = low - margin, high + margin
    else:
        low, high = np.array(bounds, dtype=float)
    if low.shape != (3,) or not np.all(low < high):
        raise located_error("bounds are (lowest corner, highest corner), three numbers each")
    step = (high - low).max() / (samples - 1)
    counts = np.ceil((high - low) / step - 1e-9).astype(int) + 1
    return [np.linspace(*ends, n) for *ends, n in zip(low, high, counts, strict=True)]


def grid_points(x, y, z):
    return np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3)
