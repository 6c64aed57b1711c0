# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender meshes as PLY files, which the core reads; they lie in Blender's temporary folder."""

import hashlib
import os
import tempfile
from pathlib import Path

import bpy
import numpy as np

from .part_error import PartError


def write(item, evaluated, matrix=None):
    """The path of a PLY file with the object's faces, modifiers applied, in its own frame or under
    a 4x4 matrix. Equal meshes have one file. Raises PartError."""
    mesh = evaluated.to_mesh()
    try:
        data = _ply(item, mesh, matrix)
    finally:
        evaluated.to_mesh_clear()
    folder().mkdir(parents=True, exist_ok=True)
    path = folder() / f"{hashlib.sha256(data).hexdigest()[:32]}.ply"
    if not path.is_file():
        unfinished = path.with_suffix(f".{os.getpid()}")
        unfinished.write_bytes(data)
        os.replace(unfinished, path)
    return str(path)


def folder():
    """Where the files lie: Blender removes it when it ends."""
    return Path(bpy.app.tempdir or tempfile.gettempdir()) / "sardf_meshes"


def _ply(item, mesh, matrix):
    if mesh is None or not len(mesh.polygons):
        raise PartError(f"the mesh '{item.name}' has no faces; a solid or a surface needs some")
    points = np.empty((len(mesh.vertices), 3), np.float32)
    mesh.vertices.foreach_get("co", points.reshape(-1))
    points = points.astype(np.float64)
    if matrix is not None:
        turn = np.array(matrix)
        points = points @ turn[:3, :3].T + turn[:3, 3]
    if not np.isfinite(points).all():
        raise PartError(f"the mesh '{item.name}' has points that are not finite")
    totals = np.empty(len(mesh.polygons), np.int32)
    starts = np.empty(len(mesh.polygons), np.int32)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.polygons.foreach_get("loop_total", totals)
    mesh.polygons.foreach_get("loop_start", starts)
    mesh.loops.foreach_get("vertex_index", corners)
    # One stream: each face's count ahead of its corners.
    faces = np.insert(corners, starts, totals).astype("<i4")
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(points)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(totals)}\nproperty list int int vertex_indices\nend_header\n"
    )
    return header.encode() + points.astype("<f8").tobytes() + faces.tobytes()
