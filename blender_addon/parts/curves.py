# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender curves as fields: the distance to them, and the solid that their bevel sweeps."""

from .part_error import PartError
from .transforms import Flat, number, numbers, take_apart


def line_field(item, data, matrix):
    """The distance to a curve object's splines under a 4x4 matrix. Raises PartError."""
    made = [_spline(item, spline, matrix) for spline in data.splines]
    made = [each for each in made if each is not None]
    if not made:
        raise PartError(f"the curve '{item.name}' has no spline of two points or more")
    return made[0] if len(made) == 1 else {"skeleton": {"of": made}}


def swept_field(item, data, matrix, warnings):
    """The points within the curve's bevel depth of it, a solid. Raises PartError."""
    if data.bevel_depth <= 0:
        raise PartError(
            f"the curve '{item.name}' has no bevel depth to be swept by; "
            "give it one, or let it be a feature"
        )
    try:
        place = take_apart(matrix)
    except Flat:
        raise PartError(f"the object '{item.name}' has a scale of 0") from None
    if not place.even:
        warnings.append(
            f"the curve '{item.name}' is scaled unevenly: it is swept by its least scale"
        )
    factor = place.factor if place.even else min(place.scale)
    line = line_field(item, data, matrix)
    distance = number(factor * data.bevel_depth)
    return {"offset": {"field": {"complement": {"field": line}}, "distance": distance}}


def _spline(item, spline, matrix):
    if spline.type == "BEZIER":
        return _bezier(spline, matrix)
    points = [numbers(matrix @ point.co.xyz) for point in spline.points]
    if len(points) < 2:
        return None
    if spline.type == "POLY":
        closed = {"closed": True} if spline.use_cyclic_u else {}
        return {"polyline": {"vertices": points} | closed}
    if spline.point_count_v > 1:
        raise PartError(f"'{item.name}' is a surface of splines, which is not read; curves are")
    return _nurbs(spline, points)


def _nurbs(spline, points):
    degree = min(spline.order_u - 1, len(points) - 1)
    made = {"control_points": points, "degree": degree}
    weights = [point.co.w for point in spline.points]
    if any(abs(weight - weights[0]) > 1e-6 for weight in weights):
        made["weights"] = numbers(weights)
    if spline.use_cyclic_u and len(points) > degree:
        made["closed"] = True
    elif not spline.use_endpoint_u and not spline.use_bezier_u:
        made["knots"] = list(range(len(points) + degree + 1))
    return {"bspline_curve": made}


def _bezier(spline, matrix):
    """Cubic pieces as one B-spline whose inner knots are threefold: the same curve exactly."""
    points = list(spline.bezier_points)
    if len(points) < 2:
        return None
    if spline.use_cyclic_u:
        points.append(points[0])
    controls = [points[0].co]
    for start, end in zip(points, points[1:], strict=False):
        controls += [start.handle_right, end.handle_left, end.co]
    pieces = len(points) - 1
    knots = [0] + [knot for knot in range(pieces + 1) for _ in range(3)] + [pieces]
    return {
        "bspline_curve": {
            "control_points": [numbers(matrix @ control) for control in controls],
            "degree": 3,
            "knots": knots,
        }
    }
