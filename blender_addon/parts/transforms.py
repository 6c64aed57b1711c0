# SPDX-License-Identifier: GPL-3.0-or-later
"""An object's matrix in the words of the scene file, and numbers as people write them."""

import math
from dataclasses import dataclass

from mathutils import Matrix, Vector

DIGITS = 7  # Blender computes in single precision: what follows is noise
EVEN = 1e-5  # lengths, and cosines of right angles, that differ by less count as equal


class Flat(Exception):
    """A matrix that squeezes space to a plane, a line or a point."""


def number(value, size=0.0):
    """`value` with the digits that Blender knows; 0 where it is noise beside `size`."""
    if abs(value) < 1e-7 * size:
        return 0.0
    return float(f"{value:.{DIGITS}g}")


def numbers(values, size=None):
    values = [float(value) for value in values]
    size = max(map(abs, values), default=0.0) if size is None else size
    return [number(value, size) for value in values]


@dataclass
class Placement:
    """A matrix taken apart: p -> origin + Σ axis_i * scale_i * p_i.

    `straight`: whether the axes stand at right angles; then they have unit length, and the
    scales, which are positive, are all that is stretched. `handed`: -1 where space is mirrored.
    """

    origin: Vector
    axes: list
    scale: list
    straight: bool
    handed: int

    @property
    def even(self):
        low, high = min(self.scale), max(self.scale)
        return self.straight and high - low <= EVEN * high

    @property
    def factor(self):
        return sum(self.scale) / 3


def take_apart(matrix):
    """The Placement of a 4x4 matrix. Raises Flat."""
    columns = [matrix.col[axis].xyz for axis in range(3)]
    lengths = [column.length for column in columns]
    if not all(map(math.isfinite, [*lengths, *matrix.translation])):
        raise Flat
    if min(lengths) <= 1e-9 * max(lengths) or max(lengths) == 0:
        raise Flat
    axes = [column / length for column, length in zip(columns, lengths, strict=True)]
    turn = matrix.to_3x3().determinant()
    if abs(turn) <= 1e-9 * lengths[0] * lengths[1] * lengths[2]:
        raise Flat
    straight = all(abs(axes[i].dot(axes[j])) < EVEN for i, j in ((0, 1), (0, 2), (1, 2)))
    return Placement(matrix.translation.copy(), axes, lengths, straight, 1 if turn > 0 else -1)


def is_flat(matrix):
    """Whether take_apart would refuse a matrix."""
    try:
        take_apart(matrix)
    except Flat:
        return True
    return False


def quaternion_of(axes):
    """[w, x, y, z] of the turn that brings x, y, z to three unit axes, or None where it is none."""
    rows = Matrix([list(axis) for axis in axes]).transposed()
    turn = rows.to_quaternion()
    turn.normalize()
    if turn.w < 0:
        turn.negate()
    if Vector((turn.x, turn.y, turn.z)).length < 1e-6:
        return None
    return numbers(turn, 1.0)


def placed(field, matrix):
    """The field, given in an object's own frame, where the object's matrix puts it.

    Turned, evenly scaled and mirrored fields keep what is known of their distances. Where the
    matrix stretches unevenly the result is the field at the point before stretching, times the
    least stretch: for a distance it is nowhere more than the distance. Raises Flat.
    """
    place = take_apart(matrix)
    if not place.even:
        return _stretched(field, matrix, place)
    axes = list(place.axes)
    if place.handed < 0:
        field = {"mirror": {"field": field, "normal": "x"}}
        axes[0] = -axes[0]
    if abs(place.factor - 1) > EVEN:
        field = {"scale": {"field": field, "factor": number(place.factor)}}
    return turned_and_moved(field, axes, place.origin)


def turned_and_moved(field, axes, origin):
    """A field with its x, y and z along the axes and its origin there."""
    turn = quaternion_of(axes)
    if turn:
        field = {"rotate": {"field": field, "quaternion": turn}}
    by = numbers(origin)
    return {"translate": {"field": field, "by": by}} if any(by) else field


def _stretched(field, matrix, place):
    inverse = matrix.inverted()
    least = _least_stretch(place, inverse)
    size = max(abs(value) for row in inverse for value in row)
    rows = []
    for row in list(inverse)[:3]:
        # scale(f, s) is s * f(p / s), so the point is multiplied by s here.
        factors = [number(least * value, size) for value in row[:3]]
        terms = [
            f"{factor:+.{DIGITS}g}*{name}" for factor, name in zip(factors, "xyz", strict=True)
            if factor
        ]  # fmt: skip
        shift = number(row[3], size)
        terms += [f"{shift:+.{DIGITS}g}"] if shift else []
        rows.append("=" + "".join(terms).removeprefix("+"))
    inner = {"at": {"field": field, "point": rows}}
    return {"scale": {"field": inner, "factor": number(least)}}


def _least_stretch(place, inverse):
    """A number that no length is shrunk below; of axes at right angles it is the least scale.

    The inverse stretches nothing by more than the length of all its entries together.
    """
    if place.straight:
        return min(place.scale)
    rows = [Vector(row[:3]) for row in list(inverse)[:3]]
    return 1 / Vector([row.length for row in rows]).length
