# SPDX-License-Identifier: GPL-3.0-or-later
"""What the scripts gui_*.py share, which drive Blender in a window under an X server. Their last
two arguments are a folder for screenshots and RESULT.json.

A script is a generator: each yield gives Blender time, and it waits for what it expects by `until`.
"""

import importlib
import json
import os
import subprocess
import sys
import time
import traceback
from pathlib import Path

import bpy
from bpy_extras.view3d_utils import location_3d_to_region_2d
from mathutils import Vector

sys.path.insert(0, str(Path(__file__).resolve().parent))
import addon_folder
from installing import MODULE

FOLDER, RESULT = sys.argv[-2:]
result = {"errors": [], "drawn": {}}


class TimeOut(Exception):
    pass


def addon(name):
    """A module of the add-on: of the checkout, if addon_folder loaded it, or else installed."""
    package = addon_folder.NAME if addon_folder.NAME in sys.modules else MODULE
    return importlib.import_module(f"{package}.{name}")


def until(condition, what, limit):
    """Give Blender time until `condition()` holds, no longer than `limit` seconds."""
    end = time.monotonic() + limit
    while not condition():
        if time.monotonic() > end:
            screenshot(f"{Path(RESULT).stem}_time_out")
            raise TimeOut(f"waited {limit:.0f} s for {what}")
        yield


def watch(cls, name="draw"):
    """Count, as result["drawn"][class], complete draws of a panel, a menu or (name "draw_item") a
    list, and keep what is raised there. Blender counts a draw function's arguments."""
    original = getattr(cls, name)

    if name == "draw":

        def draw(self, context):
            _counted(cls, lambda: original(self, context))

    else:

        def draw(self, context, layout, data, item, icon, active, prop, index):
            words = (context, layout, data, item, icon, active, prop, index)
            _counted(cls, lambda: original(self, *words))

    setattr(cls, name, draw)


def _counted(cls, call):
    try:
        call()
    except Exception:
        result["errors"].append(traceback.format_exc())
        raise
    result["drawn"][cls.__name__] = drawn(cls.__name__) + 1


def drawn(name):
    """How often a class that is watched was drawn."""
    return result["drawn"].get(name, 0)


def drawn_again(name, limit):
    """Wait until a class that is watched was drawn with everything that is in it now."""
    before = drawn(name)
    view()[1].tag_redraw()
    yield from until(lambda: drawn(name) > before, f"{name} to be drawn", limit)


def view():
    window = bpy.context.window_manager.windows[0]
    area = max(
        (a for a in window.screen.areas if a.type == "VIEW_3D"), key=lambda a: a.width * a.height
    )
    return window, area, {region.type: region for region in area.regions}


def wait(seconds):
    """Give Blender so much time."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        yield


def override():
    """The context of the largest viewport. Nothing may wait inside of it: Blender goes on, in a
    context that is not its own, and may die of it."""
    window, area, regions = view()
    return bpy.context.temp_override(window=window, area=area, region=regions["WINDOW"])


def pixel(point):
    """[column, row] of a point of the world on a screenshot."""
    window, area, regions = view()
    region = regions["WINDOW"]
    x, y = location_3d_to_region_2d(region, area.spaces.active.region_3d, Vector(point))
    return [region.x + x, window.height - (region.y + y)]


def screenshot(name):
    subprocess.run(["import", "-window", "root", f"{FOLDER}/{name}.png"], check=True)


def click(x, y):
    """A real click; Blender counts y from below, X from above."""
    height = view()[0].height
    command = ["xdotool", "mousemove", str(x), str(height - y), "click", "1"]
    subprocess.run(command, check=True)


def open_tab(area, is_drawn, limit):
    """Open an area's sidebar at our tab. Blender 3.4 has no other way to choose one than to click
    down the column of tabs; a second click on one closes it in Blender 5."""
    area.spaces.active.show_region_ui = True
    sidebar = next(region for region in area.regions if region.type == "UI")
    yield from until(lambda: sidebar.width > 50, "the sidebar to open", limit)
    if hasattr(sidebar, "active_panel_category"):
        yield from until(lambda: _chosen(area, sidebar), "our tab to be known", limit)
        yield from until(is_drawn, "our tab to be drawn", limit)
        return
    right, top = sidebar.x + sidebar.width, sidebar.y + sidebar.height
    for down in range(30, 500, 25):
        click(right - 10, top - down)
        end = time.monotonic() + 0.5
        while not is_drawn() and time.monotonic() < end:
            yield
        if is_drawn():
            return
    screenshot(f"{Path(RESULT).stem}_time_out")
    raise TimeOut("no tab showed the panel")


def _chosen(area, sidebar):
    """Choose our tab, which Blender knows once it has drawn the column of tabs."""
    area.tag_redraw()
    try:
        sidebar.active_panel_category = "sardf"
    except (AttributeError, TypeError):
        return False
    return True


def drive(steps, tick):
    """Run the steps, one every `tick` seconds; end Blender after the last one, or with what went
    wrong."""
    bpy.app.timers.register(lambda: _step(steps, tick), first_interval=1.0, persistent=True)


def _step(steps, tick):
    try:
        next(steps)
        return tick
    except StopIteration:
        _leave()
    except Exception:
        traceback.print_exc()
        result["errors"].append(traceback.format_exc())
        _leave()


def _leave():
    Path(RESULT).write_text(json.dumps(result, indent=1))
    sys.stdout.flush()
    os._exit(0)  # quitting asks about unsaved changes
