# SPDX-License-Identifier: GPL-3.0-or-later
"""A reference in a window: stopped by Esc, then finished, with panel and pictures drawn:
blender --factory-startup -P gui_reference.py -- ADDON_FOLDER FOLDER RESULT.json; see gui_window.py.
"""

import importlib
import os
import subprocess
import sys
import time
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
import addon_folder
from gui_window import (
    addon,
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

ADDON = sys.argv[-3]
LIMIT = 120.0  # seconds for anything at most


def watch_panel():
    reference_panel = addon("reference.reference_panel")
    reference_panel._Panel.bl_category = "Tool"
    reference_panel.SARDF_PT_reference.bl_options = set()
    for cls in reference_panel.CLASSES:
        watch(cls)


def running():
    return addon("reference.reference_operators").SARDF_OT_reference.work


def povray_runs():
    """The child processes of ours that are POV-Ray."""
    words = ["pgrep", "-P", str(os.getpid()), "povray"]
    return subprocess.run(words, capture_output=True, text=True).stdout.split()


def press_escape():
    window, area, _ = view()
    x, y = area.x + area.width // 2, window.height - area.y - area.height // 2
    subprocess.run(["xdotool", "mousemove", str(x), str(y), "key", "Escape"], check=True)


def begin():
    with override():
        return bpy.ops.sardf.reference("INVOKE_DEFAULT")


def scenario():
    window, area, _ = view()
    area.spaces.active.show_region_ui = True
    second = max((a for a in window.screen.areas if a != area), key=lambda a: a.width * a.height)
    second.type = "IMAGE_EDITOR"
    scene = bpy.context.scene
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    reference.add_part("ball", "sphere", (0.8, 0.2, 0.1), size=(2, 2, 2))
    reference.add_light("AREA", (2, -3, 5), energy=300)
    scene.world.use_nodes = False
    scene.sardf.resolution, scene.sardf.size = 24, "256"
    scene.sardf_reference.look = "shaded"
    yield from stopped(scene)
    yield from finished(scene, second)


def stopped(scene):
    scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
    before = reference.counts()
    begin()
    yield from until(lambda: povray_runs(), "POV-Ray to start", LIMIT)
    work = running()
    yield from until(lambda: work.share > 0, "POV-Ray to tell how far it is", LIMIT)
    yield from drawn_again("SARDF_PT_reference", LIMIT)
    screenshot("reference_running")
    result["interrupted"] = work.share
    pressed = time.monotonic()
    press_escape()
    yield from until(lambda: running() is None, "Esc", LIMIT)
    told = time.monotonic()
    yield from until(lambda: not povray_runs(), "POV-Ray to end", LIMIT)
    result["seconds to cancel"] = told - pressed
    result["seconds to end POV-Ray"] = time.monotonic() - told
    yield from until(lambda: not work.running, "the thread", LIMIT)
    result["cancelled"] = work.cancelled
    result["left"] = reference.counts() != before


def finished(scene, editor):
    scene.render.resolution_x, scene.render.resolution_y = 160, 120
    scene.sardf_reference.samples = 16
    begin()
    yield from until(lambda: running() is None, "the reference", LIMIT)
    yield from until(lambda: scene.sardf_reference.compared, "numbers", LIMIT)
    result["numbers"] = {name: getattr(scene.sardf_reference, name) for name in reference.NUMBERS}
    result["image"] = editor.spaces.active.image.name
    result["scene"] = bpy.context.window.scene.name
    for kind in ("reference", "difference"):
        with bpy.context.temp_override(window=view()[0]):
            result[kind] = list(bpy.ops.sardf.reference_show(kind=kind))
    editor.spaces.active.show_region_ui = True
    yield from drawn_again("SARDF_PT_reference", LIMIT)
    yield from wait(1)
    screenshot("reference")


bpy.context.preferences.view.show_splash = False
addon_folder.load(ADDON, before=watch_panel)
reference = importlib.import_module("reference")  # needs the loaded add-on
drive(scenario(), 0.02)
