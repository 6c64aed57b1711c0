"""Values along a straight segment."""

from dataclasses import dataclass

import numpy as np

from sardf._words import choose, fail
from sardf.plot.numbers import point, triple
from sardf.plot.quantities import Quantity, quantities
from sardf.plot.sections import ONLY, table


@dataclass
class Segment:
    """Quantities along a segment.

    start, end: (3,); points: (samples, 3); distance: (samples,) from the start; all in scene units.
    values: {name: (samples,)}, NaN where nothing is shown.
    """

    scene: object
    start: np.ndarray
    end: np.ndarray
    distance: np.ndarray
    points: np.ndarray
    chosen: list[Quantity]
    values: dict[str, np.ndarray]

    @property
    def axis(self) -> int | None:
        """The axis that the segment runs along, forwards: 0, 1, 2 or None."""
        direction = (self.end - self.start) / self.distance[-1]
        return int(direction.argmax()) if direction.max() > 1 - 1e-12 else None

    def table(self) -> tuple[list[str], np.ndarray]:
        """Names of columns, and rows s (the distance), x, y, z, one value for each quantity."""
        header, rows = table(self.points, self.values)
        return ["s", *header], np.column_stack([self.distance, rows])


def segment(scene, start, end, chosen=None, *, samples=1001, only=None, **choices) -> Segment:
    """Quantities along the segment from start to end, each (3,) in scene units.

    chosen, only, choices: as for section(); mixed colours have no line. samples: at least 2.
    Raises Error for what does not exist and for a segment without length.
    """
    start, end = point(start, "segment's start"), point(end, "segment's end")
    length = np.linalg.norm(end - start)
    if not length > 0:
        fail(f"the segment starts and ends at {triple(start)}; two different points are accepted")
    if not samples >= 2:
        fail(f"samples is {samples}; at least 2 are accepted")
    if only is not None:
        choose("part of the segment", only, ONLY)
    chosen = quantities(scene, **choices) if chosen is None else chosen
    lines = [quantity for quantity in chosen if quantity.kind != "colors"]
    if not lines:
        fail("mixed colours cannot be plotted as a line; choose fields, fractions or attributes")
    share = np.linspace(0, 1, int(samples))
    points = start * (1 - share)[:, None] + end * share[:, None]
    values = {q.name: _shown(q, points, only) for q in lines}
    return Segment(scene, start, end, share * length, points, lines, values)


def _shown(quantity: Quantity, points, only) -> np.ndarray:
    values = quantity.values(points)
    only = only or ("inside" if quantity.of_material else "everywhere")
    solid = quantity.scene.solid(points)
    hidden = {"inside": solid < 0, "outside": solid > 0}.get(only)
    return values if hidden is None else np.where(hidden, np.nan, values)
