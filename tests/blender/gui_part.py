# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the part's panels and the Add menu in a window:
blender --factory-startup -P gui_part.py -- ADDON_FOLDER SCENE.json FOLDER

Writes result.json and parts.png into FOLDER. The panels are put into the tab that is shown first,
since Blender 3.4 has no way but a click to choose another.
"""

import importlib
import importlib.util
import json
import subprocess
import sys
import time
import traceback
from pathlib import Path

import bpy

ADDON, SCENE, FOLDER = sys.argv[sys.argv.index("--") + 1 :]
LIMIT = 120.0  # seconds for anything at most
result = {"errors": [], "drawn": {}}


def load_addon():
    spec = importlib.util.spec_from_file_location(
        "sardf_blender", Path(ADDON) / "__init__.py", submodule_search_locations=[ADDON]
    )
    sys.modules["sardf_blender"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules["sardf_blender"])
    panel = importlib.import_module("sardf_blender.part_panel")
    panel._Panel.bl_category = "Item"
    for cls in panel.CLASSES:
        watch(cls, "draw_item" if issubclass(cls, bpy.types.UIList) else "draw")
    sys.modules["sardf_blender"].register()


def watch(cls, name):
    """Count complete draws, and keep the first error."""
    original = getattr(cls, name)

    if name == "draw":

        def draw(self, context):
            counted(cls, lambda: original(self, context))

    else:

        def draw(self, context, layout, data, item, icon, active, prop, index):
            words = (context, layout, data, item, icon, active, prop, index)
            counted(cls, lambda: original(self, *words))

    setattr(cls, name, draw)


def counted(cls, call):
    try:
        call()
    except Exception:
        result["errors"].append(traceback.format_exc())
        raise
    result["drawn"][cls.__name__] = result["drawn"].get(cls.__name__, 0) + 1


def drawn(*names):
    return all(result["drawn"].get(name, 0) for name in names)


def steps():
    """Each yield waits until its condition holds."""
    window = bpy.context.window_manager.windows[0]
    area = max((a for a in window.screen.areas if a.type == "VIEW_3D"), key=lambda a: a.width)
    region = next(r for r in area.regions if r.type == "WINDOW")
    area.spaces.active.show_region_ui = True
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.object.select_all(action="SELECT")
        bpy.ops.object.delete()
        bpy.ops.sardf.part_import(filepath=SCENE)
        bpy.ops.view3d.view_all()
        part = bpy.context.active_object
        part.sardf_part.sections.add().name = "no object"
    area.tag_redraw()
    yield lambda: drawn("SARDF_PT_part", "SARDF_PT_materials", "SARDF_PT_features",
                        "SARDF_UL_entries", "SARDF_UL_materials", "SARDF_UL_named")  # fmt: skip
    with bpy.context.temp_override(window=window, area=area, region=region):
        for kind in ("box", "cylinder", "formula"):  # the parameters of each in the panel
            bpy.context.view_layer.objects.active = part
            bpy.ops.sardf.primitive_add(kind=kind)
            before = result["drawn"]["SARDF_PT_part"]
            area.tag_redraw()
            yield lambda before=before: result["drawn"]["SARDF_PT_part"] > before
        bpy.ops.wm.call_menu(name="SARDF_MT_add")
    yield lambda: drawn("SARDF_MT_add")
    end = time.monotonic() + 1
    yield lambda: time.monotonic() > end
    subprocess.run(["import", "-window", "root", f"{FOLDER}/parts.png"], check=True)


def tick():
    """Runs the steps; ends Blender after the last one, or with what went wrong."""
    try:
        if tick.waiting is None or tick.waiting():
            tick.waiting, tick.since = next(tick.steps), time.monotonic()
        elif time.monotonic() - tick.since > LIMIT:
            raise TimeoutError(f"nothing came of it; drawn: {result['drawn']}")
        return 0.05
    except StopIteration:
        pass
    except Exception:
        result["errors"].append(traceback.format_exc())
    Path(FOLDER, "result.json").write_text(json.dumps(result))
    bpy.ops.wm.quit_blender()
    return None


tick.steps, tick.waiting, tick.since = steps(), None, time.monotonic()
bpy.context.preferences.view.show_splash = False
load_addon()
bpy.app.timers.register(tick, first_interval=1)
