# SPDX-License-Identifier: GPL-3.0-or-later
"""The probe: beside the cursor stands what the part is made of under it."""

import bpy
from bpy_extras.view3d_utils import region_2d_to_origin_3d, region_2d_to_vector_3d

from .. import core, window
from . import preview, preview_legend, preview_reading

BESIDE = 18  # pixels from the cursor


class SARDF_OT_probe(bpy.types.Operator):
    bl_idname = "sardf.probe"
    bl_label = "Probe"
    bl_description = (
        "Show distance, fractions and attributes under the cursor (Esc or right click ends)"
    )

    running = None  # the operator at work, of the session

    @classmethod
    def poll(cls, context):
        return context.scene.sardf_preview.enabled and SARDF_OT_probe.running is None

    def invoke(self, context, event):
        self.lines, self.at = [], (0, 0)
        self._region = None
        add = bpy.types.SpaceView3D.draw_handler_add
        self._handle = add(self._draw, (context,), "WINDOW", "POST_PIXEL")
        SARDF_OT_probe.running = self
        context.window_manager.modal_handler_add(self)
        context.workspace.status_text_set("sardf: probe (Esc ends)")
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.end(context)
            return {"CANCELLED"}
        if SARDF_OT_probe.running is not self or not context.scene.sardf_preview.enabled:
            self.end(context)
            return {"CANCELLED", "PASS_THROUGH"}
        if event.type == "MOUSEMOVE":
            self._look(context, event)
        return {"PASS_THROUGH"}

    def cancel(self, context):
        """Blender ends the operator itself: another file is loaded, or the window closes."""
        self.end(context)

    def end(self, context):
        if self._handle is not None:
            bpy.types.SpaceView3D.draw_handler_remove(self._handle, "WINDOW")
            self._handle = None
            context.workspace.status_text_set(None)
        if SARDF_OT_probe.running is self:
            SARDF_OT_probe.running = None
        window.redraw()

    def _look(self, context, event):
        self.lines, self._region = [], None
        for area in context.screen.areas:
            if area.type != "VIEW_3D":
                continue
            for region in area.regions:
                x, y = event.mouse_x - region.x, event.mouse_y - region.y
                if region.type == "WINDOW" and 0 <= x < region.width and 0 <= y < region.height:
                    self._region, self.at = region.as_pointer(), (x, y)
                    self.lines = read(region, area.spaces.active.region_3d, (x, y))
            area.tag_redraw()

    def _draw(self, context):
        region = bpy.context.region
        if not self.lines or region.as_pointer() != self._region:
            return
        scale = context.preferences.system.ui_scale
        sheet = preview_legend.Sheet(scale)
        line, x = preview_legend.LINE * scale, self.at[0] + BESIDE * scale
        wide = max(preview_legend.width(words, scale) for words in self.lines) + 12 * scale
        height = len(self.lines) * line
        x = min(x, region.width - wide)
        y = max(self.at[1] - BESIDE * scale - height, 4 * scale)
        sheet.rectangle(x - 6 * scale, y - 6 * scale, wide, height + 8 * scale, (0, 0, 0, 0.6))
        for i, words in enumerate(reversed(self.lines)):
            sheet.text(x, y + i * line, words)
        sheet.draw()


def read(region, view, at):
    """The lines about the nearest part under a pixel of a 3-D view; empty where there is none."""
    origin = region_2d_to_origin_3d(region, view, at)
    ray = region_2d_to_vector_3d(region, view, at)
    nearest, found = float("inf"), []
    for part in preview.CURRENT.parts.values():
        if part.scene is None:
            continue
        inverse = part.matrix.inverted_safe()
        shown = part.cut_scene(core.load())
        point = shown.first_point(inverse @ origin, inverse.to_3x3() @ ray)
        if point is None:
            continue
        away = (part.matrix @ type(origin)(point) - origin).length
        if away < nearest:
            nearest, found = away, preview_reading.lines(part.scene, point)
    return found
