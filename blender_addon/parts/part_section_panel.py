# SPDX-License-Identifier: GPL-3.0-or-later
"""The sections of the active part, and the active section object, in the sidebar."""

from typing import ClassVar

import bpy

from . import part_objects, part_sections
from .part_panel import ListPanel, chosen, draw_list


class SARDF_PT_sections(ListPanel, bpy.types.Panel):
    bl_idname = "SARDF_PT_sections"
    bl_label = "Sections"
    bl_options: ClassVar[set] = {"DEFAULT_CLOSED"}

    def draw_part(self, context, part):
        layout, settings = self.layout, part.sardf_part
        row = layout.row(align=True)
        for kind, icon in (("plane", "MESH_PLANE"), ("box", "MESH_CUBE")):
            row.operator("sardf.section_add", text=kind.title(), icon=icon).kind = kind
        draw_list(layout, "SARDF_UL_named", part, "sections")
        section = chosen(settings.sections, settings.section_index)
        if section is not None:
            column = layout.column()
            column.prop(section, "object")
            if settings.section_index > 0:
                column.prop(section, "operation")
            column.prop(section, "keep" if section.object else "text")
            if section.object is not None:
                column.prop(section.object.sardf_section, "spread")
        layout.operator("sardf.bake_pieces", icon="MOD_EXPLODE")
        self._draw_of_all(context, settings)

    def _draw_of_all(self, context, settings):
        listed = {section.object for section in settings.sections}
        of_all = [i for i in context.scene.objects if part_sections.is_for_all(i)]
        if not of_all:
            return
        column = self.layout.column()
        column.prop(settings, "scene_sections")
        for item in of_all if settings.scene_sections else ():
            if item not in listed:
                row = column.row()
                row.label(text=item.name, icon="WORLD")
                row.operator("sardf.section_list", text="", icon="ADD").name = item.name


class SARDF_PT_section_object(bpy.types.Panel):
    bl_idname = "SARDF_PT_section_object"
    bl_label = "Section"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "sardf"
    bl_order = 2

    @classmethod
    def poll(cls, context):
        item = context.active_object
        return item is not None and item.sardf_section.is_section

    def draw(self, context):
        layout, item = self.layout, context.active_object
        layout.use_property_split = True
        for name in ("everywhere", "mute", "spread"):
            layout.prop(item.sardf_section, name)
        parts = part_objects.parts(context.scene)
        cut = [p.name for p in parts if any(s.object == item for s in p.sardf_part.sections)]
        if not item.sardf_section.everywhere:
            layout.label(text=f"cuts {', '.join(cut)}" if cut else "is listed in no part")


CLASSES = (SARDF_PT_sections, SARDF_PT_section_object)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
