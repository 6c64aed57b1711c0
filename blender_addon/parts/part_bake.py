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
from . import part_scene
from .part_error import PartError


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
    if part.library is None:
        part.sardf_part.baked = item
    return item


def rebake_frames(context, part, frames, channels=job.CHANNELS):
    """For each frame set it, bake the part as the frame's drivers and keyframes have it, and yield
    (frame, mesh object). Raises PartError and sardf.Error."""
    sardf = core.load()
    scene, key = context.scene, key_of(part)
    for frame in frames:
        scene.frame_set(frame)
        part = find(key)
        request, _ = request_of(part, scene.sardf, context.evaluated_depsgraph_get())
        textures = store.Store(Path(bpy.app.tempdir) / "sardf frame", replace=True)
        request = dataclasses.replace(request, channels=tuple(channels), store=textures)
        made = job.make_part(sardf, request)
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
