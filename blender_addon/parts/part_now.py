# SPDX-License-Identifier: GPL-3.0-or-later
"""What each part is right now: it is read once after a change, however many ask.

Nothing of it is stored in the .blend.
"""

import functools
import hashlib
import json

import bpy
from bpy.app.handlers import persistent

from . import part_scene
from .part_error import PartError

# Changes of these alone change no part; an object, a mesh, a curve, a material and all else may.
OTHER = (bpy.types.Scene, bpy.types.World, bpy.types.WindowManager, bpy.types.Image)

_known = {}  # name of a part -> Now
_listeners = []  # called whenever all is forgotten


class Now:
    """One part: its part_scene.Reading, or the PartError that says why there is none."""

    def __init__(self, part, depsgraph):
        self.reading = self.error = None
        self.count = _count(depsgraph)
        try:
            self.reading = part_scene.read(part, depsgraph)
        except PartError as error:
            self.error = error

    @functools.cached_property
    def text(self):
        """The scene, as text."""
        return json.dumps(self.reading.scene)

    @functools.cached_property
    def mark(self):
        """A short text that differs wherever the scene does."""
        return mark_of(self.reading.scene)


def mark_of(scene):
    """A short text that differs wherever scenes do."""
    return hashlib.sha256(json.dumps(scene).encode()).hexdigest()[:32]


def now(part, depsgraph):
    """The Now of a part; it may be kept until something changes."""
    key = part.name_full
    # Objects that come or go may be told as a change of the scene alone.
    if key not in _known or _known[key].count != _count(depsgraph):
        _known[key] = Now(part, depsgraph)
    return _known[key]


def _count(depsgraph):
    return len(depsgraph.scene.original.objects)


def forget():
    """After any change: what is known may be wrong."""
    _known.clear()
    for listener in _listeners:
        listener()


def on_change(listener):
    """`listener()` is called whenever what is known of parts is forgotten."""
    _listeners.append(listener)


def off_change(listener):
    _listeners.remove(listener)


@persistent
def _changed(_scene, depsgraph=None):
    updates = () if depsgraph is None else depsgraph.updates
    # Where objects are removed there may be no update at all.
    if not len(updates) or not all(isinstance(update.id, OTHER) for update in updates):
        forget()


_HANDLERS = ("depsgraph_update_post", "frame_change_post", "undo_post", "redo_post", "load_post")


def register():
    for name in _HANDLERS:
        # First of all: other handlers may ask what parts are now.
        getattr(bpy.app.handlers, name).insert(0, _changed)


def unregister():
    for name in _HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if _changed in handlers:
            handlers.remove(_changed)
    forget()
