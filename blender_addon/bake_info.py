# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel says before a bake: the channels that there are, and what it will take.

A thread reads the scene and measures short runs (sardf.measure_bake) after anything changed that
counts; nothing is stored in the .blend. The panel only asks: `see` starts a timer where something
is not known, and the timer starts the thread.
"""

import json
import time
from pathlib import Path

import bpy
from bpy.app.handlers import persistent

from . import bake_plan, bake_settings, core, properties, window
from .baked import assemble, groups
from .baked.measure import Info, Probe, Wish, measure
from .parts import part_scene, part_status
from .parts.part_error import PartError

SOON, TICK = 0.3, 0.1  # seconds until measuring begins, and between two looks at it


_known = {}  # Wish -> Info, the last one alone
_probe = None
_changed = True  # whether parts may be others than `_wish` says
_changed_at = 0.0
_wish = {}  # what the panel shows -> its Wish


def see(context):
    """(Info, whether it is being measured) for what the panel would bake; Info may be None."""
    shown = _shown(context)
    wish = _wish.get(shown)
    info = _known.get(wish)
    if info is None or _changed:
        _start(_begin, SOON)
    return info, info is None


def cost(context):
    """The sardf BakeCost of what the panel shows, or None while it is not known."""
    info = _known.get(_wish.get(_shown(context)))
    if info is None or info.sample is None:
        return None
    settings = context.scene.sardf
    faces = None
    if settings.uv_source == bake_settings.EXISTING:
        item = settings.uv_object or baked(context)
        if item is None or item.type != "MESH":
            return None
        faces = len(item.data.polygons)
    atlas = settings.uv_source == bake_settings.ATLAS
    return info.sample.cost(settings.resolution, int(settings.size), atlas, faces)


def baked(context):
    """The object that the last bake of what the panel shows made, or None."""
    part = bake_plan.active_part(context)
    path = properties.absolute_path(context.scene.sardf)
    return bake_plan.earlier(context.scene, part, path)


def baked_density(context):
    """Texels per unit of what was baked last, or None."""
    item = baked(context)
    return None if item is None else item.get(assemble.DENSITY)


def normal_switch(context):
    """The socket that says how far the baked material's normal map counts, 0 to 1, or None."""
    item = baked(context)
    for each in () if item is None else filter(None, item.data.materials):
        if each.node_tree is not None:
            node = each.node_tree.nodes.get(groups.node_name("normal switch"))
            if node is not None:
                return node.outputs[0]
    return None


def measure_now(context):
    """Measure at once and wait for it: for scripts and Blender without a window. The Info."""
    wish = _wish_of(context)
    if isinstance(wish, Info):
        return wish
    try:
        info = measure(core.load(), wish)
    except core.load().Error as error:
        info = Info(error=str(error))
    _remember(_shown(context), wish, info)
    return info


def stop():
    """Stop measuring: the processors have something better to do."""
    global _probe
    if _probe is not None:
        _probe.stop()
        _probe = None


def _shown(context):
    """What the panel shows, as far as it can be told while it is drawn."""
    settings = context.scene.sardf
    part = bake_plan.active_part(context)
    name = settings.filepath if part is None else part.name_full
    return part is None, name, settings.sections, settings.channels


def _wish_of(context):
    """The Wish of what the panel shows, or an Info that says why there is none."""
    settings = context.scene.sardf
    part = bake_plan.active_part(context)
    stamp, is_file = 0, part is None
    if is_file:
        source = properties.absolute_path(settings)
        stamp = Path(source).stat().st_mtime_ns if Path(source).is_file() else 0
    elif len(part.sardf_part.entries) > part_status.MOST_ENTRIES:
        return Info(error="a part of so many entries is not measured")
    else:
        try:
            document, _ = part_scene.scene_of(part, context.evaluated_depsgraph_get())
        except PartError as error:
            return Info(error=str(error))
        source = json.dumps(document)
    names = tuple(bake_settings.names_of(settings.channels))
    return Wish(source, is_file, stamp, settings.sections, names)


def _remember(shown, wish, info):
    _known.clear()
    _wish.clear()
    _known[wish], _wish[shown] = info, wish


def _begin():
    """Timer: start measuring what the panel shows, if it is not known already."""
    global _changed, _probe
    from .bake_operator import SARDF_OT_bake  # which uses this module

    if SARDF_OT_bake.job is not None:
        return None
    if time.monotonic() - _changed_at < SOON:  # something is being dragged
        return SOON
    _changed = False
    wish = _wish_of(bpy.context)
    shown = _shown(bpy.context)
    if isinstance(wish, Info):
        _remember(shown, wish.error, wish)
    elif wish in _known:
        _wish[shown] = wish
    elif _probe is None or _probe.wish != wish:
        stop()
        try:
            _probe = Probe(core.load(), wish)
        except core.MissingCore as error:
            _remember(shown, wish, Info(error=str(error)))
        _start(_look, TICK)
    window.redraw()
    return None


def _look():
    """Timer: take what was measured."""
    global _probe
    if _probe is None:
        return None
    if _probe.running:
        return TICK
    info, wish = _probe.info, _probe.wish
    _probe = None
    if info is not None:
        _remember(_shown(bpy.context), wish, info)
    window.redraw()
    return None


def _start(timer, seconds):
    if not bpy.app.background and not bpy.app.timers.is_registered(timer):
        bpy.app.timers.register(timer, first_interval=seconds)


@persistent
def _anything_changed(*_):
    global _changed, _changed_at
    _changed, _changed_at = True, time.monotonic()


_HANDLERS = ("depsgraph_update_post", "frame_change_post", "undo_post", "redo_post", "load_post")


def register():
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).append(_anything_changed)


def unregister():
    stop()
    for timer in (_begin, _look):
        if bpy.app.timers.is_registered(timer):
            bpy.app.timers.unregister(timer)
    for name in _HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if _anything_changed in handlers:
            handlers.remove(_anything_changed)
    _known.clear()
    _wish.clear()
