# SPDX-License-Identifier: GPL-3.0-or-later
"""Drives the installed add-on's preview in a window.

Run in an X server: blender --factory-startup -P gui_preview.py -- SCENE FOLDER RESULT.json; see
gui_window.py.
"""

import json
import subprocess
import sys
import threading
import time
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

sys.path.insert(0, str(Path(__file__).resolve().parent))
import gui_window
from gui_window import addon, drive, override, pixel, result, screenshot, view
from installing import MODULE

SCENE = sys.argv[-3]
TICK = 0.02  # seconds between two looks at Blender's state
LIMIT = 60.0  # seconds to wait for anything at most; llvmpipe on a busy machine is slow
result.update({"drags": [], "drag sampling": []})
drawn = {}  # key of a part -> (wish, samples along its longest side) that was drawn last


def until(condition, what, limit=LIMIT):
    return gui_window.until(condition, what, limit)


def note_draws(preview):
    """Remember what was drawn, and count."""
    original = preview.Preview.draw

    def draw(self, context):
        original(self, context)
        drawn["count"] = drawn.get("count", 0) + 1
        for key, part in self.parts.items():
            if part.textures is not None:
                drawn[key] = (part.textures.volume.wish, max(part.textures.volume.counts))

    preview.Preview.draw = draw


def redrawn():
    """Wait until the view was drawn again, with everything that is in it now, and shown."""
    preview = addon("preview.preview")

    for _ in range(2):
        yield
        preview.collect()  # what the debounced timer does, now
        before = drawn.get("count", 0)
        view()[1].tag_redraw()
        yield from until(lambda before=before: drawn.get("count", 0) > before, "a redraw")
    yield


def settled():
    """Wait until everything is sampled finely and drawn."""
    preview = addon("preview.preview")

    preview.collect()
    yield from until(lambda: not preview.CURRENT.busy, "the fine samples")
    yield from redrawn()


def scenario():
    bpy.ops.preferences.addon_enable(module=MODULE)
    bpy.context.preferences.view.smooth_view = 0  # milliseconds of a flight to a new view
    bpy.context.preferences.system.viewport_aa = "OFF"  # else a view is drawn many times
    preview = addon("preview.preview")

    note_draws(preview)
    yield from shown()
    yield from cut()
    yield from moved(preview)
    yield from hidden()
    yield from probed()
    yield from replaced(preview)
    yield from dragged(preview)
    yield from interrupted(preview)


def look_from_the_front(distance):
    with override():
        bpy.ops.view3d.view_axis(type="FRONT")
    space = view()[1].spaces.active
    space.region_3d.view_location = (0, 0, 0)
    space.region_3d.view_distance = distance
    space.overlay.show_floor = space.overlay.show_axis_x = space.overlay.show_cursor = False


def shown():
    look_from_the_front(22)
    bpy.data.objects["Cube"].location = (0, 0, 40)
    bpy.context.view_layer.objects.active = None
    settings = bpy.context.scene.sardf
    settings.filepath = SCENE
    begun = time.monotonic()
    bpy.context.scene.sardf_preview.enabled = True
    yield from until(lambda: SCENE in drawn, "the first picture")
    result["seconds to the first picture"] = time.monotonic() - begun
    yield from settled()
    result["finest"] = drawn[SCENE][1]
    screenshot("preview_whole")
    # Beside the axes, which are drawn where nothing hides them.
    result["center"], result["beside"] = pixel((0, 0, 0)), pixel((5.6, 0, 0.6))
    result["red end"] = pixel((-4, 0, 0.6))
    result["within"] = pixel((4.7, 0, 0.6))


def cut():
    """The half towards the viewer is taken away, then less of it."""
    settings = bpy.context.scene.sardf_preview
    with override():
        bpy.ops.sardf.section_add(kind="plane")  # there is no part: it cuts all that is shown
    plane = bpy.context.active_object
    plane.hide_set(True)  # its lines are not in the way
    yield from settled()
    screenshot("preview_cut")
    points = [(x / 4, 0.0, z / 4) for x in range(-18, 19) for z in range(-18, 19)]
    result["cut"] = [[p, pixel(p)] for p in points if Vector(p).length < 4.7]
    plane.location.y = -4
    yield from redrawn()
    screenshot("preview_less_cut")
    settings.stripes, settings.spacing, plane.location.y = True, 1.0, 0.0
    yield from settled()
    screenshot("preview_lines")
    # In front of the red feature, where no line of whole distance is: at 0.5 and at 1.
    result["between lines"] = pixel((4.5, 0, 0))
    result["on a line"] = pixel((4.0, 0, 0))
    settings.stripes = False
    bpy.data.meshes.remove(plane.data)


def moved(preview):
    """By its matrix alone: nothing is sampled again."""
    wish = drawn[SCENE][0]
    source = Path(SCENE)
    place = Matrix.Translation((7, 0, 0))
    preview.providers[:] = [lambda _scene, _depsgraph: {SCENE: preview.Shown(source, place)}]
    yield from settled()
    screenshot("preview_moved")
    result["sampled again"] = preview.CURRENT.parts[SCENE].wish.made > drawn[SCENE][0].made
    result["wish kept"] = wish.source == drawn[SCENE][0].source
    result["new center"] = pixel((7, 0, 0.6))
    result["old end"] = pixel((-4, 0, 0.6))
    place = Matrix.Diagonal((-1, 1, 0.5, 1))  # mirrored and flat
    preview.providers[:] = [lambda _scene, _depsgraph: {SCENE: preview.Shown(source, place)}]
    yield from settled()
    screenshot("preview_mirrored")
    result["mirrored"] = [pixel((-4, 0, 0)), pixel((4, 0, 0)), pixel((0.6, 0, 3.5))]
    place = Matrix()
    preview.providers[:] = [lambda _scene, _depsgraph: {SCENE: preview.Shown(source, place)}]
    yield from settled()


def hidden():
    """By a cube in front, which one behind does not do."""
    cube = bpy.data.objects["Cube"]
    for name, y in (("preview_behind_cube", -8), ("preview_before_cube", 8)):
        cube.location = (0, y, 0)
        yield from redrawn()
        screenshot(name)
    cube.location = (0, 0, 40)
    yield from redrawn()


def probed():
    probe = addon("preview.preview_probe").SARDF_OT_probe

    with override():
        bpy.ops.sardf.probe("INVOKE_DEFAULT")
    yield from until(lambda: probe.running is not None, "the probe")
    operator = probe.running
    column, row = pixel((0, 0, 0))
    for nudge in (1, 0):
        command = ["xdotool", "mousemove", str(int(column) + nudge), str(int(row))]
        subprocess.run(command, check=True)
        yield
    yield from until(lambda: operator.lines, "the probe to read")
    yield from redrawn()
    screenshot("preview_probe")
    result["probe"] = list(operator.lines)
    subprocess.run(["xdotool", "key", "Escape"], check=True)
    yield from until(lambda: probe.running is None, "Esc to end the probe", 20)


def replaced(preview):
    """Where the graphics card refuses, a mesh stands in; once it works again, none does."""
    preview_draw, preview_stand_in = map(
        addon, ("preview.preview_draw", "preview.preview_stand_in")
    )

    def refuse(_self):
        raise RuntimeError("no shader today")

    create, preview_draw.Painter.__init__ = preview_draw.Painter.__init__, refuse
    settings = bpy.context.scene.sardf_preview
    settings.enabled = False
    yield from until(lambda: not preview.CURRENT.parts, "the preview to be off")
    settings.enabled = True
    yield from until(lambda: preview_stand_in.find(SCENE) is not None, "the mesh")
    result["no gpu"] = preview.CURRENT.no_gpu
    view()[1].spaces.active.shading.color_type = "VERTEX"
    for _ in range(20):
        yield
    screenshot("preview_stand_in")
    preview_draw.Painter.__init__ = create
    settings.enabled = False
    yield from until(lambda: not preview.CURRENT.parts, "the preview to be off")
    result["left of the mesh"] = preview_stand_in.find(SCENE) is not None
    settings.enabled = True
    yield from settled()


def dragged(preview):
    """An object is moved in small steps; the part's size follows it. How long until it is seen."""
    handle = bpy.data.objects.new("handle", None)
    bpy.context.collection.objects.link(handle)
    text = json.loads(Path(SCENE).read_text())

    def follow(scene, _depsgraph):
        text["fields"]["ball"]["sphere"]["radius"] = 3 + scene.objects["handle"].location.x
        return {"dragged": preview.Shown(json.dumps(text), Matrix())}

    preview.providers[:] = [follow]
    yield from settled()
    for step in range(12):
        handle.location.x = 0.1 * (step + 1)
        begun = time.monotonic()
        # Blender sees the change when this timer's turn is over; ours are asked by its handler.
        yield from until(
            lambda begun=begun: drawn["dragged"][0].made > begun, "the drag to be seen"
        )
        result["drags"].append(time.monotonic() - begun)
        result["drag sampling"].append(preview.CURRENT.parts["dragged"].latency)
    begun = time.monotonic()
    yield from until(lambda: drawn["dragged"][1] >= 128, "the fine picture")
    result["seconds to the fine picture"] = time.monotonic() - begun
    screenshot("preview_dragged")
    result["dragged end"] = [pixel((3.9, 0, 0.6)), pixel((4.5, 0, 0.6))]


def threads():
    return [each.name for each in threading.enumerate() if each.name == "sardf preview"]


def busy(preview):
    """Wait until the worker has long work to do."""
    settings = bpy.context.scene.sardf_preview
    settings.enabled = True
    settings.quality = "256" if settings.quality != "256" else "192"
    yield from until(lambda: preview.CURRENT.busy, "the worker to start")


def interrupted(preview):
    """Undo, another file and disabling the add-on while the worker runs."""
    with override():
        bpy.ops.ed.undo_push(message="before")
        bpy.ops.ed.undo_push(message="after")
    yield from busy(preview)
    with override():
        bpy.ops.ed.undo()
    yield from settled()
    result["threads at work"] = threads()
    yield from busy(preview)
    bpy.ops.wm.read_homefile(use_factory_startup=True, load_ui=False)
    yield from until(lambda: not threads(), "the thread to end after another file", 20)
    preview.providers[:] = [preview.from_file]
    bpy.context.scene.sardf.filepath = SCENE
    yield from busy(preview)
    begun = time.monotonic()
    bpy.ops.preferences.addon_disable(module=MODULE)
    result["seconds to disable"] = time.monotonic() - begun
    yield
    result["threads at the end"] = threads()
    for _ in range(5):
        view()[1].tag_redraw()
        yield


bpy.context.preferences.view.show_splash = False  # before the window is drawn for the first time
drive(scenario(), TICK)
