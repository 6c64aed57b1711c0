# SPDX-License-Identifier: GPL-3.0-or-later
"""The tab "sardf" in the 3-D viewport's sidebar."""

import bpy

from . import properties, window


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
        texts = (summary.error,) if summary.error else summary.lines
        window.lines(self.layout, texts, alert=bool(summary.error))


def register():
    bpy.utils.register_class(SARDF_PT_main)


def unregister():
    bpy.utils.unregister_class(SARDF_PT_main)
