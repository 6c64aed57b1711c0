# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the part's panels and the Add menu in a window:
blender --factory-startup -P gui_part.py -- ADDON_FOLDER SCENE.json FOLDER RESULT.json; see
gui_window.py. Writes parts.png into FOLDER. The panels are put into the tab that is shown first,
since Blender 3.4 has no way but a click to choose another.
"""

import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
import addon_folder
from gui_window import (
    RESULT,
    addon,
    drawn,
    drawn_again,
    drive,
    override,
    result,
    screenshot,
    until,
    view,
    wait,
    watch,
)

ADDON, SCENE = sys.argv[-4:-2]
LIMIT = 120.0  # seconds for anything at most


def watch_panels():
    panel = addon("parts.part_panel")
    sections = addon("parts.part_section_panel")
    panel._Panel.bl_category = sections.SARDF_PT_section_object.bl_category = "Item"
    sections.SARDF_PT_sections.bl_options = set()  # open
    for cls in (*panel.CLASSES, *sections.CLASSES):
        watch(cls, "draw_item" if issubclass(cls, bpy.types.UIList) else "draw")


def until_drawn(*names):
    return until(lambda: all(map(drawn, names)), f"a draw of {names}", LIMIT)


def scenario():
    area = view()[1]
    area.spaces.active.show_region_ui = True
    with override():
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.object.delete()
        bpy.ops.sardf.part_import(filepath=SCENE)
        bpy.ops.view3d.view_all()
        part = bpy.context.active_object
        part.sardf_part.sections.add().name = "no object"
        bpy.ops.sardf.section_add(kind="box", everywhere=True)
        bpy.context.view_layer.objects.active = part
        bpy.ops.sardf.section_add(kind="plane")
    area.tag_redraw()
    yield from until_drawn("SARDF_PT_part", "SARDF_PT_materials", "SARDF_PT_features",
                           "SARDF_UL_entries", "SARDF_UL_materials", "SARDF_UL_named",
                           "SARDF_PT_sections", "SARDF_PT_section_object")  # fmt: skip
    yield from wait(1)
    screenshot("part_sections")
    for kind in ("box", "cylinder", "formula"):  # the parameters of each in the panel
        with override():
            bpy.context.view_layer.objects.active = part
            bpy.ops.sardf.primitive_add(kind=kind)
        yield from drawn_again("SARDF_PT_part", LIMIT)
    yield from lives_on()
    with override():
        bpy.ops.wm.call_menu(name="SARDF_MT_add")
    yield from until_drawn("SARDF_MT_add")
    yield from wait(1)
    screenshot("parts")


def entries():
    objects = addon("parts.part_objects")
    part = objects.outermost(objects.part_of(bpy.context.view_layer.objects.active))
    return [entry.object.name for entry in part.sardf_part.entries]


def lives_on():
    """How many entries the part has when one is added, undone, redone, saved and opened again; the
    panel is drawn after each."""
    with override():
        bpy.ops.ed.undo_push(message="before the sphere")
    result["entries"] = [len(entries())]
    path = str(Path(RESULT).with_suffix(".blend"))
    for step in (
        lambda: bpy.ops.sardf.primitive_add(kind="sphere") and bpy.ops.ed.undo_push(message="it"),
        bpy.ops.ed.undo,
        bpy.ops.ed.redo,
        lambda: bpy.ops.wm.save_as_mainfile(filepath=path),
    ):
        with override():
            step()
        yield from drawn_again("SARDF_PT_part", LIMIT)
        result["entries"].append(len(entries()))
    saved = entries()
    bpy.ops.wm.read_homefile(use_empty=True, load_ui=False)
    yield
    bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
    yield from drawn_again("SARDF_PT_part", LIMIT)
    result["reopened"] = entries() == saved


bpy.context.preferences.view.show_splash = False
addon_folder.load(ADDON, before=watch_panels)
drive(scenario(), 0.05)
