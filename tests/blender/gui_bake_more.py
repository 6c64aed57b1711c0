# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes into a folder in a window, interrupted in every way:
blender --factory-startup -P gui_bake_more.py -- ADDON_FOLDER SCENE.json FOLDER RESULT.json; see
gui_window.py. Writes bake_panel.png, bake_progress.png and bake_nodes.png into FOLDER. The panel is
put into the tab that is shown first, since Blender 3.4 has no way but a click to choose another.
"""

import subprocess
import sys
import tempfile
import threading
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

ADDON, SCENE = sys.argv[-4:-2]
LIMIT = 300.0  # seconds for anything at most
CHANNELS = "base_color, roughness, metallic, fractions, normal, density"
said = []


def bake_class():
    return addon("bake_operator").SARDF_OT_bake


def watch_bake():
    """Put the panel into the first tab, and keep what the operator reports."""
    panel = addon("bake_panel").SARDF_PT_bake
    panel.bl_category = "Tool"
    watch(panel)
    fail = bake_class()._fail

    def reported(self, error):
        said.append(str(error))
        return fail(self, error)

    bake_class()._fail = reported


def contents():
    kinds = ("objects", "meshes", "materials", "images", "texts", "scenes")
    return {kind: sorted(x.name for x in getattr(bpy.data, kind)) for kind in kinds}


def redrawn():
    yield from drawn_again("SARDF_PT_bake", LIMIT)


def start():
    with override():
        bpy.ops.sardf.bake("INVOKE_DEFAULT")
    return bake_class().job


def ended(job):
    yield from until(lambda: bake_class().job is None, "the bake to end", LIMIT)
    yield from until(lambda: not job.running, "the thread to end", LIMIT)


def scenario():
    area = view()[1]
    area.spaces.active.show_region_ui = True
    bpy.data.meshes.remove(bpy.data.meshes["Cube"])
    settings().filepath = SCENE
    settings().channels = CHANNELS
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "new" / "textures"
        settings().destination, settings().folder = "FOLDER", str(target)
        yield from panel_before_a_bake()
        yield from escape(Path(folder))
        yield from deleted_part(Path(folder))
        yield from disabled_addon(Path(folder))
        yield from finished(target)
        yield from unwrapped()
        yield from nodes()


def settings():
    """As they are now: undo, and an add-on that is registered again, make them anew."""
    return bpy.context.scene.sardf


def panel_before_a_bake():
    settings().resolution, settings().size = 256, "4096"
    yield from redrawn()
    info = addon("bake_info")
    yield from until(lambda: info.cost(bpy.context) is not None, "the estimate", LIMIT)
    yield from redrawn()
    result["estimate"] = info.cost(bpy.context).seconds
    screenshot("bake_panel")


def escape(folder):
    """In the middle of the mesh, of the textures and of the files."""
    before = contents()
    result["interrupted"], result["seconds to cancel"] = [], []
    for share, resolution, size in ((0.02, 256, "4096"), (0.58, 48, "4096"), (0.85, 48, "4096")):
        settings().resolution, settings().size = resolution, size
        if share > 0.6:
            settings().channels = "base_color, fractions"
        job = start()
        yield from until(lambda job=job, s=share: job.share > s or not job.running, "work", LIMIT)
        yield from redrawn()
        result["stage"] = bake_class().watch.stage
        if share < 0.6:
            screenshot("bake_progress")
        result["interrupted"].append(job.share)
        stopped = []
        watch_end(job, stopped)
        subprocess.run(["xdotool", "key", "Escape"], check=True)
        yield from ended(job)
        yield from until(lambda stopped=stopped: stopped, "the watcher to see the end", LIMIT)
        result["seconds to cancel"] += stopped
        result["cancelled"] = result.get("cancelled", True) and job.cancelled
    settings().channels = CHANNELS
    result["left by Esc"] = [contents() != before, [str(p) for p in folder.rglob("*")]]


def watch_end(job, stopped):
    """Append how long the thread goes on after the operator heard of Esc; not in Blender's ticks,
    which X11 and drawing hold up."""
    heard = threading.Event()
    cancel = job.cancel

    def cancelled():
        heard.set()
        cancel()

    def look():
        heard.wait()
        begun = time.monotonic()
        job.join(LIMIT)
        stopped.append(time.monotonic() - begun)

    job.cancel = cancelled
    threading.Thread(target=look, daemon=True).start()


def deleted_part(folder):
    with override():
        bpy.ops.sardf.part_import(filepath=SCENE)
    name = item_name()
    settings().resolution = 200
    job = start()
    yield from until(lambda: job.share > 0, "the bake to begin", LIMIT)
    bpy.data.objects.remove(bpy.data.objects[name])
    yield from ended(job)
    result["deleted part"] = [said[-1], [str(p) for p in folder.rglob("*")]]


def disabled_addon(folder):
    job = start()
    yield from until(lambda: job.share > 0, "the bake to begin", LIMIT)
    sys.modules["sardf_blender"].unregister()
    yield from until(lambda: not job.running, "the thread to end", LIMIT)
    yield from wait(0.5)
    result["disabled"] = [job.cancelled, [str(p) for p in folder.rglob("*")]]
    sys.modules["sardf_blender"].register()
    yield from redrawn()


def finished(target):
    settings().resolution, settings().size = 24, "512"
    with override():
        bpy.context.view_layer.objects.active = None
        bpy.ops.ed.undo_push(message="before the bake")
    before = contents()
    job = start()
    yield from ended(job)
    result["files"] = sorted(path.name for path in target.iterdir())
    item = bpy.context.view_layer.objects.active
    result["baked"] = [item.name, len(item.data.polygons)]
    with override():
        bpy.ops.ed.undo()
    yield from redrawn()
    result["undone"] = contents()["objects"] == before["objects"]
    with override():
        bpy.ops.ed.redo()
    yield from redrawn()
    result["redone"] = item_name() == result["baked"][0]


def unwrapped():
    """Smart UV Project waits for Object Mode, and leaves the selection as it was till the end."""
    settings().uv_source, settings().destination = "SMART", "PACKED"
    with override():
        bpy.ops.mesh.primitive_cube_add()
        cube = bpy.context.view_layer.objects.active
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.ed.undo_push(message="before the bake")
    job = start()
    yield from until(lambda: job.to_unwrap is not None or not job.running, "the mesh", LIMIT)
    if job.error is not None:
        raise job.error
    yield from until(
        lambda: "Object Mode" in bake_class().watch.stage, "the wish for Object Mode", LIMIT
    )
    result["mode"] = cube.mode
    with override():
        bpy.ops.object.mode_set(mode="OBJECT")
    yield from ended(job)
    item = bpy.context.view_layer.objects.active
    result["smart"] = [item.name, item.data.uv_layers[0].name, len(bpy.data.meshes)]
    result["smart images"] = sorted(image.name for image in bpy.data.images if image.packed_file)


def item_name():
    return bpy.context.view_layer.objects.active.name


def nodes():
    """The material in a node editor: what is drawn has sizes."""
    window, area, _ = view()
    item = bpy.context.view_layer.objects.active
    area.type = "NODE_EDITOR"
    area.ui_type = "ShaderNodeTree"
    tree = item.data.materials[0].node_tree

    def drawn():
        area.tag_redraw()
        return all(node.dimensions.x > 0 for node in tree.nodes)

    yield from until(drawn, "the nodes to be drawn", LIMIT)
    region = next(region for region in area.regions if region.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.node.view_all()
    end = time.monotonic() + 2
    yield from until(lambda: area.tag_redraw() or time.monotonic() > end, "two seconds", LIMIT)
    result["nodes"] = {node.name: box(node) for node in tree.nodes}
    screenshot("bake_nodes")


def box(node):
    """[left, right, bottom, top, name of the frame] in the node editor's units."""
    scale = bpy.context.preferences.system.ui_scale
    x, y = node.location
    frame = node.parent
    parent = frame
    while parent is not None:
        x, y = x + parent.location.x, y + parent.location.y
        parent = parent.parent
    width, height = (each / scale for each in node.dimensions)
    return [x, x + width, y - height, y, frame.name if frame else "", node.type]


bpy.context.preferences.view.show_splash = False
addon_folder.load(ADDON, before=watch_bake)
drive(scenario(), 0.02)
