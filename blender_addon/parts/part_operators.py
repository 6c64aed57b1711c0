# SPDX-License-Identifier: GPL-3.0-or-later
"""Making parts and primitives, presets, and parts from and to scene files."""

from typing import ClassVar

import bpy
from bpy_extras.io_utils import ExportHelper, ImportHelper

from .. import core
from . import (
    part_export,
    part_import,
    part_objects,
    part_presets,
    part_properties,
    part_status,
    primitives,
)
from .part_error import PartError
from .part_lists import add_selected, editable_part
from .reporting import Reporting


class SARDF_OT_part_new(Reporting, bpy.types.Operator):
    bl_idname = "sardf.part_new"
    bl_label = "New Part"
    bl_options: ClassVar[set] = {"REGISTER", "UNDO"}
    bl_description = "Make a part, with the selected objects as its entries"

    from_selection: bpy.props.BoolProperty(
        name="From Selection", description="Make the selected objects its entries", default=True
    )

    def run(self, context):
        chosen = list(context.selected_objects) if self.from_selection else []
        place = part_objects.middle(chosen) if chosen else context.scene.cursor.location
        part = part_objects.new_part("Part", context.collection, place)
        # The active object first: what is selected after it is joined to it.
        chosen.sort(key=lambda item: item != context.active_object)
        context.view_layer.update()
        for item in chosen:
            part_objects.add_entry(part, item)
        part_objects.activate(context, part)


class SARDF_OT_primitive_add(Reporting, bpy.types.Operator):
    bl_idname = "sardf.primitive_add"
    bl_label = "Add Primitive"
    bl_options: ClassVar[set] = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(
        name="Shape", description="Which field the object stands for",
        items=[(kind, part_properties.title_of(kind), part_properties.kind_text(kind))
               for kind in primitives.KINDS],
    )  # fmt: skip
    operation: bpy.props.EnumProperty(
        name="Operation", description="How it joins the active part",
        items=[(name, name.title(), f"As {name}") for name in part_properties.OPERATIONS],
    )  # fmt: skip

    @classmethod
    def description(cls, _context, properties):
        return part_properties.kind_text(properties.kind)

    def run(self, context):
        part = part_objects.part_of(context.active_object)
        if part is not None and part.library is not None:
            part = None
        name = part_properties.title_of(self.kind)
        item = part_objects.new_primitive(self.kind, name, context.collection)
        item.location = context.scene.cursor.location
        if part is None:
            part = part_objects.new_part("Part", context.collection, item.location)
        context.view_layer.update()
        part_objects.add_entry(part, item, self.operation)
        part_objects.activate(context, item)


class SARDF_OT_entries_add(Reporting, bpy.types.Operator):
    bl_idname = "sardf.entries_add"
    bl_label = "Add Selected"
    bl_options: ClassVar[set] = {"REGISTER", "UNDO"}
    bl_description = "Make the selected objects entries of the active object's part"

    def run(self, context):
        part = editable_part(context)
        count = add_selected(context, part)
        self.report({"INFO"}, f"{count} added to '{part.name}'")


class SARDF_OT_part_remove(Reporting, bpy.types.Operator):
    bl_idname = "sardf.part_remove"
    bl_label = "Remove Part"
    bl_options: ClassVar[set] = {"REGISTER", "UNDO"}
    bl_description = "Remove the active object's part with all objects under it"

    def run(self, context):
        part_objects.remove_part(editable_part(context))


class SARDF_OT_preset(Reporting, bpy.types.Operator):
    bl_idname = "sardf.preset"
    bl_label = "Material Preset"
    bl_options: ClassVar[set] = {"REGISTER", "UNDO"}
    bl_description = "Replace the part's features by a common distribution of materials"

    choice: bpy.props.EnumProperty(
        name="Preset", description="Which distribution",
        items=[(k, p.title, p.description) for k, p in part_presets.PRESETS.items()],
    )  # fmt: skip
    depth: bpy.props.FloatProperty(
        name="Depth", description="How deep it reaches from the surface, in scene units",
        default=0.3, min=1e-6,
    )  # fmt: skip
    faces: bpy.props.StringProperty(
        name="Faces", description="Numbers of faces that are hardened; empty: all of them"
    )

    @classmethod
    def description(cls, _context, properties):
        return part_presets.PRESETS[properties.choice].description

    def run(self, context):
        faces = self.faces if self.choice == "hardened_faces" else ""
        part_presets.apply(editable_part(context), self.choice, self.depth, faces)


class SARDF_OT_part_import(Reporting, bpy.types.Operator, ImportHelper):
    bl_idname = "sardf.part_import"
    bl_label = "Import sardf Scene"
    bl_options: ClassVar[set] = {"REGISTER", "UNDO"}
    bl_description = "Make a part of a scene file, with objects for its primitives"

    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN"})

    def run(self, context):
        part = part_import.import_scene(core.load(), self.filepath, context)
        part_objects.activate(context, part)


class SARDF_OT_part_export(Reporting, bpy.types.Operator, ExportHelper):
    bl_idname = "sardf.part_export"
    bl_label = "Export sardf Scene"
    bl_options: ClassVar[set] = {"REGISTER"}
    bl_description = "Write the active object's part as a scene file"

    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="*.json", options={"HIDDEN"})

    def run(self, context):
        part = part_objects.outermost(part_objects.part_of(context.active_object))
        if part is None:
            raise PartError("no part is active; select one")
        warnings = part_export.write(part, self.filepath, context.evaluated_depsgraph_get())
        for text in warnings:
            self.report({"WARNING"}, text)


class SARDF_OT_part_check(Reporting, bpy.types.Operator):
    bl_idname = "sardf.part_check"
    bl_label = "Check Part"
    bl_description = "Let the core read the part: whether its distances are exact, and warnings"

    def run(self, context):
        part = part_objects.outermost(part_objects.part_of(context.active_object))
        if part is None:
            raise PartError("no part is active; select one")
        for text in part_status.check(core.load(), part, context.evaluated_depsgraph_get()):
            self.report({"INFO"}, text)


CLASSES = (
    SARDF_OT_part_new,
    SARDF_OT_primitive_add,
    SARDF_OT_entries_add,
    SARDF_OT_part_remove,
    SARDF_OT_preset,
    SARDF_OT_part_import,
    SARDF_OT_part_export,
    SARDF_OT_part_check,
)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
