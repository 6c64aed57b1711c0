# SPDX-License-Identifier: GPL-3.0-or-later
"""Where textures cannot be drawn: a coarse mesh with a colour at each vertex in their place."""

import bpy
import numpy as np

from . import preview_shader

KEY = "sardf_preview"  # custom property: the part that an object stands in for
COLORS = "Color"  # the name that Blender's own colour attributes have


def find(key):
    """The object that stands in for a part, or None."""
    return next((item for item in bpy.data.objects if item.get(KEY) == str(key)), None)


def show(scene, key, made, matrix):
    """Show a preview_volume.StandIn, in place of an earlier one of the same part."""
    data = bpy.data.meshes.new(f"preview of {made.scene.title or 'part'}")
    triangles = made.faces[:, 2] == made.faces[:, 3]
    faces = [
        list(face[:3] if flat else face)
        for face, flat in zip(made.faces.tolist(), triangles, strict=True)
    ]
    data.from_pydata(made.vertices.tolist(), [], faces)
    colors = data.color_attributes.new(COLORS, "FLOAT_COLOR", "POINT")
    colors.data.foreach_set("color", np.float32(_colors(made)).reshape(-1))
    data.color_attributes.active_color = colors
    item = find(key)
    if item is None:
        item = bpy.data.objects.new(data.name, data)
        item[KEY] = str(key)
        item.hide_select = item.hide_render = True
        scene.collection.objects.link(item)
    else:
        old, item.data = item.data, data
        bpy.data.meshes.remove(old)
    item.matrix_world = matrix


def move(key, matrix):
    """Move what stands in for a part; nothing happens where nothing does or where it is there."""
    item = find(key)
    if item is not None and item.matrix_world != matrix:
        item.matrix_world = matrix


def remove(key):
    """Remove what stands in for a part, if anything does."""
    item = find(key)
    if item is not None:
        bpy.data.meshes.remove(item.data)  # and the object with it


def _colors(made):
    """Linear colours (V, 4): the materials', or the colour map's of a number."""
    if made.colors is not None:
        return np.nan_to_num(made.colors)
    low, high = made.range or (0.0, 1.0)
    share = np.nan_to_num((made.values - low) / ((high - low) or 1.0))
    table = np.array([preview_shader.map_color(i / 255) for i in range(256)])
    encoded = table[np.clip(share * 255, 0, 255).astype(int)]
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    return np.hstack([linear, np.ones((len(linear), 1))])
