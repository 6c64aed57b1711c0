# SPDX-License-Identifier: GPL-3.0-or-later
"""The edges that draw a primitive: points and pairs of point numbers, in the object's frame."""

import math

from mathutils import Matrix, Vector

STEPS = 32  # of a circle


def outline(kind, values):
    """(points, edges) of a primitive of primitives.KINDS with its {word: number}."""
    points, edges = [], []

    def add(line, closed=False):
        first = len(points)
        points.extend(line)
        edges.extend((i, i + 1) for i in range(first, len(points) - 1))
        if closed:
            edges.append((len(points) - 1, first))

    for line, closed in _LINES[kind](values):
        add(line, closed)
    return points, edges


def _circle(radius, normal="z", height=0.0, around=(0.0, 0.0), start=0.0, turn=2 * math.pi):
    """Points of a circle, or of an arc, about one of the axes."""
    whole = abs(turn) >= 2 * math.pi
    steps = STEPS if whole else STEPS // 2
    angles = [start + turn * i / steps for i in range(steps + (not whole))]
    reach, middle = Vector((radius, 0)), Vector(around)
    flat = [middle + Matrix.Rotation(angle, 2) @ reach for angle in angles]
    place = {"z": lambda u, v: (u, v, height), "y": lambda u, v: (u, height, v),
             "x": lambda u, v: (height, u, v)}[normal]  # fmt: skip
    return [place(u, v) for u, v in flat]


def _ball(_values):
    return [(_circle(1.0, axis), True) for axis in "xyz"]


def _box(_values):
    yield from (([(x, y, z) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))], True)
                for z in (-1, 1))  # fmt: skip
    yield from (([(x, y, -1), (x, y, 1)], False) for x in (-1, 1) for y in (-1, 1))


def _rounded_box(_values):
    yield from _box(_values)
    # A square with cut corners in each face tells it from a box.
    short = 0.85
    for axis in "xyz":
        for height in (-1, 1):
            yield _circle(short * Vector((1, 1)).length, axis, height)[4::8], True


def _cylinder(values):
    yield from _frustum(1.0, 1.0)
    if values.get("infinite"):  # its sides go on
        for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1)):
            yield [(c, s, -1.0), (c, s, -2.0)], False
            yield [(c, s, 1.0), (c, s, 2.0)], False


def _frustum(bottom, top):
    yield _circle(bottom, height=-1.0), True
    yield _circle(top, height=1.0), True
    for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1)):
        yield [(bottom * c, bottom * s, -1.0), (top * c, top * s, 1.0)], False


def _torus(values):
    major, minor = values["major_radius"], values["minor_radius"]
    yield from ((_circle(major + side * minor), True) for side in (-1, 1))
    yield from ((_circle(major, height=side * minor), True) for side in (-1, 1))
    for side in (-1, 1):
        yield _circle(minor, "y", around=(side * major, 0)), True
        yield _circle(minor, "x", around=(side * major, 0)), True


def _capsule(values):
    radius = values["radius"]
    for height in (-1.0, 1.0):
        yield _circle(radius, height=height), True
    for axis in "xy":
        for height, start in ((1.0, 0.0), (-1.0, math.pi)):
            yield _circle(radius, axis, around=(0, height), start=start, turn=math.pi), False
    for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1)):
        yield [(radius * c, radius * s, -1.0), (radius * c, radius * s, 1.0)], False


def _half_space(_values):
    yield [(x, y, 0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))], True
    yield [(0, 0, 0), (0, 0, 0.5)], False  # into the solid
    yield [(-0.1, 0, 0.4), (0, 0, 0.5), (0.1, 0, 0.4)], False


def _formula(_values):
    """The three axes of its coordinates, and the box from -1 to 1 in thin dashes' stead."""
    for x, y, z in ((1, 0, 0), (0, 1, 0), (0, 0, 1)):
        yield [(-x, -y, -z), (x, y, z)], False
    for corner in ((x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)):
        for axis in range(3):
            end = list(corner)
            end[axis] *= 0.7
            yield [corner, tuple(end)], False


_LINES = {
    "sphere": _ball,
    "ellipsoid": _ball,
    "box": _box,
    "rounded_box": _rounded_box,
    "cylinder": _cylinder,
    "cone": lambda values: _frustum(values["radius_bottom"], values["radius_top"]),
    "torus": _torus,
    "capsule": _capsule,
    "half_space": _half_space,
    "formula": _formula,
}
