# SPDX-License-Identifier: GPL-3.0-or-later
"""Does what docs/blender.md says under "The first part", in a window, and leaves its pictures.

Run in an X server: blender --factory-startup -P gui_tour.py -- FOLDER RESULT.json; see
gui_window.py.
"""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from gui_window import addon, drive, open_tab, override, result, screenshot, until, view, wait
from installing import MODULE

LIMIT = 120.0  # seconds to wait for anything at most; llvmpipe on a busy machine is slow
drawn = {"panel": 0, "reference": 0}


def count_draws():
    part = addon("parts.part_panel").SARDF_PT_part
    reference = addon("reference.reference_panel").SARDF_PT_reference_image
    draw_part, draw = part.draw_part, reference.draw

    def counted_part(self, context, shown):
        draw_part(self, context, shown)
        drawn["panel"] += 1

    def counted(self, context):
        draw(self, context)
        drawn["reference"] += 1

    part.draw_part, reference.draw = counted_part, counted


def redrawn(seconds=0.6):
    """Wait until the window was drawn again, with everything that is in it now."""
    view()[1].tag_redraw()
    yield from wait(seconds)
    for _ in range(3):
        yield


def settled():
    """Wait until the preview is sampled finely and drawn."""
    preview = addon("preview.preview")
    preview.collect()
    yield from until(lambda: not preview.CURRENT.busy, "the fine samples", LIMIT)
    yield from redrawn()


def scenario():
    bpy.ops.preferences.addon_enable(module=MODULE)
    bpy.context.preferences.view.smooth_view = 0
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    count_draws()
    yield from first_part()
    yield from preview_of_it()
    yield from cut_open()
    yield from baked()
    yield from compared()


def first_part():
    """A block with a bore, whose edges are arcs, lined."""
    with override():
        bpy.ops.sardf.primitive_add(kind="rounded_box")
        bpy.context.active_object.scale = (2.0, 1.4, 0.8)
        bpy.ops.sardf.primitive_add(kind="cylinder", operation="difference")
        bpy.context.active_object.scale = (0.7, 0.7, 1.2)
        part = bpy.context.active_object.parent
        entry = part.sardf_part.entries[1]
        entry.blend, entry.radius = "sardf", 0.15
        bpy.ops.sardf.preset(choice="lined_bore", depth=0.3)
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_orbit(angle=0.6, type="ORBITUP")
        bpy.ops.view3d.view_orbit(angle=0.5, type="ORBITRIGHT")
    space = view()[1].spaces.active
    space.region_3d.view_perspective = "PERSP"
    space.region_3d.view_location = (0, 0, 0)
    space.region_3d.view_distance = 8
    yield from open_tab(view()[1], lambda: drawn["panel"] > 0, LIMIT)
    yield from redrawn()
    screenshot("tour_1_part")
    result["part"] = [entry.operation for entry in part.sardf_part.entries]
    result["materials"] = [material.name for material in part.sardf_part.materials]


def preview_of_it():
    bpy.context.scene.sardf_preview.enabled = True
    yield from settled()
    screenshot("tour_2_preview")


def cut_open():
    with override():
        bpy.ops.sardf.section_add(kind="plane")
        plane = bpy.context.active_object
        plane.rotation_euler = (1.5708, 0, 0)  # its z axis points to the viewer: -y
    yield from settled()
    screenshot("tour_3_section")


def baked():
    with override():
        bpy.ops.sardf.bake("EXEC_DEFAULT")
    item = next(o for o in bpy.context.scene.objects if o.type == "MESH" and o.data.materials)
    result["faces"] = len(item.data.polygons)
    shading = view()[1].spaces.active.shading
    shading.type, shading.light, shading.color_type = "SOLID", "STUDIO", "TEXTURE"
    yield from settled()
    screenshot("tour_4_bake")


def compared():
    """POV-Ray's picture of the very formula, and how far Cycles' picture of the bake is from it."""
    scene = bpy.context.scene
    scene.sardf_preview.enabled = False
    scene.render.resolution_x, scene.render.resolution_y = 480, 360
    with override():
        bpy.ops.sardf.reference("EXEC_DEFAULT")
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield from redrawn()
    window = bpy.context.window_manager.windows[0]
    areas = [area for area in window.screen.areas if area.type == "VIEW_3D"]
    editor = min(areas, key=lambda area: area.x)
    editor.type = "IMAGE_EDITOR"
    yield from redrawn()
    yield from open_tab(editor, lambda: drawn["reference"] > 0, LIMIT)
    editor.spaces.active.image = addon("reference.pictures").find("reference")
    regions = {region.type: region for region in editor.regions}
    with bpy.context.temp_override(window=window, area=editor, region=regions["WINDOW"]):
        bpy.ops.image.view_all()
    yield from redrawn()
    screenshot("tour_5_reference")
    settings = scene.sardf_reference
    result["reference"] = [settings.intersection_over_union, settings.median, settings.quantile_99]


bpy.context.preferences.view.show_splash = False
drive(scenario(), 0.05)
