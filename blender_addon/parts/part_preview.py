# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a scene in the live preview, which asks again after every change."""

import json

from ..preview import preview
from . import part_objects, part_scene, part_status
from .part_error import PartError


def from_parts(scene, depsgraph):
    """{part's name: (scene text or what is wrong with the part, matrix)} of all that is to be seen.

    Parts inside other parts are shown by these. The names and texts say all that samples depend
    on: a part that is only moved keeps them.
    """
    found = {}
    for part in part_objects.parts(scene):
        if part.visible_get() and part_objects.outermost(part) == part:
            matrix = part.evaluated_get(depsgraph).matrix_world
            found[part.name_full] = (_source(part, depsgraph), matrix)
    return found


def _source(part, depsgraph):
    count = len(part.sardf_part.entries)
    if count > part_status.MOST_ENTRIES:
        # Reading so many objects takes longer than a hand waits.
        return PartError(f"'{part.name}' has {count} entries: too many for a live preview")
    try:
        document, _ = part_scene.scene_of(part, depsgraph)
    except PartError as error:
        return error
    return json.dumps(document)


def register():
    preview.providers.append(from_parts)


def unregister():
    if from_parts in preview.providers:  # scripts may have put others in its place
        preview.providers.remove(from_parts)
