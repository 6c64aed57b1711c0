"""Elements as subpaths: pieces of curves in the element's own coordinates."""

from dataclasses import dataclass, field

import numpy as np

from sardf._command import library
from sardf.svg._flatten import Arc, Bezier
from sardf.svg._lengths import length, numbers_of

SIZES = {"rect": ("width", "height"), "circle": ("r",), "ellipse": ("rx", "ry")}


@dataclass
class Subpath:
    closed: bool = False
    segments: list = field(default_factory=list)


def subpaths(element):
    """The subpaths of an element that draw anything."""
    found = []
    current = Subpath()
    for piece in pieces(element):
        kind = type(piece).__name__
        if kind == "Move":
            found.append(current)
            current = Subpath()
            continue
        segment = segment_of(piece, kind)
        if segment is not None:
            current.segments.append(segment)
        if kind == "Close":
            current.closed = True
            found.append(current)
            current = Subpath()
    found.append(current)
    found = [subpath for subpath in found if subpath.segments]
    for subpath in found:
        subpath.closed = subpath.closed or ends_meet(subpath.segments)
    return found


def ends_meet(segments):
    start, end = segments[0].start, segments[-1].end
    reach = max(np.abs(segment.hull()).max() for segment in segments)
    return np.abs(end - start).max() <= 1e-9 * reach


def pieces(element):
    """The element as pieces of svgelements."""
    if element.tag == "path":
        return path_pieces(element)
    if element.tag in ("polygon", "polyline", "line"):
        points = corner_points(element)
        path = library("svgelements", "svg").Path()
        if points:
            path.move(points[0])
            path.line(*points[1:])
        if points and element.tag == "polygon":
            path.closed()
        return list(path)
    return list(round_or_rect(element).segments(transformed=False))


def path_pieces(element):
    made = library("svgelements.svgelements", "svg")
    text = element.attributes.get("d", "").strip()
    if text[:1] not in ("M", "m", ""):
        element.fail("its path data does not begin with M")
    path, parser = made.Path(), made.SVGLexicalParser()
    try:
        parser.parse(path, text)
    except (ValueError, IndexError, TypeError, AttributeError, ArithmeticError):
        element.fail(f"its path data cannot be read near character {parser.pos + 1}")
    rest = text[parser.pos :].strip()
    if rest:
        element.fail(f"its path data cannot be read from '{rest[:20]}' on")
    return list(path)


def corner_points(element):
    if element.tag == "line":
        at = [length(element, key) for key in ("x1", "y1", "x2", "y2")]
    else:
        at = numbers_of(element.attributes.get("points", ""), element.fail, "a polygon")
    if len(at) % 2:
        element.fail(f"its points are {len(at)} numbers; pairs of x and y are accepted")
    return list(zip(at[::2], at[1::2], strict=True))


def round_or_rect(element):
    keys = {
        "rect": ("x", "y", "width", "height"),
        "circle": ("cx", "cy", "r"),
        "ellipse": ("cx", "cy"),
    }[element.tag]
    values = {key: length(element, key) for key in keys}
    if element.tag != "circle":
        radii = [length(element, key, None) for key in ("rx", "ry")]
        rx, ry = (next((r for r in (a, b) if r is not None), 0.0) for a, b in (radii, radii[::-1]))
        values |= {"rx": rx, "ry": ry}
    for key in SIZES[element.tag]:
        if not values[key] > 0:
            element.fail(f"its '{key}' is {values[key]:g}; a positive length is accepted")
    if min(values.get("rx", 0), values.get("ry", 0)) < 0:
        element.fail("its corners have a negative radius")
    return getattr(library("svgelements", "svg"), element.tag.capitalize())(values)


def segment_of(piece, kind):
    """One piece of svgelements as ours."""
    if piece.start is None or piece.end is None:
        return None
    start, end = pair(piece.start), pair(piece.end)
    if kind == "Arc":
        center = pair(piece.center)
        u, v = pair(piece.prx) - center, pair(piece.pry) - center
        if piece.sweep and u @ u > 0 and v @ v > 0:
            at = start - center
            angle = np.arctan2(at @ v / (v @ v), at @ u / (u @ u))
            return Arc(start, end, center, u, v, float(angle), float(piece.sweep))
    controls = {"QuadraticBezier": ("control",), "CubicBezier": ("control1", "control2")}
    inner = [pair(getattr(piece, name)) for name in controls.get(kind, ())]
    return Bezier(np.array([start, *inner, end]))


def pair(point):
    return np.array([float(point.x), float(point.y)])
