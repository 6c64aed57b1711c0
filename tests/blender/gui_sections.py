# SPDX-License-Identifier: GPL-3.0-or-later
"""Moves section objects in a window, and watches the preview:
blender --factory-startup -P gui_sections.py -- ADDON_FOLDER SCENE.json FOLDER RESULT.json; see
gui_window.py. SCENE is a ball of radius 5.
"""

import sys
import time
from pathlib import Path

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Euler, Vector

sys.path.insert(0, str(Path(__file__).resolve().parent))
import addon_folder
import gui_window
from gui_window import addon, drive, override, pixel, result, screenshot, view, wait

ADDON, SCENE = sys.argv[-4:-2]
LIMIT = 90.0  # seconds for anything at most
GRID = [n / 2 for n in range(-8, 9)]
draws = [0]


def until(condition, what):
    return gui_window.until(condition, what, LIMIT)


def note_draws():
    preview = addon("preview.preview")
    original = preview.Preview.draw

    def draw(self, context):
        original(self, context)
        draws[0] += 1

    preview.Preview.draw = draw


def settled():
    """Wait until what there is now is sampled finely and drawn."""
    preview = addon("preview.preview")
    yield
    preview.collect()
    yield from until(lambda: not preview.CURRENT.busy, "the fine samples")
    for _ in range(2):
        yield
        before = draws[0]
        view()[1].tag_redraw()
        yield from until(lambda before=before: draws[0] > before, "a redraw")
    yield


def look(direction):
    """From a direction, given as angles about x, y and z, at the middle."""
    space = view()[1].spaces.active
    region = space.region_3d
    region.view_perspective = "ORTHO"
    region.view_rotation = Euler(direction).to_quaternion()
    region.view_location, region.view_distance = (0, 0, 0), 22
    overlay = space.overlay
    overlay.show_floor = overlay.show_axis_x = overlay.show_axis_y = overlay.show_cursor = False
    overlay.show_relationship_lines = overlay.show_extras = False
    space.show_gizmo = False


def part():
    return addon("parts.part_objects").parts(bpy.context.scene)[0]


def add_section(kind):
    with override():
        bpy.context.view_layer.objects.active = part()
        bpy.ops.sardf.section_add(kind=kind)
        item = bpy.context.active_object
        item.hide_set(True)  # its lines are not in the way
    return item


def scenario():
    bpy.context.preferences.view.smooth_view = 0
    bpy.context.preferences.system.viewport_aa = "OFF"
    note_draws()
    with override():
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.object.delete()
        bpy.ops.sardf.part_import(filepath=SCENE)
    for item in part().children_recursive:
        item.hide_set(True)
    bpy.context.scene.sardf_preview.enabled = True
    yield from plane_moves()
    yield from box_cuts()
    yield from corner()
    yield from wires()
    yield from apart()


def plane_moves():
    preview = addon("preview.preview")
    look((1.5707963, 0, 0))
    plane = add_section("plane")
    yield from settled()
    wish = preview.CURRENT.parts[part().name].wish
    result["planes"] = {}
    for y in (0.0, -2.0, 3.0):
        plane.location.y = y
        begun = time.monotonic()
        yield from settled()
        name = f"section_plane_{y:g}"
        screenshot(name)
        points = [(x, y, z) for x in GRID for z in GRID if Vector((x, y, z)).length < 4.8]
        result["planes"][name] = [[p, pixel(p)] for p in points]
        result["seconds"] = time.monotonic() - begun
        result["probed"] = probed((1, y, 0.5))
    result["sampled again"] = preview.CURRENT.parts[part().name].wish is not wish
    plane.location.y = 50
    yield from settled()
    screenshot("section_nothing")
    result["nothing"] = [pixel((0, 0, 0)), preview.CURRENT.parts[part().name].note]
    remove(plane)


def probed(point):
    """What the probe says of the pixel that a point is seen at."""
    preview_probe = addon("preview.preview_probe")
    _, area, regions = view()
    region, view_3d = regions["WINDOW"], area.spaces.active.region_3d
    return preview_probe.read(region, view_3d, location_3d_to_region_2d(region, view_3d, point))


def remove(item):
    bpy.data.meshes.remove(item.data)
    part().sardf_part.sections.clear()


def box_cuts():
    """From above right in front, into the corner that a turned box takes away."""
    look((0.9, 0, 0.7))
    box = add_section("box")
    box.location, box.scale, box.rotation_euler.z = (3, -3, 3), (3, 3, 3), 0.0
    yield from settled()
    screenshot("section_box")
    grid = [g for g in GRID if g > 0.2]
    faces = {
        "x": [(0, -a, b) for a in grid for b in grid],
        "y": [(a, 0, b) for a in grid for b in grid],
        "z": [(a, -b, 0) for a in grid for b in grid],
    }
    result["box"] = {axis: [[p, pixel(p)] for p in points if Vector(p).length < 4.7]
                     for axis, points in faces.items()}  # fmt: skip
    remove(box)


def corner():
    """The same corner by three planes that cut together."""
    turns = ((1.5707963, 0, 0), (0, 1.5707963, 0), (0, 0, 0))
    for turn in turns:
        add_section("plane").rotation_euler = turn
    for section in part().sardf_part.sections[1:]:
        section.operation = "intersection"
    yield from settled()
    screenshot("section_corner")
    for item in [section.object for section in part().sardf_part.sections]:
        bpy.data.meshes.remove(item.data)
    part().sardf_part.sections.clear()


def wires():
    """A driven radius is seen in the wireframe, which a timer draws."""
    with override():
        bpy.context.view_layer.objects.active = part()
        bpy.ops.sardf.primitive_add(kind="torus")
    ring = bpy.context.active_object
    driver = ring.sardf_primitive.driver_add("torus_minor_radius").driver
    driver.expression = "0.01*frame"

    def top():
        return max(vertex.co.z for vertex in ring.data.vertices)

    for frame in (20, 40):
        bpy.context.scene.frame_set(frame)
        yield from until(lambda frame=frame: abs(top() - 0.01 * frame) < 1e-5, "the wireframe")
    result["wire"] = top()
    part().sardf_part.entries.remove(len(part().sardf_part.entries) - 1)
    bpy.data.meshes.remove(ring.data)


def apart():
    """Two pieces, baked while the window lives, and moved apart."""
    look((1.1, 0, 0.5))
    plane = add_section("plane")
    plane.sardf_section.spread = 4
    settings = bpy.context.scene.sardf
    settings.resolution, settings.size = 32, "512"
    with override():
        bpy.context.view_layer.objects.active = part()
        bpy.ops.sardf.bake_pieces("INVOKE_DEFAULT")
    result["running"] = addon("bake_operator").SARDF_OT_bake.job is not None
    yield from until(lambda: part().sardf_part.baked is not None, "the pieces")
    yield
    items = [item for item in part().children if "sardf_source" in item]
    result["pieces"] = {item.name: list(item.matrix_world.translation) for item in items}
    result["previewed"] = part().name in shown()
    view()[1].spaces.active.shading.color_type = "TEXTURE"
    yield from wait(1)
    screenshot("section_pieces")
    plane.location.y = 1
    yield from until(lambda: part().name in shown(), "the preview of the changed part")
    result["previewed once it is changed"] = True


def shown():
    preview = addon("preview.preview")
    preview.collect()
    return preview.CURRENT.parts


bpy.context.preferences.view.show_splash = False
addon_folder.load(ADDON)
drive(scenario(), 0.05)
