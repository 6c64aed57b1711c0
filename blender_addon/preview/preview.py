# SPDX-License-Identifier: GPL-3.0-or-later
"""The live preview: parts as they are being made, in every 3-D viewport.

Whoever has parts appends a function to `providers`; it is asked after every change and says which
parts there are now. `CURRENT` keeps what is shown; nothing of it is stored in the .blend. A worker
thread (preview_sampler) makes the samples, timers here poll it, handlers only note that something
changed: neither waits for the other.
"""

import threading
import traceback
from pathlib import Path
from typing import Any, NamedTuple

import bpy
from mathutils import Matrix

from .. import core, window
from ..baked import assemble
from . import (
    preview_draw,
    preview_legend,
    preview_sampler,
    preview_shader,
    preview_stand_in,
    preview_volume,
)

SOON = 0.01  # seconds from a change to the question what there is now; changes in between are one
TICK = 0.02  # seconds between two looks at the worker thread
AT_ONCE = 0.015  # seconds that a coarse picture is waited for, so that one redraw shows it
MOST_CUTS, MOST_PLANES = preview_shader.MOST_CUTS, preview_shader.MOST_PLANES  # of each cut


class Shown(NamedTuple):
    """A part to show.

    source: a scene file's text, the pathlib.Path of one, or a sardf.Scene; an exception in its
    place is shown in the panel, and the part stays as it was. matrix: of the part's coordinates
    (scene units) in the world. cuts: what is cut away besides the scene's own sections, MOST_CUTS
    at most, each as MOST_PLANES planes (a, b, c, d) of the part's coordinates at most: where
    a x + b y + c z + d > 0 for all of its planes. Where only matrix and cuts differ nothing is
    sampled again, but the first cut needs the colours inside.
    """

    source: Any
    matrix: Matrix
    cuts: tuple = ()


class Part:
    """What is shown of one part."""

    def __init__(self, matrix):
        self.matrix = matrix  # from the part's coordinates to the world's
        self.cuts = ()
        self.inside = None  # some points of the solid, (N, 3)
        self.note = ""  # what there is to say of what is shown
        self.wish = None
        self.scene = None  # the sardf.Scene that was sampled last
        self.volume = None
        self.textures = None
        self.range = None  # of the number that is shown
        self.error = ""
        self.latency = 0.0  # seconds from the change to the last samples
        self._cut = (None, (), None)  # scene, cuts, and the scene cut by these

    def cut_scene(self, sardf):
        """The scene that was sampled last, with the cuts as sections."""
        if self._cut[:2] != (self.scene, self.cuts):
            made = preview_volume.cut_scene(sardf, self.scene, self.cuts)
            self._cut = (self.scene, self.cuts, made)
        return self._cut[2]


class Preview:
    """All parts that are shown, the worker thread and the graphics card's things."""

    def __init__(self):
        self.parts = {}  # key -> Part
        self.scene = ""  # the name of the Blender scene that has them
        self.error = ""  # why nothing can be shown at all
        self.no_gpu = ""  # why meshes stand in for textures; "" while shaders work
        self._sampler = None
        self._painter = None

    def update(self, key, source, matrix, cuts=()):
        """Show a part, or show it changed. key: its name, any hashable; the others as in Shown.

        Returns whether anything differs.
        """
        settings = bpy.context.scene.sardf_preview
        is_new = key not in self.parts
        part = self.parts.setdefault(key, Part(matrix.copy()))
        differs = is_new or part.matrix != matrix or part.cuts != cuts
        part.matrix, part.cuts = matrix.copy(), cuts
        if isinstance(source, Exception):
            differs = differs or part.error != str(source)
            part.error = str(source)
            return differs
        preview_stand_in.move(key, matrix)
        part.note = self._note(part)
        wish = self._wish(source, part, settings)
        if wish == part.wish:
            return differs
        sampler = self._worker()
        if sampler is not None:
            part.wish = wish
            sampler.request(key, wish)
            _start(_tick, TICK)
        return True

    def _note(self, part):
        """What is said where nothing is to be seen."""
        if part.inside is None or not (part.cuts or part.scene.section_count):
            return ""
        if preview_volume.is_left(core.load(), part.inside, () if self.no_gpu else part.cuts):
            return ""
        return f"the sections leave nothing of {part.scene.title or 'the part'}"

    def hide(self, key):
        """Forget a part."""
        if self.parts.pop(key, None) is not None:
            preview_stand_in.remove(key)
            if self._sampler is not None:
                self._sampler.forget(key)

    def stop(self):
        """Forget everything and end the thread."""
        for key in list(self.parts):
            self.hide(key)
        if self._sampler is not None:
            self._sampler.stop()
        self._sampler = self._painter = None
        self.error = self.no_gpu = ""

    @property
    def busy(self):
        return self._sampler is not None and self._sampler.busy

    def wait(self, seconds):
        """Until the thread has made something, if it makes anything, but not longer."""
        if self.busy:
            self._sampler.wait(seconds)

    def poll(self):
        """Take over what the thread has made; whether there was anything."""
        results = self._sampler.take() if self._sampler is not None else []
        for key, result in results:
            if key in self.parts:
                self._accept(key, self.parts[key], result)
        return bool(results)

    def finish(self):
        """Make all that is open at once, waiting: for scripts and where there are no timers."""
        while self.busy:
            self.wait(0.1)
            self.poll()

    def spacing(self, part, settings):
        """Between lines, in the part's units; 0: there are none."""
        if not settings.stripes:
            return 0.0
        return settings.spacing or float((part.volume.hi - part.volume.lo).max()) / 50

    def draw(self, context):
        """All parts, into the view that is being drawn."""
        settings = context.scene.sardf_preview
        for part in self.parts.values():
            # What has no extent in some direction cannot be turned back to samples.
            if part.volume is not None and part.matrix.determinant() and self._prepare(part):
                self._painter.draw(
                    part.textures,
                    part.matrix,
                    part.cuts,
                    part.range or (0.0, 0.0),
                    self.spacing(part, settings),
                    context.region.height,
                )

    def _prepare(self, part):
        """Bring the shader and a part's samples onto the graphics card; whether that worked."""
        if part.textures is not None and part.textures.volume is part.volume:
            return True
        try:
            if self._painter is None:
                self._painter = preview_draw.Painter()
            part.textures = self._painter.upload(part.volume)
        except Exception as error:  # whatever a driver says: the stand-in needs no driver
            self.no_gpu = str(error) or type(error).__name__
            settings_changed()
            return False
        part.volume.field = part.volume.color = None  # they may be large
        return True

    def _wish(self, source, part, settings):
        channel, material = preview_volume.channel_of(settings.show)
        is_file = isinstance(source, Path)
        return preview_volume.Wish(
            source=source,
            resolution=int(settings.quality),
            cut=bool(part.cuts),
            channel=channel,
            material=material,
            stand_in=part.cuts if self.no_gpu else None,
            stamp=source.stat().st_mtime_ns if is_file and source.is_file() else 0,
        )

    def _worker(self):
        if self._sampler is None:
            try:
                self._sampler = preview_sampler.Sampler(core.load())
            except core.MissingCore as error:
                self.error = str(error)
        return self._sampler

    def _accept(self, key, part, result):
        if isinstance(result, Exception):
            part.error = str(result)
            if not isinstance(result, (core.load().Error, preview_volume.PreviewError)):
                traceback.print_exception(result)  # ours to mend: show where
            return
        part.error = ""
        part.scene = result.scene
        part.inside = result.inside
        part.note = self._note(part)
        part.latency = result.latency
        part.range = result.range if result.wish.channel != "base_color" else None
        if isinstance(result, preview_volume.StandIn):
            part.volume = part.textures = None
            preview_stand_in.show(bpy.context.scene, key, result, part.matrix)
        else:
            preview_stand_in.remove(key)
            part.volume = result


CURRENT = Preview()


def from_file(scene, depsgraph):
    """The part of the scene file that the panel names."""
    path = bpy.path.abspath(scene.sardf.filepath)
    if not path:
        return {}
    baked = assemble.find(scene, path)
    matrix = Matrix() if baked is None else baked.matrix_world
    cuts = [cut for cutter in cutters for cut in cutter(scene, depsgraph, matrix)]
    return {path: Shown(Path(path), matrix, tuple(cuts[:MOST_CUTS]))}


cutters = []  # functions (scene, depsgraph, matrix) -> cuts of what has that matrix and no part


# Functions (scene, depsgraph) -> {key: Shown}. They are called by a timer, never by a handler, on
# the main thread: they must be quick and change nothing.
providers = [from_file]


def schedule(*_):
    """Something may have changed: ask the providers soon. Cheap, and safe in handlers."""
    _start(_collect, SOON)


def settings_changed(_settings=None, _context=None):
    """The same after a change in how parts are shown: views are drawn again in any case."""
    _start(window.redraw, SOON)
    schedule()


def collect():
    """Ask the providers now, and show what they say. Returns whether anything differs."""
    scene = bpy.context.scene
    if not scene.sardf_preview.enabled:
        CURRENT.stop()
        _set_drawing(False)
        return False
    if bpy.app.background:
        CURRENT.no_gpu = "Blender runs without a window"
    depsgraph = bpy.context.evaluated_depsgraph_get()
    found = {}
    for provider in providers:
        found |= provider(scene, depsgraph)
    CURRENT.scene = scene.name
    gone = [key for key in CURRENT.parts if key not in found]
    for key in gone:
        CURRENT.hide(key)
    differ = [CURRENT.update(key, *shown) for key, shown in found.items()]
    _set_drawing(True)
    return bool(gone) or any(differ)


def update_now():
    """Collect, sample and show, waiting for it: what scripts and Blender without a window need."""
    collect()
    CURRENT.finish()


def _start(timer, seconds):
    # Rendering an animation calls handlers from a thread of its own; timers are not for that.
    if bpy.app.background or threading.current_thread() is not threading.main_thread():
        return
    if not bpy.app.timers.is_registered(timer):
        bpy.app.timers.register(timer, first_interval=seconds)


def _collect():
    if collect():
        CURRENT.wait(AT_ONCE)
        CURRENT.poll()
        window.redraw()


def _tick():
    if CURRENT.poll():
        window.redraw()
    return TICK if CURRENT.busy else None


_drawing = []  # what draw_handler_add returned


def _set_drawing(wanted):
    if wanted and not _drawing and not bpy.app.background:
        add = bpy.types.SpaceView3D.draw_handler_add
        _drawing.append(add(_draw, (), "WINDOW", "POST_VIEW"))
        _drawing.append(add(_draw_legend, (), "WINDOW", "POST_PIXEL"))
    while _drawing and not wanted:
        bpy.types.SpaceView3D.draw_handler_remove(_drawing.pop(), "WINDOW")


def _is_shown(scene):
    return scene.sardf_preview.enabled and scene.name == CURRENT.scene


def _draw():
    if _is_shown(bpy.context.scene) and not CURRENT.no_gpu:
        CURRENT.draw(bpy.context)


def _draw_legend():
    if _is_shown(bpy.context.scene):
        preview_legend.draw(bpy.context, bpy.context.scene.sardf_preview, CURRENT)


@bpy.app.handlers.persistent
def depsgraph_changed(scene, _depsgraph):
    """After every change of objects: dragging a part's object ends up here."""
    if scene.sardf_preview.enabled and scene == bpy.context.scene:
        schedule()


@bpy.app.handlers.persistent
def content_replaced(*_):
    """After another file was loaded, after undo and redo: whatever was known may be gone."""
    settings_changed()


@bpy.app.handlers.persistent
def content_goes(*_):
    """Before another file is loaded."""
    CURRENT.stop()


HANDLERS = (
    ("depsgraph_update_post", depsgraph_changed),
    ("frame_change_post", depsgraph_changed),
    ("undo_post", content_replaced),
    ("redo_post", content_replaced),
    ("load_post", content_replaced),
    ("load_pre", content_goes),
)


def register():
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).append(function)


def unregister():
    for name, function in HANDLERS:
        getattr(bpy.app.handlers, name).remove(function)
    for timer in (_collect, _tick, window.redraw):
        if bpy.app.timers.is_registered(timer):
            bpy.app.timers.unregister(timer)
    CURRENT.stop()
    _set_drawing(False)
