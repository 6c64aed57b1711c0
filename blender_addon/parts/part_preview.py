# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a scene in the live preview, which asks again after every change."""

import json

from ..preview import preview
from . import part_bake, part_now, part_objects, part_sections, part_status
from .part_error import PartError


def from_parts(scene, depsgraph):
    """{part's name: what preview.Shown says} of all parts that are to be seen.

    Parts inside other parts are shown by these. The names and texts say all that samples depend
    on: a part that is only moved keeps them, and one whose section planes and boxes are moved.
    """
    found = {}
    for part in part_objects.parts(scene):
        if part.visible_get() and part_objects.outermost(part) == part:
            source, cuts = _source(part, depsgraph)
            if source is not None:
                matrix = part.evaluated_get(depsgraph).matrix_world
                found[part.name_full] = preview.Shown(source, matrix, cuts)
    return found


def _source(part, depsgraph):
    """(scene text, cuts) of a part; (what is wrong with it, no cuts); (None, no cuts) where its
    baked object is to be seen instead."""
    if part.sardf_part.show == "baked" and part_bake.is_baked(part):
        return None, ()
    count = len(part.sardf_part.entries)
    if count > part_status.MOST_ENTRIES:
        # Reading so many objects takes longer than a hand waits.
        return PartError(f"'{part.name}' has {count} entries: too many for a live preview"), ()
    now = part_now.now(part, depsgraph)
    if now.error is not None:
        return now.error, ()
    if part.sardf_part.show == "newer" and shows_baked(part, now):
        return None, ()
    return without_cuts(now.reading)


def shows_baked(part, now):
    """Whether the part's baked object is visible and shows what the part is now."""
    return part_bake.is_seen(part) and part_bake.mark_of(part) == now.mark


def without_cuts(reading):
    """(scene text, planes): the sections that planes bound, up to as many as the preview draws,
    are taken out of the scene, so that it stays the same while they are moved."""
    sections = reading.scene.get("sections", [])
    left, planes = [], []
    if len(sections) != len(reading.cuts):  # a file whose sections are no longer told apart
        return json.dumps(reading.scene), ()
    for section, cut in zip(sections, reading.cuts, strict=True):
        can = 0 < len(cut.planes) <= preview.MOST_PLANES and len(planes) < preview.MOST_CUTS
        if can:
            planes.append(cut.planes)
        else:
            left.append(section)
    return json.dumps(reading.scene | {"sections": left}), tuple(planes)


def register():
    preview.providers.append(from_parts)
    preview.cutters.append(part_sections.planes_in)


def unregister():
    preview.cutters.remove(part_sections.planes_in)
    if from_parts in preview.providers:  # scripts may have put others in its place
        preview.providers.remove(from_parts)
