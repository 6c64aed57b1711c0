# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields of a scene file as Blender objects: primitives, what moves them, points and curves."""

import math
from dataclasses import dataclass, field

from mathutils import Euler, Matrix, Quaternion, Vector

from .import_numbers import NotANumber

LONGEST_CURVE = 20000  # control points; more make Blender slow to edit, and stay text


@dataclass
class Shape:
    """What a field becomes: `kind` of primitive, or "point", "poly" or "nurbs" with `points`."""

    kind: str
    matrix: Matrix
    values: dict = field(default_factory=dict)
    points: list = field(default_factory=list)
    weights: list = field(default_factory=list)
    degree: int = 1
    closed: bool = False


def shape_of(value, numbers):
    """The Shape of a field, or None for one that has no Blender counterpart."""
    if not isinstance(value, dict) or len(value) != 1:
        return None
    word, given = next(iter(value.items()))
    if not isinstance(given, dict):
        return None
    try:
        if word in _MOVES:
            inner = shape_of(given.get("field"), numbers)
            if inner is not None:
                inner.matrix = _MOVES[word](given, numbers) @ inner.matrix
            return inner
        return _SHAPES[word](word, given, numbers) if word in _SHAPES else None
    except NotANumber:
        return None


def _matrix(center, scale=(1, 1, 1), axis=(0, 0, 1)):
    if min(map(abs, scale)) == 0 or not any(axis):
        raise NotANumber
    turn = Vector((0, 0, 1)).rotation_difference(Vector(axis)).to_matrix().to_4x4()
    return Matrix.Translation(center) @ turn @ Matrix.Diagonal((*scale, 1))


def _center(given, numbers):
    return numbers.vector(given.get("center"), (0, 0, 0))


def _sphere(word, given, numbers):
    radius = numbers.number(given.get("radius"))
    return Shape(word, _matrix(_center(given, numbers), (radius,) * 3))


def _ellipsoid(word, given, numbers):
    return Shape(word, _matrix(_center(given, numbers), numbers.vector(given.get("radii"))))


def _box(word, given, numbers):
    half = [size / 2 for size in numbers.vector(given.get("size"))]
    values = {}
    if word == "rounded_box":
        values["rounded_box_radius"] = numbers.number(given.get("radius"))
    return Shape(word, _matrix(_center(given, numbers), half), values)


def _cylinder(word, given, numbers):
    radius, axis = numbers.number(given.get("radius")), numbers.axis(given.get("axis"))
    infinite = given.get("height") is None
    half = radius if infinite else numbers.number(given["height"]) / 2
    values = {"infinite": True} if infinite else {}
    return Shape(word, _matrix(_center(given, numbers), (radius, radius, half), axis), values)


def _cone(word, given, numbers):
    bottom = numbers.number(given.get("radius_bottom"))
    top = numbers.number(given.get("radius_top", 0))
    across, half = max(bottom, top), numbers.number(given.get("height")) / 2
    if across == 0:
        raise NotANumber
    values = {"cone_radius_bottom": bottom / across, "cone_radius_top": top / across}
    axis = numbers.axis(given.get("axis"))
    return Shape(word, _matrix(_center(given, numbers), (across, across, half), axis), values)


def _torus(word, given, numbers):
    major = numbers.number(given.get("major_radius"))
    minor = numbers.number(given.get("minor_radius"))
    values = {"torus_major_radius": 1.0, "torus_minor_radius": minor / major}
    axis = numbers.axis(given.get("axis"))
    return Shape(word, _matrix(_center(given, numbers), (major,) * 3, axis), values)


def _capsule(word, given, numbers):
    a, b = Vector(numbers.vector(given.get("a"))), Vector(numbers.vector(given.get("b")))
    half = (b - a).length / 2
    if half == 0:
        raise NotANumber
    values = {"capsule_radius": numbers.number(given.get("radius")) / half}
    return Shape(word, _matrix((a + b) / 2, (half,) * 3, b - a), values)


def _half_space(word, given, numbers):
    point = numbers.vector(given.get("point"), (0, 0, 0))
    return Shape(word, _matrix(point, axis=numbers.axis(given.get("normal"))))


def _point(word, given, numbers):
    return Shape(word, _matrix(numbers.vector(given.get("at"))))


def _segment(_word, given, numbers):
    ends = [numbers.vector(given.get(key)) for key in ("a", "b")]
    return Shape("poly", Matrix.Identity(4), points=ends)


def _polyline(_word, given, numbers):
    points = _points(given.get("vertices"), numbers)
    return Shape("poly", Matrix.Identity(4), points=points, closed=bool(given.get("closed")))


def _bspline_curve(_word, given, numbers):
    degree = int(numbers.number(given.get("degree", 3)))
    if "knots" in given or not 1 <= degree <= 5:  # Blender's order goes to 6
        return None
    points = _points(given.get("control_points"), numbers)
    weights = [numbers.number(each) for each in given.get("weights") or [1.0] * len(points)]
    return Shape("nurbs", Matrix.Identity(4), points=points, weights=weights, degree=degree,
                 closed=bool(given.get("closed")))  # fmt: skip


def _points(given, numbers):
    if not isinstance(given, list) or not 2 <= len(given) <= LONGEST_CURVE:
        raise NotANumber
    return [numbers.vector(point) for point in given]


def _translate(given, numbers):
    return Matrix.Translation(numbers.vector(given.get("by")))


def _about(center, turn):
    return Matrix.Translation(center) @ turn @ Matrix.Translation(-Vector(center))


def _rotate(given, numbers):
    center = _center(given, numbers)
    if given.get("quaternion") is not None:
        turn = Quaternion(numbers.vector(given["quaternion"], size=4)).normalized().to_matrix()
    elif given.get("euler") is not None:
        turn = Euler(map(math.radians, numbers.vector(given["euler"]))).to_matrix()
    else:
        angle = math.radians(numbers.number(given.get("angle")))
        turn = Matrix.Rotation(angle, 3, Vector(numbers.axis(given.get("axis"))))
    return _about(center, turn.to_4x4())


def _scale(given, numbers):
    factor = numbers.number(given.get("factor"))
    return _about(_center(given, numbers), Matrix.Diagonal((factor, factor, factor, 1)))


def _mirror(given, numbers):
    normal = Vector(numbers.axis(given.get("normal"), "x"))
    point = numbers.vector(given.get("point"), (0, 0, 0))
    return _about(point, Matrix.Scale(-1, 4, normal.normalized()))


_SHAPES = {
    "sphere": _sphere,
    "ellipsoid": _ellipsoid,
    "box": _box,
    "rounded_box": _box,
    "cylinder": _cylinder,
    "cone": _cone,
    "torus": _torus,
    "capsule": _capsule,
    "half_space": _half_space,
    "point": _point,
    "segment": _segment,
    "polyline": _polyline,
    "bspline_curve": _bspline_curve,
}
_MOVES = {"translate": _translate, "rotate": _rotate, "scale": _scale, "mirror": _mirror}
