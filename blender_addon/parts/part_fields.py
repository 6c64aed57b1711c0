# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender objects as fields: each kind of object in the words of the scene file."""

from . import curves, mesh_files, primitives
from .part_error import PartError
from .part_properties import NO_KIND
from .transforms import Flat, numbers, placed, take_apart


def object_field(item, frame, warnings, as_feature=False):
    """The field of an object that is no part, in the part's frame. Raises PartError.

    `as_feature`: the distance to a curve or to a mesh's surface, not a solid.
    """
    matrix = frame.matrix(item)
    evaluated = frame.evaluated(item)
    try:
        if item.sardf_primitive.kind != NO_KIND:
            return primitive_field(item, evaluated.sardf_primitive, matrix)
        if item.type == "CURVE":
            if as_feature:
                return curves.line_field(item, _curve(item, evaluated), matrix)
            return curves.swept_field(item, _curve(item, evaluated), matrix, warnings)
        if item.type == "MESH":
            return _mesh(item, evaluated, matrix, "mesh_surface" if as_feature else "mesh_solid")
        if item.type == "EMPTY":
            return {"point": {"at": numbers(matrix.translation)}}
    except Flat:
        raise PartError(
            f"the object '{item.name}' has a scale of 0: it has no inside; give it another scale"
        ) from None
    except ValueError as error:
        raise PartError(f"the {item.sardf_primitive.kind} '{item.name}' {error}") from None
    raise PartError(
        f"'{item.name}' is of the type {item.type}, which stands for no field; accepted are "
        "primitives, meshes, curves, empties and parts"
    )


def primitive_field(item, settings, matrix):
    """The field of a primitive with (evaluated) settings; as primitives.field_of."""
    kind = item.sardf_primitive.kind
    formula = item.sardf_primitive.formula  # text cannot be animated
    return primitives.field_of(kind, values_of(settings, kind), formula, matrix)


def values_of(settings, kind):
    """{word: number} of a primitive's parameters."""
    values = {
        each.word: getattr(settings, primitives.property_name(kind, each.word))
        for each in primitives.KINDS[kind]
    }
    return values | ({"infinite": True} if kind == "cylinder" and settings.infinite else {})


def _curve(item, evaluated):
    """The evaluated curve, or the object's own where modifiers made a mesh of it."""
    return evaluated.data if hasattr(evaluated.data, "splines") else item.data


def _mesh(item, evaluated, matrix, word):
    """Even transforms are said in words, so that a moved mesh needs no new file."""
    if take_apart(matrix).even:
        return placed({word: {"path": mesh_files.write(item, evaluated)}}, matrix)
    return {word: {"path": mesh_files.write(item, evaluated, matrix)}}


def is_feature(item, as_feature):
    """Whether the object's field is a feature and no solid."""
    if item.sardf_primitive.kind != NO_KIND or item.sardf_part.is_part:
        return False
    return item.type == "EMPTY" or (as_feature and item.type in ("CURVE", "MESH"))
