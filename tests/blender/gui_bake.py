# SPDX-License-Identifier: GPL-3.0-or-later
"""Drives the installed add-on in a window with mouse and keyboard, as a user would.

Run in an X server: blender --factory-startup -P gui_bake.py -- SCENE FOLDER RESULT.json; see
gui_window.py.
"""

import subprocess
import sys
import time
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
import gui_window
from gui_window import (
    TimeOut,
    addon,
    click,
    drive,
    open_tab,
    override,
    pixel,
    result,
    screenshot,
    view,
)
from installing import MODULE

SCENE = sys.argv[-3]
TICK = 0.05  # seconds between two looks at Blender's state
LIMIT = 120.0  # seconds to wait for anything at most; llvmpipe on a busy machine is slow
BUTTON_GREY = 70  # of 255, in the standard theme: the panel is darker, its buttons are brighter
drawn = {"panel": 0}


def until(condition, what, limit=LIMIT):
    return gui_window.until(condition, what, limit)


def contents():
    kinds = ("objects", "meshes", "materials", "images", "scenes", "textures")
    return {kind: sorted(x.name for x in getattr(bpy.data, kind)) for kind in kinds}


def count_panel_draws():
    panel = addon("panel")
    original = panel.SARDF_PT_main.draw

    def draw(self, context):
        original(self, context)
        drawn["panel"] += 1

    panel.SARDF_PT_main.draw = draw


def bake_class():
    return addon("bake_operator").SARDF_OT_bake


def redrawn():
    """Wait until the panel was drawn again, with everything that is in it now."""
    before = drawn["panel"]
    view()[1].tag_redraw()
    yield from until(lambda: drawn["panel"] > before, "the panel to be drawn")


def button_height(x):
    """(row from above, rows) of the tallest button that the column x of the screen crosses."""
    command = ["import", "-window", "root", "-crop", f"1x9999+{x}+0", "-depth", "8", "gray:-"]
    column = subprocess.run(command, check=True, capture_output=True).stdout
    best, start = (0, 0), None
    for row, value in enumerate(column + b"\0"):
        if value > BUTTON_GREY and start is None:
            start = row
        elif value <= BUTTON_GREY and start is not None:
            best, start = max(best, (row - start, start)), None
    return best[1], best[0]


def press_bake():
    """Click the Bake button: the one that is higher than a line of the panel. It moves when what
    the bake will cost has been measured."""
    info = addon("bake_info")
    yield from until(lambda: info.cost(bpy.context) is not None, "the cost")
    yield from redrawn()
    window, _, regions = view()
    x = regions["UI"].x + 50  # between the button's icon and its text
    row, rows = button_height(x)
    if not 25 <= rows <= 40:
        screenshot("no_button")
        raise TimeOut(f"no Bake button in the panel: the highest has {rows} rows")
    click(x, window.height - row - rows // 2)
    yield from until(lambda: bake_class().job is not None, "the click on Bake to start the job", 20)


def scenario():
    bpy.ops.preferences.addon_enable(module=MODULE)
    bpy.context.preferences.view.smooth_view = 0  # milliseconds of a flight to a new view
    count_panel_draws()
    bpy.data.meshes.remove(bpy.data.meshes["Cube"])
    settings = bpy.context.scene.sardf
    settings.filepath = SCENE
    # Long enough to be interrupted: seconds.
    settings.resolution, settings.size = 256, "4096"
    yield from open_tab(view()[1], lambda: drawn["panel"] > 0, LIMIT)
    yield from redrawn()
    screenshot("panel")
    yield from cancelled_bake()
    settings.resolution, settings.size = 48, "512"
    with override():
        bpy.ops.ed.undo_push(message="before the bake")
    yield from finished_bake()
    yield from undone_bake()


def cancelled_bake():
    before = contents()
    yield from press_bake()
    job = bake_class().job
    yield from until(lambda: job.share > 0, "the job to make progress")
    yield from redrawn()
    screenshot("baking")
    result["interrupted at"] = job.share
    pressed = time.monotonic()
    subprocess.run(["xdotool", "key", "Escape"], check=True)
    yield from until(lambda: bake_class().job is None, "Esc to end the job", 20)
    result["seconds to cancel"] = time.monotonic() - pressed
    yield from until(lambda: not job.running, "the thread to end")
    result["seconds to end the thread"] = time.monotonic() - pressed
    result["thread was cancelled"] = job.cancelled
    result["left behind"] = contents() != before


def finished_bake():
    yield from press_bake()
    yield from until(lambda: bake_class().job is None, "the bake to end")
    item = bpy.context.view_layer.objects.active
    result["baked"] = contents()
    result["faces"] = len(item.data.polygons)
    result["unit"] = bpy.context.scene.unit_settings.length_unit
    shading = view()[1].spaces.active.shading
    shading.type, shading.light, shading.color_type = "SOLID", "FLAT", "TEXTURE"
    with override():
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected(use_all_regions=False)
    yield from redrawn()
    result["seen"] = [seen(vertex.co) for vertex in item.data.vertices if vertex.co.y < -2]
    yield from redrawn()
    screenshot("baked")


def seen(point):
    """[point, its pixel on the screenshot (column, row)], in the scene's units."""
    return [list(point), pixel(point)]


def undone_bake():
    """One undo step takes back all of the bake, and nothing else."""
    with override():
        bpy.ops.ed.undo()
    yield
    result["objects after undo"] = sorted(item.name for item in bpy.context.scene.objects)


bpy.context.preferences.view.show_splash = False  # before the window is drawn for the first time
drive(scenario(), TICK)
