# SPDX-License-Identifier: GPL-3.0-or-later
"""Baking a part: its scene, and the mesh object that the bake leaves under its Empty.

    for frame, item in part_bake.rebake_frames(bpy.context, part, range(1, 25)):
        ...render...

works without a window, too.
"""

import dataclasses
import uuid
from pathlib import Path

import bpy
from mathutils import Matrix

from .. import core
from ..baked import assemble, job, store
from . import part_now, part_scene
from .part_error import PartError

MARK = "sardf_mark"  # custom property of a baked object: part_now.mark_of the scene that it shows


def request_of(part, settings, depsgraph):
    """(job.Request, warnings) for a part, with the panel's settings. Raises PartError."""
    scene, warnings = part_scene.scene_of(part, depsgraph)
    request = job.Request(
        path=_source(part),
        resolution=settings.resolution,
        size=int(settings.size),
        sections=settings.sections,
        tangent=settings.tangent_attribute,
        scene=scene,
    )
    return request, warnings


def key_of(part):
    """What finds a part again when undo or loading may have made its object anew."""
    return part.name, part.library.filepath if part.library else None


def find(key):
    """The part of a key. Raises PartError."""
    part = bpy.data.objects.get(key)
    if part is None or not part.sardf_part.is_part:
        raise PartError(f"the part '{key[0]}' is gone; what was baked of it is dropped")
    return part


def place(scene, part, made, built):
    """The mesh object of a baked part under its Empty: a new one, or the earlier one renewed."""
    item = assemble.place(scene, made, built, baked_of(part) or assemble.NEW)
    if item.parent != part:
        item.name = f"{part.name} baked"
        item.parent = part
        item.matrix_parent_inverse = Matrix.Identity(4)
        put_beside(part, item)
    if part.library is None:
        part.sardf_part.baked = item
    item[MARK] = "" if made.document is None else _mark(made.document, made.whole)
    return item


def put_beside(part, item):
    """Move an object that was just made into the collection that holds the part."""
    home = next((each for each in part.users_collection if each.library is None), None)
    if home is None or item.name in home.objects:
        return
    for other in item.users_collection:
        other.objects.unlink(item)
    home.objects.link(item)


def _mark(scene, whole):
    """`whole`: the sections were not cut; then it shows a scene without any."""
    shown = {key: of for key, of in scene.items() if not (whole and key == "sections")}
    return part_now.mark_of(shown)


def place_nothing(part, scene):
    """Where the sections of a part's `scene` leave nothing: an earlier baked object is emptied. It
    keeps its material. Returns it, or None where there is none."""
    item = baked_of(part)
    if item is None:
        return None
    materials = list(item.data.materials)
    item.data.clear_geometry()
    for material in materials if not len(item.data.materials) else ():
        item.data.materials.append(material)
    item[MARK] = part_now.mark_of(scene)
    return item


def is_baked(part):
    """Whether the part has a baked object."""
    return baked_of(part) is not None


def mark_of(part):
    """The MARK of the part's baked object, or ""."""
    item = baked_of(part)
    return "" if item is None else item.get(MARK, "")


def is_seen(part):
    """Whether the part's baked object is visible, and stands where the part does."""
    item = baked_of(part)
    if item is None or not item.visible_get():
        return False
    return item.matrix_basis == item.matrix_parent_inverse == Matrix.Identity(4)


def rebake_frames(context, part, frames, channels=job.CHANNELS):
    """For each frame set it, bake the part as the frame's drivers and keyframes have it, and yield
    (frame, mesh object); None where sections leave nothing and it was never baked. Raises PartError
    and sardf.Error."""
    sardf = core.load()
    scene, key = context.scene, key_of(part)
    for frame in frames:
        scene.frame_set(frame)
        part = find(key)
        request, _ = request_of(part, scene.sardf, context.evaluated_depsgraph_get())
        textures = store.Store(Path(bpy.app.tempdir) / "sardf frame", replace=True)
        request = dataclasses.replace(request, channels=tuple(channels), store=textures)
        try:
            made = job.make_part(sardf, request)
        except job.NothingLeft:
            item = place_nothing(part, request.scene)
        else:
            item = place(scene, part, made, assemble.build_images(sardf, made))
        context.view_layer.update()
        yield frame, item


def baked_of(part):
    """The object that an earlier bake of this very part made, or None.

    A copy of a part may still point to the original's.
    """
    baked = part.sardf_part.baked
    if part.library is not None:
        baked = next((i for i in part.children if i.library is None and assemble.SOURCE in i), None)
    return baked if baked is not None and baked.parent == part and baked.users_scene else None


def _source(part):
    """The text that marks what was baked of a part."""
    baked = baked_of(part)
    return baked[assemble.SOURCE] if baked is not None else f"sardf part {uuid.uuid4().hex}"
