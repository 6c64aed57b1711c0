# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel says about a part: what is wrong with it, and what its distances are worth.

Nothing of it is stored in the .blend; it is found anew after every change.
"""

import json
from dataclasses import dataclass

import bpy
from bpy.app.handlers import persistent

from . import part_scene
from .part_error import PartError

MOST_ENTRIES = 500  # of a part that is read again while the panel is drawn
WORTH = {
    "exact": "the exact distance",
    "bound": "a bound: never more than the distance",
    "estimate": "an estimate: its sign is right",
}


@dataclass
class Status:
    """`error`: why there is no scene, or ""; `lines`: warnings and labels."""

    error: str = ""
    lines: tuple = ()


_known = {}  # name of a part -> Status
_checked = {}  # name of a part -> lines of the core's last check


def status(part, depsgraph):
    """The Status of a part as it is now."""
    key = part.name_full
    if key not in _known:
        if len(part.sardf_part.entries) > MOST_ENTRIES:
            lines = (f"{len(part.sardf_part.entries)} entries: press Check to read them",)
            _known[key] = Status(lines=lines)
        else:
            _known[key] = _read(part, depsgraph)
    return Status(_known[key].error, (*_known[key].lines, *_checked.get(key, ())))


def check(sardf, part, depsgraph):
    """Sentences of the core about a part. Raises PartError and sardf.Error."""
    scene_data, warnings = part_scene.scene_of(part, depsgraph)
    scene = sardf.Scene.from_json(json.dumps(scene_data))
    inside, outside = scene.solid.exactness
    lines = [f"inside: {WORTH[inside]}", f"outside: {WORTH[outside]}"]
    for name, field in scene.fields.items():
        if "estimate" in field.exactness and name in _entry_names(part):
            lines.append(f"{name}: {WORTH['estimate']}")
    _checked[part.name_full] = tuple(lines)
    return [*warnings, *lines, *scene.warnings()]


def _entry_names(part):
    return {entry.field or entry.name for entry in part.sardf_part.entries}


def _read(part, depsgraph):
    try:
        _, warnings = part_scene.scene_of(part, depsgraph)
    except PartError as error:
        return Status(error=str(error))
    return Status(lines=tuple(warnings))


def forget():
    """After any change: what is known may be wrong."""
    _known.clear()
    _checked.clear()


@persistent
def _changed(_scene, depsgraph=None):
    if depsgraph is None or any(
        isinstance(update.id, (bpy.types.Object, bpy.types.Mesh, bpy.types.Curve))
        for update in depsgraph.updates
    ):
        forget()


_HANDLERS = ("depsgraph_update_post", "frame_change_post", "undo_post", "redo_post", "load_post")


def register():
    for name in _HANDLERS:
        getattr(bpy.app.handlers, name).append(_changed)


def unregister():
    for name in _HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if _changed in handlers:
            handlers.remove(_changed)
    forget()
