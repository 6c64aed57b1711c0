"""Closed contours from SVG drawings, as vertices for `sardf.polygon` and `implicit_polygon`.

    import sardf.svg
    contours = sardf.svg.read_contours("tooth.svg", tolerance=0.01)
    tooth = sardf.polygon(contours["enamel"])

Coordinates are the drawing's user units, those that its viewBox counts; its width and height (mm,
px) do not scale them. They are multiplied by `scale`, and y is turned upwards.
"""

import difflib
import math

import numpy as np

from sardf._command import located_error
from sardf.svg._contour import check_contour, tidy
from sardf.svg._document import read_document
from sardf.svg._flatten import flatten
from sardf.svg._shapes import subpaths

__all__ = ["read_contours"]

FINEST = 1e-9  # the finest tolerance, relative to the largest coordinate


def read_contours(path, tolerance, scale=1.0, only=None):
    """The closed contours of a drawing: {name: float64 (N, 2)}, the first vertex not repeated.

    path: an SVG file.
    tolerance: how far a contour may be from the drawn curve (scene units); that is proven.
    scale: scene units in one user unit of the drawing.
    only: names of the elements, or of single contours, that are read; none: everything must be a
        closed contour.

    A contour has the id of its element, otherwise its inkscape:label, otherwise path_1, path_2, ...
    in the order of the file, with _ for what a field's name may not contain. An element of several
    subpaths gives name_1, name_2, ... Elements inside <defs> and those with display:none are not
    drawn and not read.

    Raises Error, with file, line and element, for open curves, text, images, clones, clip paths and
    masks, and for contours that cross or touch themselves.
    """
    check_positive("tolerance", tolerance)
    check_positive("scale", scale)
    elements = read_document(path)
    if only is not None:
        elements = chosen_elements(elements, list(only), path)
    for element in elements:
        element.check_kind()
    drawn = [(element, subpaths(element)) for element in elements]
    check_closed(drawn, path)
    contours = {}
    for element, found in drawn:
        for name, segments in named_subpaths(element, found):
            if only is None or name in only or element.name in only:
                if name in contours:
                    element.fail(f"another contour is named '{name}', too")
                contours[name] = contour_of(element, segments, float(tolerance), float(scale))
    names = {*contours, *(element.name for element in elements)}
    missing = [name for name in only or () if name not in names]
    if missing:
        fail_unknown(missing[0], contours, path)
    return contours


def check_positive(what, value):
    if not (isinstance(value, (int, float, np.number)) and math.isfinite(value) and value > 0):
        raise located_error(f"{what} is {value!r}; a positive number is accepted")


def chosen_elements(elements, only, path):
    """Those whose name, or a contour of which, is asked for."""
    known = {element.name for element in elements if element.is_shape}
    wanted = set()
    for name in only:
        element_name = name if name in known else name.rpartition("_")[0]
        if element_name not in known:
            fail_unknown(name, known, path)
        wanted.add(element_name)
    return [element for element in elements if element.is_shape and element.name in wanted]


def fail_unknown(name, known, path):
    near = difflib.get_close_matches(name, known, 1, 0.4)
    meant = f"; did you mean '{near[0]}'?" if near else ""
    accepted = ", ".join(sorted(known)) or "none"
    raise located_error(f"no contour is named '{name}'; accepted are {accepted}{meant}", path)


def check_closed(drawn, path):
    """Every subpath is closed."""
    every = [(element, subpath) for element, found in drawn for subpath in found]
    if not every:
        raise located_error("the drawing has no closed contour", path)
    still_open = [element for element, subpath in every if not subpath.closed]
    if len(still_open) == len(every):
        still_open[0].fail("the drawing has no closed contour, only open curves such as this one")
    if still_open:
        still_open[0].fail("the contour is open; close it, in path data with Z")


def named_subpaths(element, found):
    if len(found) == 1:
        return [(element.name, found[0].segments)]
    return [(f"{element.name}_{i}", subpath.segments) for i, subpath in enumerate(found, 1)]


def contour_of(element, segments, tolerance, scale):
    """One subpath as vertices in scene coordinates."""
    to_scene = np.diag([scale, -scale, 1.0]) @ element.matrix
    moved = [segment.moved(to_scene) for segment in segments]
    reach = max(np.abs(segment.hull()).max() for segment in moved)
    if not math.isfinite(reach):
        element.fail("its coordinates are not finite")
    if tolerance < FINEST * reach:
        element.fail(
            f"a tolerance of {tolerance:g} is finer than {FINEST:g} of its largest coordinate,"
            f" {reach:g}"
        )
    # tidy() moves the contour by up to 4 of these.
    nearly_zero = min(1e-9 * reach, tolerance / 16)
    points = flatten(moved, tolerance - 4 * nearly_zero)
    points = tidy(points, nearly_zero)
    check_contour(points, element.fail)
    return points
