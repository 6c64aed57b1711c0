# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of one object each: the scene that every kind of object gives under many transforms."""

import json
import shutil
from pathlib import Path

import bpy
from mathutils import Euler, Matrix
from sardf_blender.parts import mesh_files, part_objects, part_scene, primitives

SCALES = {
    "unit": (1, 1, 1),
    "even": (2, 2, 2),
    "long": (1, 1, 3),
    "uneven": (1, 2, 3),
    "mirrored": (-1, 1, 1),
    "uneven and mirrored": (1, -2, 3),
    "turned inside out": (-2, -2, -2),
}


def main(folder):
    """Meshes that scenes read are copied to `folder`: Blender removes its own at its end."""
    results = []
    turn = Matrix.Translation((1, 2, 3)) @ Euler((0.3, 0.4, 0.5)).to_matrix().to_4x4()
    part = part_objects.new_part("part", bpy.context.collection, (5, -7, 2))
    part.rotation_euler = (0.2, -0.3, 0.7)
    part.scale = (1.5, 1.5, 1.5)
    for kind in primitives.KINDS:
        for name, scale in SCALES.items():
            item = part_objects.new_primitive(kind, kind, bpy.context.collection)
            results.append(_case(part, item, kind, name, turn @ Matrix.Diagonal((*scale, 1))))
        results.append(_sheared(part, kind, turn))
    for name, scale in SCALES.items():
        item = bpy.data.objects.new("block", _block())
        bpy.context.collection.objects.link(item)
        results.append(_case(part, item, "block", name, turn @ Matrix.Diagonal((*scale, 1))))
    for file in mesh_files.folder().iterdir():
        shutil.copy(file, folder)
    return json.loads(json.dumps(results).replace(str(mesh_files.folder()), str(Path(folder))))


def _case(part, item, kind, transform, matrix):
    """Relative to the part, whose own place must not count, the object stands at `matrix`."""
    part.sardf_part.entries.clear()
    bpy.context.view_layer.update()
    item.matrix_world = part.matrix_world @ matrix
    part_objects.add_entry(part, item)
    return _result(part, item, kind, transform, matrix)


def _sheared(part, kind, turn):
    """An object turned under a parent that is scaled unevenly."""
    part.sardf_part.entries.clear()
    parent = bpy.data.objects.new("uneven", None)
    bpy.context.collection.objects.link(parent)
    parent.parent = part
    parent.matrix_basis = Matrix.Diagonal((2, 1, 0.7, 1))
    item = part_objects.new_primitive(kind, kind, bpy.context.collection)
    item.parent = parent
    item.matrix_basis = turn
    part_objects.add_entry(part, item)
    return _result(part, item, kind, "sheared", parent.matrix_basis @ turn)


def _result(part, item, kind, transform, matrix):
    depsgraph = bpy.context.evaluated_depsgraph_get()
    scene, warnings = part_scene.scene_of(part, depsgraph)
    world = part.matrix_world.inverted() @ item.matrix_world
    off = max(abs(world[row][column] - matrix[row][column]) for row in range(4) for column in
              range(4))  # fmt: skip
    values = {each.word: each.default for each in primitives.KINDS.get(kind, ())}
    return {
        "kind": kind,
        "transform": transform,
        "matrix": [list(row) for row in matrix],
        "values": values,
        "scene": scene,
        "warnings": warnings,
        "off": off,
    }


def _block():
    """A closed mesh: the box from (-1, -1, -1) to (1, 1, 1)."""
    points = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh = bpy.data.meshes.new("block")
    mesh.from_pydata(points, [], faces)
    return mesh
