"""Colour scales: limits, bands, lines and colours that panels share."""

from dataclasses import dataclass

import matplotlib
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap, Normalize, TwoSlopeNorm
from matplotlib.ticker import MaxNLocator

from sardf._words import fail
from sardf.plot.look import NONE, Look

MOST_LEVELS = 1000
DARKER = 0.72  # every second stripe
EVERY = (1, 2, 4, 5, 10, 20, 40, 50, 100, 200)  # edges from one tick to the next


@dataclass(frozen=True)
class Scale:
    """limits: the lowest and the highest value that has its own colour. edges: of the filled bands,
    None for smooth colours. lines: the values of the contour lines. extend: as in matplotlib."""

    label: str
    limits: tuple[float, float]
    edges: np.ndarray | None
    lines: np.ndarray
    cmap: object
    norm: object
    extend: str

    @property
    def mappable(self) -> ScalarMappable:
        return ScalarMappable(self.norm, self.cmap)

    def ticks(self) -> np.ndarray:
        """Values that a colour bar names: at most nine, 0 among them where it is an edge."""
        if self.edges is None:
            low, high = self.limits
            ticks = MaxNLocator(8).tick_values(low, high)
            return ticks[(ticks >= low) & (ticks <= high)]
        every = next(n for n in EVERY if len(self.edges) <= 9 * n)
        zero = np.flatnonzero(np.abs(self.edges) < 1e-9 * np.ptp(self.edges))
        return self.edges[(zero[0] if len(zero) else 0) % every :: every]

    def snapped(self, values) -> np.ndarray:
        """Values within rounding errors of a level put onto it, so that a plateau has no noise."""
        levels = self.lines if self.edges is None else np.union1d(self.edges, self.lines)
        out, near = np.array(values), 1e-9 * (self.limits[1] - self.limits[0])
        for level in levels:
            out[np.abs(out - level) < near] = level
        return out


def scale_of(panels, look: Look) -> Scale:
    """The scale that suits all the panels, whose quantities are of one kind."""
    kind = panels[0].quantity.kind
    labels = {panel.quantity.label for panel in panels}
    label = labels.pop() if len(labels) == 1 else kind
    low, high = _range(panels)
    if kind == "fraction":
        low, high = 0.0, 1.0
    shown = low, high
    if look.limits:
        low, high = look.limits
    cmap, place = _colors(kind, low, high, look)
    edges = _edges(kind, low, high, look)
    if edges is not None and not look.limits:
        low, high = edges[0], edges[-1]
    tolerance = 1e-9 * (high - low)
    below, above = shown[0] < low - tolerance, shown[1] > high + tolerance
    extend = {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[(below, above)]
    lines = _lines(kind, low, high, edges, look)
    if edges is None:
        smooth = ListedColormap(_part(cmap, place, np.linspace(low, high, 512)))
        return Scale(label, (low, high), None, lines, smooth, Normalize(low, high), extend)
    colors = _part(cmap, place, (edges[1:] + edges[:-1]) / 2)
    if look.stripes:
        colors[1::2, :3] *= DARKER
    banded = ListedColormap(colors).with_extremes(under=colors[0], over=colors[-1])
    norm = BoundaryNorm(edges, len(colors))
    return Scale(label, (low, high), edges, lines, banded, norm, extend)


def _range(panels) -> tuple[float, float]:
    shown = [panel.shown[np.isfinite(panel.shown)] for panel in panels]
    shown = [values for values in shown if values.size]
    if not shown:
        names = ", ".join(panel.quantity.name for panel in panels)
        fail(f"there is nothing to draw of {names}: it has no finite value where it is shown")
    low, high = min(v.min() for v in shown), max(v.max() for v in shown)
    if high - low <= 1e-9 * max(abs(low), abs(high), 1e-3):
        middle, half = (low + high) / 2, max(0.05 * max(abs(low), abs(high)), 1e-3)
        return middle - half, middle + half
    return low, high


def _colors(kind, low, high, look: Look):
    """The colour map, and what gives each value its place in it, from 0 to 1."""
    if kind == "gradient" and low < 1.1 and high > 0.9:  # 1, the slope of distances, is white
        name, place = "PuOr_r", TwoSlopeNorm(1, min(low, 0.9), max(high, 1.1))
    elif kind in ("field", "error") and low < 0 < high:
        half = max(-low, high)
        name, place = {"field": "RdBu_r", "error": "PuOr_r"}[kind], Normalize(-half, half)
    elif kind == "error":
        name, place = (
            ("YlOrBr", Normalize(0, high)) if high > 0 else ("YlOrBr_r", Normalize(low, 0))
        )
    else:
        name, place = {"fraction": "cividis"}.get(kind, "viridis"), Normalize(low, high)
    return matplotlib.colormaps[look.colors or name], place


def _part(cmap, place, values) -> np.ndarray:
    """The colours (N, 4) of values."""
    return cmap(np.clip(np.asarray(place(values)), 0, 1))


def _edges(kind, low, high, look: Look):
    if look.stripes and (look.limits or kind == "fraction"):
        return np.linspace(low, high, look.stripes + 1)
    bands = look.stripes or look.bands
    if bands is None:
        bands = NONE if kind in ("gradient", "error") else 10 if kind == "fraction" else 20
    if bands == NONE:
        return None
    if isinstance(bands, int):
        edges = MaxNLocator(bands, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)
    else:
        edges = _multiples(low, high, bands)
    if look.limits or kind == "fraction":
        inside = edges[(edges > low) & (edges < high)]
        return np.concatenate([[low], inside, [high]])
    first = max(np.searchsorted(edges, low + 1e-9 * (high - low), side="right") - 1, 0)
    last = min(np.searchsorted(edges, high - 1e-9 * (high - low)), len(edges) - 1)
    return edges[first : last + 1] if last > first else np.array([low, high])


def _lines(kind, low, high, edges, look: Look) -> np.ndarray:
    chosen = look.lines
    if chosen == NONE or (chosen is None and (kind in ("gradient", "error") or look.stripes)):
        return np.array([])
    if isinstance(chosen, (list, tuple)):
        return np.unique(np.array(chosen, float))
    if chosen is None:
        lines = MaxNLocator(12).tick_values(low, high) if edges is None else edges
    else:
        lines = _multiples(low, high, chosen)
    # At the limits of fractions, plateaus end: no line there.
    near = 1e-9 * (high - low) if kind == "fraction" else -1e-9 * (high - low)
    return lines[(lines > low + near) & (lines < high - near)]


def _multiples(low, high, step) -> np.ndarray:
    if (high - low) / step > MOST_LEVELS:
        fail(f"a step of {step:g} makes more than {MOST_LEVELS} levels from {low:g} to {high:g}; "
             f"{(high - low) / 20:.2g} makes 20")  # fmt: skip
    first, last = np.floor(low / step + 1e-9), np.ceil(high / step - 1e-9)
    return np.arange(first, last + 1) * step
