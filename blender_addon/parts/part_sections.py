# SPDX-License-Identifier: GPL-3.0-or-later
"""The sections that cut a part open: as the scene file says them, and where they are bounded by
planes, as these.

`builder` is the part_scene builder at work, which knows matrices and fields.
"""

from dataclasses import dataclass, field

from mathutils import Vector

from . import primitives
from .part_error import PartError
from .part_frame import with_values
from .part_properties import NO_KIND
from .part_text import json_from
from .transforms import is_flat

# Planes (a, b, c, d) in the frames of shapes: inside, a x + b y + c z + d > 0 for all of them.
SIDES = {
    "half_space": ((0, 0, 1, 0),),
    "box": ((1, 0, 0, 1), (-1, 0, 0, 1), (0, 1, 0, 1), (0, -1, 0, 1), (0, 0, 1, 1), (0, 0, -1, 1)),
}


@dataclass
class Cut:
    """What one section of the scene file removes.

    `section`: its words there. `planes`: (a, b, c, d) of the part's coordinates; what has
    a x + b y + c z + d > 0 for all of them is removed; empty where more than planes bound it.
    `moves`: (object, unit vector) of each section object in it; the piece that it takes off may be
    moved that way.
    """

    section: dict
    planes: tuple = ()
    moves: list = field(default_factory=list)


def cuts_of(builder, settings, evaluated):
    """A Cut for each section of a part's own list, joined where they cut together."""
    made = []
    for item, values in with_values(settings.sections, evaluated.sections):
        cut = None if values.mute else _cut(builder, item)
        if cut is None:
            continue
        if item.operation == "intersection" and made:
            made[-1] = _joined(made[-1], cut)
        else:
            made.append(cut)
    return made


def cuts_of_all(builder, settings):
    """A Cut for each object of the scene that cuts all parts, but for those of the part's list."""
    if not settings.scene_sections:
        return []
    listed = {item.object for item in settings.sections}
    found = []
    for item in builder.depsgraph.scene.original.objects:
        if is_for_all(item) and item not in listed and item != builder.part:
            found += [] if _is_muted(builder, item) else [_object_cut(builder, item, ())]
    return found


def is_for_all(item):
    return item.sardf_section.is_section and item.sardf_section.everywhere


def kind_of(item):
    """The shape that a section's object stands for; a plain Empty is a half space."""
    kind = item.sardf_primitive.kind
    return "half_space" if kind == NO_KIND and item.type == "EMPTY" else kind


def _is_muted(builder, item):
    return builder.frame.evaluated(item).sardf_section.mute


def _cut(builder, item):
    """The Cut of an item of the list; None where it cuts nothing, of which it warns."""
    if item.object is None:
        if item.text:
            return Cut(json_from(item.text, f"the section '{item.name}'"))
        builder.warnings.append(f"the section '{item.name}' has no object: it cuts nothing")
        return None
    if not builder.is_there(item.object):
        builder.warnings.append(f"the object of the section '{item.name}' was deleted")
        return None
    if _is_muted(builder, item.object):
        return None
    keep = [name.strip() for name in item.keep.split(",") if name.strip()]
    return _object_cut(builder, item.object, keep)


def _object_cut(builder, item, keep):
    section = {"remove": None} | ({"keep": list(keep)} if keep else {})
    if item.sardf_part.is_part:
        return Cut(section | {"remove": builder.part_field(item, item.name)})
    matrix = builder.frame.matrix(item)
    if is_flat(matrix):
        raise PartError(f"the section '{item.name}' has a scale of 0; give it another scale")
    kind = kind_of(item)
    if kind not in SIDES:
        way = matrix.col[2].xyz.normalized()
        section["remove"] = builder.object_field(item, as_feature=False)
        return Cut(section, moves=[(item, way)])
    section["remove"] = primitives.field_of(kind, {}, "", matrix)
    planes = _planes(kind, matrix)
    way = planes[0][:3] if kind == "half_space" else matrix.col[2].xyz
    return Cut(section, () if keep else planes, [(item, Vector(way).normalized())])


def _planes(kind, matrix):
    back = matrix.inverted().transposed()
    return tuple(tuple(back @ Vector(side)) for side in SIDES[kind])


def planes_in(scene, depsgraph, matrix):
    """The planes of each object that cuts all parts, as Cut has them, of the coordinates that
    `matrix` takes to the world: for what is shown without a part. What is no plane or box, or flat,
    is left out."""
    found = []
    for item in filter(is_for_all, scene.objects):
        evaluated = item.evaluated_get(depsgraph)
        place = matrix.inverted_safe() @ evaluated.matrix_world
        if kind_of(item) in SIDES and not evaluated.sardf_section.mute and not is_flat(place):
            found.append(_planes(kind_of(item), place))
    return tuple(found)


def _joined(first, second):
    """The Cut that removes only what both remove; it keeps what one of them keeps."""
    removed = [cut.section["remove"] for cut in (first, second)]
    keep = [*first.section.get("keep", ()), *second.section.get("keep", ())]
    section = {"remove": {"intersection": {"of": removed}}} | ({"keep": keep} if keep else {})
    is_flat = first.planes and second.planes
    return Cut(section, first.planes + second.planes if is_flat else (), first.moves + second.moves)
