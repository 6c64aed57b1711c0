# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab "sardf" in the 3-D viewport's sidebar."""

import textwrap

import bpy

from . import operators, properties

LINE = 28  # characters that fit into the sidebar at its default width


class SARDF_PT_main(bpy.types.Panel):
    bl_idname = "SARDF_PT_main"
    bl_label = "File"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "sardf"

    def draw(self, context):
        settings = context.scene.sardf
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.operator("sardf.load", icon="FILE_FOLDER")
        layout.prop(settings, "filepath", text="File")
        self._draw_summary(settings)
        column = layout.column()
        column.enabled = operators.SARDF_OT_bake.job is None
        column.prop(settings, "resolution")
        column.prop(settings, "size")
        column.prop(settings, "sections")
        column.prop(settings, "tangent_attribute")
        column.prop(settings, "set_units")
        self._draw_bake()
        column = layout.column()
        column.prop(settings, "samples")
        column.prop(settings, "studio")
        column.operator("sardf.render", icon="RENDER_STILL")

    def _draw_summary(self, settings):
        summary = properties.summary(settings)
        if summary is None:
            return
        column = self.layout.column(align=True)
        column.alert = bool(summary.error)
        for text in (summary.error,) if summary.error else summary.lines:
            for row in textwrap.wrap(text, LINE, break_long_words=True):
                column.label(text=row)

    def _draw_bake(self):
        bake = operators.SARDF_OT_bake
        if bake.job is None:
            row = self.layout.row()
            row.scale_y = 1.5
            row.operator("sardf.bake", icon="TEXTURE")
        elif hasattr(self.layout, "progress"):  # Blender 4.0 and later
            self.layout.progress(factor=bake.job.share, text=f"{bake.stage} (Esc cancels)")
        else:
            self.layout.label(text=f"{bake.stage} (Esc cancels)", icon="TIME")


def register():
    bpy.utils.register_class(SARDF_PT_main)


def unregister():
    bpy.utils.unregister_class(SARDF_PT_main)
