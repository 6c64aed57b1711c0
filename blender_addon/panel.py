# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab "sardf" in the 3-D viewport's sidebar."""

import textwrap

import bpy

from . import properties

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


def register():
    bpy.utils.register_class(SARDF_PT_main)


def unregister():
    bpy.utils.unregister_class(SARDF_PT_main)
