# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview's part of the tab "sardf", and the buttons in it."""

import bpy

from .. import window
from . import preview, preview_legend, preview_probe


class SARDF_OT_preview_update(bpy.types.Operator):
    bl_idname = "sardf.preview_update"
    bl_label = "Update Preview"
    bl_description = "Show the parts as they are now, and wait for it"

    @classmethod
    def poll(cls, context):
        return context.scene.sardf_preview.enabled

    def execute(self, _context):
        preview.update_now()
        said = "; ".join(preview_legend.messages(preview.CURRENT))
        is_wrong = preview_legend.is_wrong(preview.CURRENT)
        if said:
            self.report({"ERROR"} if is_wrong else {"WARNING"}, said)
        return {"CANCELLED"} if is_wrong else {"FINISHED"}


class SARDF_PT_preview(bpy.types.Panel):
    bl_idname = "SARDF_PT_preview"
    bl_label = "Preview"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "sardf"
    bl_parent_id = "SARDF_PT_main"

    def draw_header(self, context):
        self.layout.prop(context.scene.sardf_preview, "enabled", text="")

    def draw(self, context):
        settings = context.scene.sardf_preview
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.active = settings.enabled
        self._draw_state()
        column = layout.column()
        column.prop(settings, "quality")
        column.prop(settings, "show")
        column.prop(settings, "legend")
        column.prop(settings, "stripes")
        if settings.stripes:
            column.prop(settings, "spacing")
        layout.operator("sardf.probe", icon="EYEDROPPER")

    def _draw_state(self):
        current = preview.CURRENT
        texts = list(preview_legend.messages(current))
        if current.no_gpu and not bpy.app.background:
            texts.append(f"Coarse meshes are shown: {current.no_gpu}")
        window.lines(self.layout, texts, alert=True)


CLASSES = (
    SARDF_OT_preview_update,
    preview_probe.SARDF_OT_probe,
    SARDF_PT_preview,
)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    probe = preview_probe.SARDF_OT_probe.running
    if probe is not None:
        probe.end(bpy.context)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
