"""How a figure looks: every choice that does not change the numbers."""

from dataclasses import dataclass

import matplotlib

from sardf._words import choose, fail, number
from sardf.plot.numbers import brief, numbers

NONE = "none"
EQUAL, SCALED = "equal", "scaled"
ARROW_LENGTHS = (EQUAL, SCALED)


@dataclass(frozen=True)
class Look:
    """bands: about how many filled bands (int), their width (float), "none" for smooth colours,
        or None for what suits the quantity.
    lines: the step between contour lines (number), their values (list), "none", or None for the
        edges of the bands.
    stripes: number of bands of which every second is darkened, exact for fractions and between
        given limits, else about so many of a round width; 0: none.
    label_lines: write the values on the lines.
    outline: draw the solid's outline.
    blank: no colours and no lines, only outlines.
    separate_scales: each panel has its own colours' limits (each curve its own graph).
    limits: (low, high) of the colours; None for the range of what is shown.
    colors: a matplotlib colour map's name; None for what suits the quantity.
    scale_bar: draw a bar of a round length.
    arrow_lengths: "equal": all arrows are equally long in space, and so appear shorter the more
        they point out of the plane; "scaled": as long as the vectors, by one common factor.
    columns: panels side by side; None: all of one quantity, or up to four.
    size: (width, height) of the figure in inches; None: what the panels need.
    title: the figure's title; None: the scene's title and the plane; "": none.
    """

    bands: int | float | str | None = None
    lines: float | list | str | None = None
    stripes: int = 0
    label_lines: bool = False
    outline: bool = True
    blank: bool = False
    separate_scales: bool = False
    limits: tuple | None = None
    colors: str | None = None
    scale_bar: bool = True
    arrow_lengths: str = EQUAL
    columns: int | None = None
    size: tuple | None = None
    title: str | None = None

    def __post_init__(self):
        if self.colors is not None:
            choose("colour map", self.colors, list(matplotlib.colormaps))
        choose("length of arrows", self.arrow_lengths, ARROW_LENGTHS)
        if self.stripes < 0 or self.stripes == 1:
            fail(f"stripes is {self.stripes}; 2 or more, or 0 for none, is accepted")
        if self.columns is not None and self.columns < 1:
            fail(f"columns is {self.columns}; 1 or more is accepted")
        if self.limits is not None:
            low, high = numbers(self.limits, 2, "limits", "-1,1")
            if not low < high:
                fail(f"the limits are {brief(low)} and {brief(high)}; low < high is accepted")
            object.__setattr__(self, "limits", (low, high))
        if self.size is not None:
            width, height = numbers(self.size, 2, "size", "8,6")
            if not (1 <= width <= 100 and 1 <= height <= 100):
                fail(f"the size is {brief(width)},{brief(height)}; 1 to 100 inches are accepted")
            object.__setattr__(self, "size", (width, height))


def bands_from(text: str):
    """What --bands says: none, a whole number of bands, or a width with a decimal point."""
    if text == NONE:
        return NONE
    value = number(text, "bands")
    if not value > 0:
        fail(f"bands is '{text}'; a positive number or 'none' is accepted")
    return int(text) if text.strip().isdigit() else value


def lines_from(text: str):
    """What --lines says: none, a step, or values separated by commas."""
    if text == NONE:
        return NONE
    if "," in text:
        return [number(part, "line's value") for part in text.split(",") if part.strip()]
    step = number(text, "step between lines")
    if not step > 0:
        fail(f"the step between lines is '{text}'; a positive number is accepted, or values as in "
             "\"-1,0,1\"")  # fmt: skip
    return step
