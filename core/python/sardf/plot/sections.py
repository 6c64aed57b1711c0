"""Values on a grid of points in a plane."""

from dataclasses import dataclass

import numpy as np

from sardf._words import choose, fail
from sardf.plot.numbers import numbers
from sardf.plot.planes import Plane, plane
from sardf.plot.quantities import Quantity, Variant, quantities
from sardf.plot.vectors import KINDS, Vectors, vectors_in

ONLY = ("inside", "outside", "everywhere")
FINEST = 8000
MARGIN = 0.08  # of the longer side of the solid's bounds


@dataclass
class Panel:
    """One quantity on the grid of a section.

    values: (rows, columns), or (rows, columns, 3) of linear colours; NaN where not finite.
    solid: (rows, columns), the solid's field, with the quantity's blend.
    only: "inside", "outside" or "everywhere": which part is shown.
    stripes: (rows, columns), what stripes follow.
    vectors: what is drawn over the values, on a grid of its own; or None.
    """

    quantity: Quantity
    values: np.ndarray
    solid: np.ndarray
    only: str
    outlines: dict[str, np.ndarray]
    stripes: np.ndarray
    vectors: Vectors | None = None

    @property
    def shown(self) -> np.ndarray:
        """The values, NaN where they are not shown."""
        hidden = {"inside": self.solid < 0, "outside": self.solid > 0}.get(self.only)
        if hidden is None:
            return self.values
        return np.where(hidden.reshape(hidden.shape + (1,) * (self.values.ndim - 2)), np.nan,
                        self.values)  # fmt: skip


@dataclass
class Section:
    """Quantities on a rectangular grid in a plane.

    across: (columns,) and up: (rows,) coordinates in the plane, in scene units.
    points: (rows, columns, 3) in scene units.
    """

    scene: object
    plane: Plane
    across: np.ndarray
    up: np.ndarray
    points: np.ndarray
    panels: list[Panel]

    @property
    def values(self) -> dict[str, np.ndarray]:
        """{name: (rows, columns)}: what is shown, NaN elsewhere."""
        return {panel.quantity.name: panel.shown for panel in self.panels}

    def table(self) -> tuple[list[str], np.ndarray]:
        """Names of columns, and rows x, y, z, one value for each panel (three for colours). With
        vectors a row for each of these instead, see Vectors.table(); Error for several blends."""
        vectors = {id(panel.vectors): panel.vectors for panel in self.panels if panel.vectors}
        if len(vectors) > 1:
            fail(f"the vectors of {len(vectors)} blends do not fit into one CSV file; choose one")
        return vectors.popitem()[1].table() if vectors else table(self.points, self.values)


def table(points, values: dict) -> tuple[list[str], np.ndarray]:
    """Names of columns and rows of numbers, from points (..., 3) and values by name."""
    header, columns = list("xyz"), [np.reshape(points, (-1, 3))]
    count = len(columns[0])
    for name, array in values.items():
        array = np.reshape(array, (count, -1))
        header += [name] if array.shape[1] == 1 else [f"{name}_{c}" for c in "rgb"]
        columns.append(array)
    return header, np.concatenate(columns, axis=1)


def section(
    scene, at, chosen=None, *, window=None, resolution=400, only=None, outlines=(), arrows=None,
    streamlines=None, arrow_count=24, **choices,
) -> Section:  # fmt: skip
    """Quantities on a grid in a plane.

    at: "y=0", a pair (point, normal) or a Plane.
    chosen: Quantities, or choices as the keywords of quantities(): fields=["solid"], ...
    window: (left, right, bottom, top) in the plane's coordinates, in scene units; by default what
        holds the solid's bounds, and a margin.
    resolution: samples along the longer side, 2 to 8000.
    only: "inside", "outside" or "everywhere"; by default fractions, attributes and colours are
        shown inside the solid, fields everywhere.
    outlines: names of fields or formulas whose zero levels are wanted too.
    arrows or streamlines: a vector attribute that is drawn over the panels, by default inside the
        solid. arrow_count: arrows along the window's longer side, 1 to 400; streamlines keep the
        distance that these would have.
    Raises Error for what does not exist and for a window without area.
    """
    at = plane(at)
    chosen = quantities(scene, **choices) if chosen is None else chosen
    if only is not None:
        choose("part of the plane", only, ONLY)
    if not 2 <= resolution <= FINEST:
        fail(f"the resolution is {resolution}; 2 to {FINEST} samples are accepted")
    left, right, bottom, top = _checked(window) if window is not None else _around(scene, at)
    step = max(right - left, top - bottom) / (int(resolution) - 1)
    across = np.linspace(left, right, max(2, round((right - left) / step) + 1))
    up = np.linspace(bottom, top, max(2, round((top - bottom) / step) + 1))
    points = at.points(*np.meshgrid(across, up))
    panels = [_panel(quantity, points, only, outlines) for quantity in chosen]
    made = Section(scene, at, across, up, points, panels)
    add_vectors(made, arrows, streamlines, arrow_count, only or "inside")
    return made


def add_vectors(made: Section, arrows, streamlines, count: int, only: str) -> None:
    """Gives every panel the vectors of its scene; panels of the same scene share them."""
    asked = {kind: name for kind, name in zip(KINDS, (arrows, streamlines), strict=True) if name}
    if len(asked) > 1:
        fail("arrows and streamlines are drawn one at a time; choose one of them")
    window = made.across[0], made.across[-1], made.up[0], made.up[-1]
    for kind, name in asked.items():
        found = {}
        for panel in made.panels:
            scene = panel.quantity.scene
            if id(scene) not in found:
                found[id(scene)] = vectors_in(scene, name, kind, made.plane, window, count, only)
            panel.vectors = found[id(scene)]


def _panel(quantity: Quantity, points, only, outlines) -> Panel:
    flat = points.reshape(-1, 3)

    def on_grid(field):
        values = np.asarray(field(flat)).reshape(points.shape[:-1])
        return np.where(np.isfinite(values), values, np.nan)

    source = Variant("", quantity.scene)
    values = quantity.values(points)
    stripes = values
    if values.ndim == 3:  # the stripes of mixed colours follow the first fraction
        stripes = quantity.scene.fractions(flat)[:, 0].reshape(points.shape[:-1])
    return Panel(
        quantity, values, on_grid(quantity.scene.solid),
        only or ("inside" if quantity.of_material else "everywhere"),
        {name: on_grid(source.field_of(name)) for name in outlines}, stripes,
    )  # fmt: skip


def _checked(window):
    left, right, bottom, top = numbers(window, 4, "window", "-1,1,-1,1")
    if not (left < right and bottom < top):
        fail(f"the window is '{window}'; left,right,bottom,top with left < right and bottom < top "
             "is accepted")  # fmt: skip
    return left, right, bottom, top


def _around(scene, at: Plane):
    """A window around what the plane cuts out of the solid's bounds, or around all of them."""
    low, high = (np.array(corner) for corner in scene.bounds)
    corners = np.array([np.where([i & 1, i & 2, i & 4], high, low) for i in range(8)])
    seen = at.coordinates(corners)
    edges = [(seen[i], seen[i | bit]) for i in range(8) for bit in (1, 2, 4) if not i & bit]
    cut = [a + a[2] / (a[2] - b[2]) * (b - a) for a, b in edges if a[2] * b[2] < 0]
    seen = np.array(cut) if cut else seen
    low, high = seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)
    margin = MARGIN * (high - low).max()
    return low[0] - margin, high[0] + margin, low[1] - margin, high[1] + margin
