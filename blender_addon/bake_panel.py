# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel "Bake" of the sidebar's tab "sardf": of the active part, or of the scene file."""

import bpy

from . import bake_info, bake_plan, bake_settings, window
from .bake_operator import SARDF_OT_bake
from .baked import clock


class SARDF_PT_bake(bpy.types.Panel):
    bl_idname = "SARDF_PT_bake"
    bl_label = "Bake"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "sardf"
    bl_order = 2

    @classmethod
    def poll(cls, context):
        return bool(context.scene.sardf.filepath) or bake_plan.active_part(context) is not None

    def draw(self, context):
        settings, layout = context.scene.sardf, self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        part = bake_plan.active_part(context)
        name = bpy.path.basename(settings.filepath) if part is None else part.name
        layout.label(text=name, icon="FILE" if part is None else "EMPTY_AXIS")
        info, measuring = bake_info.see(context)
        column = layout.column()
        column.enabled = SARDF_OT_bake.job is None
        if settings.uv_source != bake_settings.EXISTING:
            column.prop(settings, "resolution")
        column.prop(settings, "size")
        self._draw_density(column, context, info)
        column.prop(settings, "sections")
        self._draw_channels(column, settings, info)
        column.prop(settings, "uv_source")
        if settings.uv_source == bake_settings.EXISTING:
            column.prop(settings, "uv_object")
        column.prop(settings, "exact_shading")
        column.prop(settings, "destination")
        if settings.destination == bake_settings.FOLDER:
            column.prop(settings, "folder")
            column.prop(settings, "replace_files")
        column.prop(settings, "tangent_attribute")
        column.prop(settings, "set_units")
        self._draw_cost(layout, context, info, measuring)
        self._draw_bake(layout)
        switch = bake_info.normal_switch(context)
        if switch is not None:
            layout.prop(switch, "default_value", text="Normal Map", slider=True)

    def _draw_density(self, layout, context, info):
        cost = bake_info.cost(context)
        if cost is None:
            return
        per = f"texels per {info.units}"
        row = layout.column(align=True)
        row.label(text=f"about {cost.texels_per_unit:.3g} {per}")
        baked = bake_info.baked_density(context)
        if baked:
            row.label(text=f"baked last: {baked:.3g} {per}")

    def _draw_channels(self, layout, settings, info):
        chosen = bake_settings.names_of(settings.channels)
        known = info.channels if info is not None else {}
        layout.label(text="Channels")
        grid = layout.grid_flow(columns=2, even_columns=True, align=True)
        for name, tip in (known or dict.fromkeys(chosen, "")).items():
            button = grid.operator(
                "sardf.bake_channel", text=name, translate=False, depress=name in chosen
            )
            button.channel, button.tip = name, tip
        missing = [name for name in chosen if known and name not in known]
        if missing:
            window.lines(layout, [f"not here: {', '.join(missing)}"])

    def _draw_cost(self, layout, context, info, measuring):
        if measuring:
            layout.label(text="measuring ...", icon="TIME")
            return
        if info.error:
            window.lines(layout, [info.error], alert=True)
            return
        cost = bake_info.cost(context)
        if cost is not None:
            text = f"about {clock.seconds_text(cost.seconds)}, {clock.bytes_text(cost.bytes)}"
            layout.label(text=text, icon="TIME")

    def _draw_bake(self, layout):
        if SARDF_OT_bake.job is None:
            row = layout.row()
            row.scale_y = 1.5
            row.operator("sardf.bake", icon="TEXTURE")
        elif hasattr(layout, "progress"):  # Blender 4.0 and later
            text = f"{SARDF_OT_bake.watch.stage} (Esc cancels)"
            layout.progress(factor=SARDF_OT_bake.job.share, text=text)
        else:
            layout.label(text=SARDF_OT_bake.watch.stage, icon="TIME")
            layout.label(text=f"{clock.bar(SARDF_OT_bake.job.share)} Esc cancels")


def register():
    bpy.utils.register_class(SARDF_PT_bake)


def unregister():
    bpy.utils.unregister_class(SARDF_PT_bake)
