"""Vector attributes on a regular grid in a plane, and how far they point out of it."""

from dataclasses import dataclass

import numpy as np

from sardf._words import fail, vector_attribute
from sardf.plot.planes import Plane
from sardf.plot.quantities import unit_of

KINDS = ("arrows", "streamlines")
MOST = 400  # arrows along the longer side
FINER = 6  # samples for streamlines between two arrows
FLAT = 1e-9  # the share up to which a vector counts as in the plane, or perpendicular to it


@dataclass(frozen=True)
class Vectors:
    """A vector attribute on a regular grid in a plane.

    name: the attribute; label: with its unit; kind: "arrows" or "streamlines".
    across: (columns,) and up: (rows,) coordinates in the plane, and step between two arrows, in
        scene units.
    points: (rows, columns, 3) in scene units. vectors: (rows, columns, 3) in the attribute's unit;
        a vector of two components has the third 0. NaN where one is not finite.
    only: "inside", "outside" or "everywhere": the part that is shown. shown: (rows, columns),
        whether the point lies in it.
    """

    name: str
    label: str
    kind: str
    plane: Plane
    across: np.ndarray
    up: np.ndarray
    step: float
    points: np.ndarray
    vectors: np.ndarray
    only: str
    shown: np.ndarray

    @property
    def length(self) -> np.ndarray:
        """(rows, columns): the vectors' lengths."""
        return np.linalg.norm(self.vectors, axis=-1)

    @property
    def directions(self) -> np.ndarray:
        """(rows, columns, 3): unit vectors in the plane's frame, to the right, upwards and towards
        the viewer; NaN for a vector of length 0."""
        frame = np.array([self.plane.right, self.plane.up, self.plane.normal])
        length = self.length[..., None]
        return self.vectors @ frame.T / np.where(length > 0, length, np.nan)

    def table(self) -> tuple[list[str], np.ndarray]:
        """Names of columns, and a row for each shown vector: x, y, z, its components, and those of
        the unit vector to the right, upwards and towards the viewer."""
        own = [f"{self.name}_{c}" for c in "xyz"]
        seen = [f"{self.name}_{c}" for c in ("right", "up", "towards")]
        rows = np.concatenate([self.points, self.vectors, self.directions], axis=-1)
        return [*"xyz", *own, *seen], rows[self.shown]


def vectors_in(scene, name: str, kind: str, plane: Plane, window, count: int, only) -> Vectors:
    """The vector attribute `name` of the scene in a window of a plane.

    kind: "arrows" or "streamlines", which are sampled more finely. window: (left, right, bottom,
    top) in the plane. count: arrows along the window's longer side, 1 to 400. only: "inside",
    "outside" or "everywhere".
    Raises Error for an attribute that does not exist or is no vector of 2 or 3 components, and
    where no vector is left to be shown.
    """
    if not 1 <= count <= MOST:
        fail(f"the arrow count is {count}; 1 to {MOST} along the longer side are accepted")
    evaluate = vector_attribute(scene, name, (2, 3), "arrows and streamlines show")
    step, across, up = _grid(window, int(count), FINER if kind == "streamlines" else 1)
    points = plane.points(*np.meshgrid(across, up))
    flat = np.ascontiguousarray(points.reshape(-1, 3))
    with np.errstate(all="ignore"):
        found = np.asarray(evaluate(flat), float)
    vectors = np.zeros_like(flat)
    vectors[:, : found.shape[1]] = found
    vectors[~np.isfinite(vectors).all(axis=1)] = np.nan
    solid = np.asarray(scene.solid(flat))
    shown = {"inside": solid >= 0, "outside": solid <= 0}.get(only, np.isfinite(solid))
    made = Vectors(
        name, name + unit_of(scene, name), kind, plane, across, up, step, points,
        vectors.reshape(points.shape), only, shown.reshape(points.shape[:2]),
    )  # fmt: skip
    _check_something_shown(made)
    return made


def _grid(window, count: int, finer: int):
    """The step between arrows, and the coordinates: for arrows the middles of square cells, for
    streamlines from edge to edge."""
    left, right, bottom, top = window
    step = max(right - left, top - bottom) / count
    if finer > 1:
        return step, _ends(left, right, step / finer), _ends(bottom, top, step / finer)
    return step, _middles(left, right, step), _middles(bottom, top, step)


def _ends(low: float, high: float, step: float) -> np.ndarray:
    return np.linspace(low, high, max(2, round((high - low) / step) + 1))


def _middles(low: float, high: float, step: float) -> np.ndarray:
    count = max(1, round((high - low) / step))
    return (low + high) / 2 + (np.arange(count) - (count - 1) / 2) * step


def _check_something_shown(made: Vectors) -> None:
    usable = made.shown & (made.length > 0)
    if not usable.any():
        why = "where it is shown, it is 0 or not finite"
        if not made.shown.any():
            why = f"in this window, none of its {made.kind} lies {made.only} the solid"
        fail(f"there is nothing to draw of {made.name} in the plane {made.plane.name}: {why}")
    if made.kind == "streamlines":
        in_plane = np.linalg.norm(made.directions[..., :2], axis=-1)[usable]
        if in_plane.max() <= FLAT:
            fail(f"{made.name} has no streamlines in the plane {made.plane.name}: it is "
                 "perpendicular to it; arrows can show that")  # fmt: skip
