# SPDX-License-Identifier: GPL-3.0-or-later
"""Section planes and boxes: wireframes that cut parts open, wherever they are moved."""

import math
from typing import ClassVar

import bpy
from mathutils import Matrix, Vector

from . import part_lists, part_objects
from .part_error import PartError
from .part_frame import objects_in_scenes
from .reporting import Reporting

COLOR = (1.0, 0.6, 0.1, 1.0)
KINDS = {  # kind -> (shape, title, tooltip)
    "plane": ("half_space", "Section Plane", "Cut away what the arrow of a plane points to"),
    "box": ("box", "Section Box", "Cut away what is in a box"),
}


def mark(item):
    """Make an object a section."""
    item.sardf_section.is_section = True
    item.color = COLOR
    item.hide_render = True


def new_section(kind, collection, matrix):
    """A new section object of KINDS at a world matrix."""
    shape, title, _ = KINDS[kind]
    item = part_objects.new_primitive(shape, title, collection, matrix)
    mark(item)
    return item


def add_to_part(part, item):
    """List a section object in a part, which moves it along from now on."""
    section = part.sardf_part.sections.add()
    section.name, section.object = item.name, item
    part.sardf_part.section_index = len(part.sardf_part.sections) - 1
    part_objects.adopt(part, item)
    part.update_tag()
    return section


def bounds(part):
    """Lowest and highest corner, in the part's frame, of the objects that make its solid."""
    there = objects_in_scenes()
    items = [entry.object for entry in part.sardf_part.entries if entry.operation != "none"]
    items = [i for i in items if i is not None and i.as_pointer() in there and i.type != "EMPTY"]
    back = part_objects.world_of(part).inverted_safe()
    corners = [
        back @ part_objects.world_of(item) @ Vector(corner)
        for item in items for corner in item.bound_box
    ] or [Vector((-1, -1, -1)), Vector((1, 1, 1))]  # fmt: skip
    axes = range(3)
    return (Vector([min(c[axis] for c in corners) for axis in axes]),
            Vector([max(c[axis] for c in corners) for axis in axes]))  # fmt: skip


def size_of(part):
    """Half of the longest side of the part's bounds, and a little more."""
    low, high = bounds(part)
    return 0.6 * max(*(high - low), 1e-3)


def _start(kind, part):
    """Where a new section stands, in the part's frame: it takes away the front, or a corner."""
    low, high = bounds(part)
    middle = (low + high) / 2
    if kind == "plane":
        turn = Matrix.Rotation(math.pi / 2, 4, "X")  # its z axis points to the front
        return Matrix.Translation(middle) @ turn @ Matrix.Scale(size_of(part), 4)
    half = 0.5 * size_of(part) * Vector((2, 2, 2))
    corner = Vector((1, -1, 1))
    center = middle + Vector([h * c for h, c in zip(half, corner, strict=True)])
    return Matrix.Translation(center) @ Matrix.Diagonal((*half, 1))


class SARDF_OT_section_add(Reporting, bpy.types.Operator):
    bl_idname = "sardf.section_add"
    bl_label = "Add Section"
    bl_options: ClassVar[set] = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(
        name="Kind", description="What is cut away",
        items=[(kind, title, text) for kind, (_, title, text) in KINDS.items()],
    )  # fmt: skip
    everywhere: bpy.props.BoolProperty(
        name="All Parts",
        description="Cut all parts of the scene; otherwise, and if there is one, the active part",
    )

    @classmethod
    def description(cls, _context, properties):
        return KINDS[properties.kind][2]

    def run(self, context):
        part = part_objects.outermost(part_objects.part_of(context.active_object))
        if part is None:
            matrix = Matrix.Translation(context.scene.cursor.location)
            if self.kind == "plane":
                matrix = matrix @ Matrix.Rotation(math.pi / 2, 4, "X")
        else:
            matrix = part_objects.world_of(part) @ _start(self.kind, part)
        item = new_section(self.kind, context.collection, matrix)
        if self.everywhere or part is None or part.library is not None:
            item.sardf_section.everywhere = True
        else:
            context.view_layer.update()
            add_to_part(part, item)
        part_objects.activate(context, item)


class SARDF_OT_section_list(Reporting, bpy.types.Operator):
    bl_idname = "sardf.section_list"
    bl_label = "List in Part"
    bl_options: ClassVar[set] = {"REGISTER", "UNDO", "INTERNAL"}
    bl_description = "List a section of all parts in this one, where it can be muted or keep fields"

    name: bpy.props.StringProperty(name="Object", description="The section's object")

    def run(self, context):
        part = part_lists.editable_part(context)
        item = context.scene.objects.get(self.name)
        if item is None:
            raise PartError(f"there is no object '{self.name}' in the scene")
        section = part.sardf_part.sections.add()
        section.name, section.object = item.name, item
        part.sardf_part.section_index = len(part.sardf_part.sections) - 1


CLASSES = (SARDF_OT_section_add, SARDF_OT_section_list)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
