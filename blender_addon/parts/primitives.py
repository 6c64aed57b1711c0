# SPDX-License-Identifier: GPL-3.0-or-later
"""The primitives: unit shapes in an object's own frame, and the field that an object's matrix
makes of each.

Sizes come from the object's transform: a sphere has radius 1 in the object's frame, a box and a
cylinder reach from -1 to 1. Only what a transform cannot say is a parameter.
"""

from dataclasses import dataclass

from mathutils import Vector

from .transforms import number, numbers, placed, quaternion_of, take_apart, turned_and_moved


@dataclass(frozen=True)
class Parameter:
    """A number that a primitive has besides its transform.

    `word` is the core's name of it; `absolute`: in scene units, else in the object's own, so that
    it grows with the object.
    """

    word: str
    default: float
    least: float
    absolute: bool = False


# In the order of the menu; the words are the core's constructors, and "formula", which is none.
KINDS = {
    "sphere": (),
    "ellipsoid": (),
    "box": (),
    "rounded_box": (Parameter("radius", 0.25, 1e-6, absolute=True),),
    "cylinder": (),
    "cone": (Parameter("radius_bottom", 1.0, 0.0), Parameter("radius_top", 0.0, 0.0)),
    "torus": (Parameter("major_radius", 1.0, 1e-6), Parameter("minor_radius", 0.25, 1e-6)),
    "capsule": (Parameter("radius", 0.5, 1e-6),),
    "half_space": (),
    "formula": (),
}
NUMBERS = {name: place for place, name in enumerate(KINDS)}  # what Blender stores of the choice


def property_name(kind, word):
    """The property that holds a primitive's parameter: rounded_box's radius is no capsule's."""
    return f"{kind}_{word}"


def field_of(kind, values, formula, matrix):
    """The field of a primitive under a 4x4 matrix, as the scene file says it.

    `values`: {word: number}; a cylinder's "infinite" takes its height away. Raises transforms.Flat,
    and ValueError with a sentence about values that no constructor accepts.
    """
    if kind == "formula":
        text = formula.strip().removeprefix("=").strip()
        if not text:
            raise ValueError("has no formula")
        return placed("=" + text, matrix)
    place = take_apart(matrix)
    if kind == "half_space":
        normal = matrix.to_3x3().inverted().transposed() @ Vector((0, 0, 1))
        return {kind: {"point": numbers(place.origin), "normal": numbers(normal.normalized(), 1.0)}}
    if kind in ("sphere", "ellipsoid"):
        return _ball(kind, place, matrix)
    made = _MAKERS[kind](kind, place, values) if place.straight else None
    return made if made is not None else placed(_unit(kind, values), matrix)


def _unit(kind, values):
    """The primitive in the object's own frame."""
    ends = {"a": [0, 0, -1], "b": [0, 0, 1]}
    sizes = {
        "box": {"size": [2, 2, 2]},
        "rounded_box": {"size": [2, 2, 2]},
        "cylinder": {"radius": 1} if values.get("infinite") else {"radius": 1, "height": 2},
        "cone": {"height": 2},
        "torus": {},
        "capsule": ends,
    }[kind]
    given = {word: number(value) for word, value in values.items() if word != "infinite"}
    return {kind: sizes | given}


def _middle(place):
    """The place of a primitive as its parameter "center", left out at the origin."""
    center = numbers(place.origin, max(*map(abs, place.origin), *place.scale))
    return {"center": center} if any(center) else {}


def _along(place):
    """The parameter "axis", left out along z."""
    axis = numbers(place.axes[2], 1.0)
    return {} if axis == [0, 0, 1] else {"axis": axis}


def _turned(field, place):
    """A field with its center, turned about it. Its shape must be its own mirror image."""
    axes = list(place.axes)
    if place.handed < 0:
        axes[0] = -axes[0]
    turn = quaternion_of(axes)
    if not turn:
        return field
    center = next(iter(field.values())).get("center")
    about = {"center": center} if center else {}
    return {"rotate": {"field": field, "quaternion": turn} | about}


def _ball(kind, place, matrix):
    if place.even and kind == "sphere":
        return {"sphere": _middle(place) | {"radius": number(place.factor)}}
    if not place.straight:
        return placed({"sphere": {"radius": 1}}, matrix)
    return _turned({"ellipsoid": _middle(place) | {"radii": numbers(place.scale)}}, place)


def _block(kind, place, values):
    size = numbers(2 * scale for scale in place.scale)
    inner = _middle(place) | {"size": size}
    if "radius" in values:
        radius = min(values["radius"], min(size) / 2)
        inner["radius"] = number(radius)
    return _turned({kind: inner}, place)


def _round(place):
    """Whether the two scales across z are equal."""
    x, y, _ = place.scale
    return abs(x - y) <= 1e-5 * max(x, y)


def _cylinder(kind, place, values):
    x, y, z = place.scale
    height = {} if values.get("infinite") else {"height": number(2 * z)}
    if _round(place):
        sizes = {"radius": number((x + y) / 2)} | height
        return {kind: _middle(place) | _along(place) | sizes}
    flat = {"ellipse": {"radii": numbers((x, y))}}
    if height:
        flat = {"extrude": {"field": flat} | height}
    axes = list(place.axes)
    if place.handed < 0:
        axes[0] = -axes[0]
    return turned_and_moved(flat, axes, place.origin)


def _cone(kind, place, values):
    if not _round(place):
        return None
    if not any(values.values()):
        raise ValueError("has two radii of 0; one of them must be larger")
    across = (place.scale[0] + place.scale[1]) / 2
    sizes = {word: number(across * value) for word, value in values.items()}
    return {kind: _middle(place) | _along(place) | sizes | {"height": number(2 * place.scale[2])}}


def _torus(kind, place, values):
    if not place.even:
        return None
    if values["minor_radius"] > values["major_radius"]:
        raise ValueError("has a minor_radius larger than its major_radius")
    sizes = {word: number(place.factor * value) for word, value in values.items()}
    return {kind: _middle(place) | _along(place) | sizes}


def _capsule(kind, place, values):
    if not _round(place):
        return None
    reach = place.axes[2] * place.scale[2]
    size = max(*map(abs, place.origin), place.scale[2])
    a, b = numbers(place.origin - reach, size), numbers(place.origin + reach, size)
    across = (place.scale[0] + place.scale[1]) / 2
    return {kind: {"a": a, "b": b, "radius": number(across * values["radius"])}}


_MAKERS = {
    "box": _block,
    "rounded_box": _block,
    "cylinder": _cylinder,
    "cone": _cone,
    "torus": _torus,
    "capsule": _capsule,
}
