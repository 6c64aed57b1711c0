# SPDX-License-Identifier: GPL-3.0-or-later
"""Making parts, primitives and entries, and finding the part that an object belongs to."""

import bpy
from mathutils import Vector

from . import part_properties, wireframes
from .part_fields import values_of

DRAWN = "sardf_drawn"  # custom property of a mesh: the primitive that its edges draw, as text
COLORS = {"union": (0.35, 0.55, 0.9, 1), "intersection": (0.4, 0.8, 0.4, 1),
          "difference": (0.9, 0.35, 0.3, 1), "none": (0.6, 0.6, 0.6, 1)}  # fmt: skip


def new_part(name, collection, origin=(0.0, 0.0, 0.0)):
    """A new Empty that is a part without entries."""
    part = bpy.data.objects.new(name, None)
    part.empty_display_type = "PLAIN_AXES"
    part.location = origin
    settings = part.sardf_part
    settings.is_part = True
    settings.version = part_properties.VERSION
    collection.objects.link(part)
    return part


def new_primitive(kind, name, collection, matrix=None, **values):
    """A new wireframe object of a primitive; `values` are properties of sardf_primitive."""
    item = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    item.display_type = "WIRE"
    item.hide_render = True
    settings = item.sardf_primitive
    settings.kind = kind
    for key, value in values.items():
        setattr(settings, key, value)
    if matrix is not None:
        item.matrix_world = matrix
    collection.objects.link(item)
    draw(item)
    return item


def draw(item, settings=None):
    """Make the object's edges those of its primitive, or of other `settings` of one. Linked meshes
    stay as they are."""
    kind = item.sardf_primitive.kind
    mesh = item.data
    if kind == part_properties.NO_KIND or item.type != "MESH" or mesh.library is not None:
        return
    values = values_of(settings or item.sardf_primitive, kind)
    points, edges = wireframes.outline(kind, values)
    mesh.clear_geometry()
    mesh.from_pydata([tuple(map(float, point)) for point in points], edges, [])
    mesh.update()
    mesh[DRAWN] = _text_of(kind, values)


def is_drawn(item, settings):
    """Whether the object's edges are those of its primitive with these settings."""
    kind = item.sardf_primitive.kind
    return item.data.get(DRAWN) == _text_of(kind, values_of(settings, kind))


def _text_of(kind, values):
    return " ".join([kind, *(f"{name}={value}" for name, value in values.items())])


def add_entry(part, item, operation="union", name="", **more):
    """A new entry for an object at the end of a part's list; the object becomes its child."""
    settings = part.sardf_part
    entry = settings.entries.add()
    entry.name = name or item.name
    entry.object = item
    entry.operation = operation
    for key, value in more.items():
        setattr(entry, key, value)
    if item.type == "CURVE" and item.data.bevel_depth == 0:
        entry.as_feature = True
    if item.type == "EMPTY" and not item.sardf_part.is_part or entry.as_feature:
        entry.operation = "none"
    if item.sardf_primitive.kind != part_properties.NO_KIND and item.library is None:
        item.color = COLORS[entry.operation]
    settings.entry_index = len(settings.entries) - 1
    adopt(part, item)
    part.update_tag()
    return entry


def adopt(part, item):
    """Parent an object that has no parent to the part, where it stands."""
    if item.parent is None and item.library is None and not _is_under(part, item):
        item.parent = part
        item.matrix_parent_inverse = world_of(part).inverted_safe()


def _is_under(item, ancestor):
    while item is not None:
        if item == ancestor:
            return True
        item = item.parent
    return False


def world_of(item):
    """The object's matrix as its own values say now, which need not be evaluated yet."""
    if item.parent is None or item.parent_type != "OBJECT" or len(item.constraints):
        return item.matrix_world.copy() if item.parent else item.matrix_basis.copy()
    return world_of(item.parent) @ item.matrix_parent_inverse @ item.matrix_basis


def is_part(item):
    return item is not None and item.sardf_part.is_part


def parts(scene):
    """The parts of a scene, in its order."""
    return [item for item in scene.objects if item.sardf_part.is_part]


def part_of(item):
    """The part that an object is, or is in, or None. A part inside a part is its own."""
    above = part_above(item)
    if item is None or above is not None:
        return above
    for part in bpy.data.objects:
        if part.sardf_part.is_part and any(e.object == item for e in part.sardf_part.entries):
            return part
    return None


def part_above(item):
    """The part that an object is, or stands under, or None."""
    while item is not None and not is_part(item):
        item = item.parent
    return item


def outermost(part):
    """The part that contains a part, and so on up; itself where none does. None gives None."""
    seen = {part}
    while part is not None:
        above = next(
            (
                each for each in bpy.data.objects
                if each.sardf_part.is_part and each not in seen
                and any(entry.object == part for entry in each.sardf_part.entries)
            ),
            None,
        )  # fmt: skip
        if above is None:
            return part
        seen.add(above)
        part = above
    return None


def remove_part(part):
    """Remove a part with all objects under it, and their meshes and curves if nothing else uses
    them."""
    items = [part, *part.children_recursive]
    data = [item.data for item in items if item.data is not None]
    bpy.data.batch_remove(items)
    for each in data:
        try:
            unused = each.users == 0
        except ReferenceError:  # shared with another, and gone with it
            continue
        if unused:
            bpy.data.batch_remove([each])


def activate(context, item):
    """Select an object alone and make it the active one."""
    for other in context.selected_objects:
        other.select_set(False)
    if item.name in context.view_layer.objects:
        item.select_set(True)
        context.view_layer.objects.active = item


def middle(items):
    """The mean of some objects' places."""
    if not items:
        return Vector()
    return sum((world_of(item).translation for item in items), Vector()) / len(items)


def register():
    part_properties.on_shape_change(draw)


def unregister():
    part_properties.on_shape_change(None)
