# SPDX-License-Identifier: GPL-3.0-or-later
"""A part in the live preview, whose stand-in tells without a window what it shows."""

import bpy
import numpy as np
from sardf_blender.parts import part_objects
from sardf_blender.preview import preview


def shown():
    """Lower and upper corner in the world of each mesh that stands in, and what is wrong."""
    preview.update_now()
    boxes = {}
    for item in bpy.data.objects:
        if item.type == "MESH" and item.data.polygons:
            corners = np.array([item.matrix_world @ v.co for v in item.data.vertices])
            boxes[item.name] = [corners.min(axis=0).tolist(), corners.max(axis=0).tolist()]
    return {"boxes": boxes, "errors": {k: p.error for k, p in preview.CURRENT.parts.items()}}


def main():
    bpy.ops.sardf.primitive_add(kind="box")
    bpy.context.active_object.scale = (2, 1.5, 1)
    block = bpy.context.active_object
    bpy.ops.sardf.primitive_add(kind="sphere", operation="union")
    ball = bpy.context.active_object
    (part,) = part_objects.parts(bpy.context.scene)
    bpy.context.scene.sardf_preview.enabled = True
    result = {"built": shown()}
    ball.location.x = 4
    result["moved"] = shown()
    part.location.z = 10
    result["part moved"] = shown()
    ball.scale = (0, 1, 1)
    result["flat"] = shown()
    part.hide_set(True)
    result["hidden"] = shown()
    part.hide_set(False)
    bpy.data.objects.remove(ball)
    result["deleted"] = shown()
    result["block"] = list(block.scale)
    return result
