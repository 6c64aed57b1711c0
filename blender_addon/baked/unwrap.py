# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates by Blender's Smart UV Project."""

import contextlib

import bpy
import numpy as np

from . import mesh_data


class UnwrapError(Exception):
    """It cannot be done now: one sentence."""


def can_unwrap(context):
    """Whether no other object is being edited."""
    return context.mode == "OBJECT" and context.view_layer is not None


def smart(context, mesh, size):
    """(4 faces, 2) texture coordinates of a sardf mesh, from a passing object in the view layer.

    `size`: texels along the texture's side, of which 8 stay between islands. Raises UnwrapError.
    """
    if not can_unwrap(context):
        raise UnwrapError("Smart UV Project works in Object Mode only; leave the mode you are in")
    data = mesh_data.build("sardf unwrap", mesh)
    item = bpy.data.objects.new("sardf unwrap", data)
    keep, _, _ = mesh_data.corner_layout(mesh.faces)
    try:
        with _alone(context, item):
            bpy.ops.object.mode_set(mode="EDIT")
            bpy.ops.mesh.select_all(action="SELECT")
            bpy.ops.uv.smart_project(island_margin=8 / size, scale_to_bounds=False)
            bpy.ops.object.mode_set(mode="OBJECT")
        layer = data.uv_layers.active
        if layer is None:
            raise UnwrapError("Smart UV Project made no UV map")
        flat = np.empty(2 * len(data.loops), dtype=np.float32)
        layer.data.foreach_get("uv", flat)
    finally:
        bpy.data.objects.remove(item)
        bpy.data.meshes.remove(data)
    return _spread(keep, flat.reshape(-1, 2).astype(float))


def _spread(keep, values):
    """From the corners that exist to four for each face: a triangle repeats its last one."""
    full = np.zeros((*keep.shape, 2))
    full[keep] = values
    full[~keep[:, 3], 3] = full[~keep[:, 3], 2]
    return full.reshape(-1, 2)


@contextlib.contextmanager
def _alone(context, item):
    """The object is active and selected, and nothing else is; then all is as it was."""
    layer = context.view_layer
    active, selected = layer.objects.active, [o for o in layer.objects if o.select_get()]
    context.scene.collection.objects.link(item)
    try:
        for other in selected:
            other.select_set(False)
        layer.objects.active = item
        item.select_set(True)
        yield
    finally:
        if item.mode == "EDIT":
            bpy.ops.object.mode_set(mode="OBJECT")
        context.scene.collection.objects.unlink(item)
        for other in selected:
            other.select_set(True)
        layer.objects.active = active
