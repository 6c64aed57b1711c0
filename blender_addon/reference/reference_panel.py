# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Reference" in the sidebars of the 3-D viewport and of the Image Editor."""

from typing import ClassVar

import bpy

from .. import window
from . import pictures, reference_operators


class _Panel:
    bl_label = "Reference"
    bl_region_type = "UI"
    bl_category = "sardf"

    def draw(self, context):
        settings = context.scene.sardf_reference
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column()
        column.enabled = reference_operators.SARDF_OT_reference.work is None
        column.prop(settings, "look")
        column.prop(settings, "light_samples", text="Lights")
        column.prop(settings, "compare", text="Compare")
        more = column.column()
        more.enabled = settings.compare
        more.prop(settings, "keep_cycles", text="Keep Cycles")
        more.prop(settings, "samples", text="Samples")
        self._draw_button()
        self._draw_pictures()
        self._draw_numbers(settings)

    def _draw_button(self):
        running = reference_operators.SARDF_OT_reference
        if running.work is None:
            self.layout.operator("sardf.reference", icon="RENDER_STILL")
        elif hasattr(self.layout, "progress"):  # Blender 4.0 and later
            self.layout.progress(
                factor=running.work.share, text=f"{running.watch.stage} (Esc cancels)"
            )
        else:
            self.layout.label(text=f"{running.watch.stage} (Esc cancels)", icon="TIME")

    def _draw_pictures(self):
        row = self.layout.row(align=True)
        for kind, text in (("reference", "POV-Ray"), ("cycles", "Cycles"), ("difference", "×16")):
            if pictures.find(kind) is not None:
                row.operator("sardf.reference_show", text=text).kind = kind

    def _draw_numbers(self, settings):
        column = self.layout.column(align=True)
        if settings.compared:
            column.label(text=f"{settings.compared}, {settings.compared_pixels} pixels")
            column.label(text=f"mask IoU {settings.intersection_over_union:.5f}")
            column.label(text=f"median {settings.median:.2f}/255")
            column.label(text=f"99 % {settings.quantile_99:.2f}/255")
        window.lines(column, settings.warnings.splitlines())


class SARDF_PT_reference(_Panel, bpy.types.Panel):
    bl_idname = "SARDF_PT_reference"
    bl_space_type = "VIEW_3D"
    bl_options: ClassVar[set] = {"DEFAULT_CLOSED"}
    bl_order = 3


class SARDF_PT_reference_image(_Panel, bpy.types.Panel):
    bl_idname = "SARDF_PT_reference_image"
    bl_space_type = "IMAGE_EDITOR"


CLASSES = (SARDF_PT_reference, SARDF_PT_reference_image)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
