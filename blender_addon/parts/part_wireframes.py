# SPDX-License-Identifier: GPL-3.0-or-later
"""Wireframes of primitives whose properties are animated or driven: drawn anew when these change.

Handlers only note that something changed; the meshes are edited by a timer, or without a window at
once.
"""

import threading

import bpy
from bpy.app.handlers import persistent

from . import part_objects
from .part_properties import NO_KIND


def follow(scene, depsgraph):
    """Draw the wireframes of the scene that differ from what `depsgraph` has."""
    for item in scene.objects:
        if _may_move(item):
            settings = item.evaluated_get(depsgraph).sardf_primitive
            if not part_objects.is_drawn(item, settings):
                part_objects.draw(item, settings)


def _may_move(item):
    if item.animation_data is None or item.sardf_primitive.kind == NO_KIND:
        return False
    # A mesh that others share cannot follow one of them.
    return item.type == "MESH" and item.data.users == 1 and item.data.library is None


@persistent
def _changed(scene, depsgraph=None):
    if threading.current_thread() is not threading.main_thread():  # a render: wires are not in it
        return
    if bpy.app.background:
        follow(scene, depsgraph or bpy.context.evaluated_depsgraph_get())
    elif not bpy.app.timers.is_registered(_follow_now):
        bpy.app.timers.register(_follow_now, first_interval=0.0)


def _follow_now():
    if not bpy.app.is_job_running("RENDER"):
        follow(bpy.context.scene, bpy.context.evaluated_depsgraph_get())


_HANDLERS = ("depsgraph_update_post", "frame_change_post")


def register():
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).append(_changed)


def unregister():
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).remove(_changed)
    if bpy.app.timers.is_registered(_follow_now):
        bpy.app.timers.unregister(_follow_now)
