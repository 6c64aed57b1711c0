# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays to a Blender mesh with UVs, custom normals, and materials and attributes at its points."""

import functools
import math

import bpy
import numpy as np


def corner_layout(faces):
    """How quads with repeated last indices become polygons.

    `faces` (F,4); returns `keep` (F,4) bool, the corners that exist, and `starts` and `totals` (F,)
    of each polygon among the kept corners.
    """
    keep = np.ones(faces.shape, dtype=bool)
    keep[:, 3] = faces[:, 2] != faces[:, 3]
    totals = keep.sum(axis=1).astype(np.int32)
    starts = (np.cumsum(totals) - totals).astype(np.int32)
    return keep, starts, totals


def build(name, mesh, fractions, materials):
    """A new bpy Mesh from a sardf mesh, the (V, materials) fractions and the materials' names."""
    vertices, faces = mesh.vertices, mesh.faces  # each access copies
    keep, starts, totals = corner_layout(faces)
    data = bpy.data.meshes.new(name)
    data.vertices.add(len(vertices))
    data.vertices.foreach_set("co", _floats(vertices))
    data.loops.add(int(totals.sum()))
    data.loops.foreach_set("vertex_index", faces[keep].astype(np.int32))
    data.polygons.add(len(starts))
    data.polygons.foreach_set("loop_start", starts)
    if not bpy.types.MeshPolygon.bl_rna.properties["loop_total"].is_readonly:  # 4.1 derives it
        data.polygons.foreach_set("loop_total", totals)
    data.polygons.foreach_set("use_smooth", np.ones(len(starts), dtype=bool))
    corners = keep.reshape(-1)
    data.uv_layers.new(name="UVMap").data.foreach_set("uv", _floats(mesh.uv[corners]))
    data.update(calc_edges=True)
    set_normals(data, mesh.normals[corners])
    set_fractions(data, fractions, materials)
    return data


def set_normals(data, normals):
    """Give each corner its normal, (corners, 3) unit vectors."""
    if hasattr(data, "use_auto_smooth"):  # until Blender 4.0 custom normals need it
        data.use_auto_smooth = True
        data.auto_smooth_angle = math.pi
    data.normals_split_custom_set(np.asarray(normals, dtype=np.float32).tolist())


def set_fractions(data, fractions, materials):
    """One FLOAT point attribute with the volume fraction of each material, named after it."""
    for column, material in enumerate(materials):
        _add(data, material, "FLOAT", "value", fractions[:, column])


def set_attributes(data, attributes):
    """Point attributes from {name: (V,) or (V, components)}; returns {name: the name it got}.

    Numbers become FLOAT, vectors of 2 or 3 components FLOAT_VECTOR, where a missing z is 0, and
    longer ones a FLOAT for each component: name_1, name_2, ... What is not finite becomes 0.
    """
    names = {}
    for name, values in attributes.items():
        values = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
        if values.ndim == 1:
            names[name] = _add(data, name, "FLOAT", "value", values)
        elif values.shape[1] <= 3:
            vectors = np.zeros((len(values), 3))
            vectors[:, : values.shape[1]] = values
            names[name] = _add(data, name, "FLOAT_VECTOR", "vector", vectors)
        else:
            for column in range(values.shape[1]):
                _add(data, f"{name}_{column + 1}", "FLOAT", "value", values[:, column])
    return names


def _add(data, name, kind, member, values):
    """A point attribute; returns its name. One that the mesh has already, such as that of a
    material, or that Blender keeps for itself, such as position, gets .001 appended."""
    make = functools.partial(data.attributes.new, type=kind, domain="POINT")
    attribute = make(name=name) or make(name=f"{name}.001")
    attribute.data.foreach_set(member, _floats(values))
    return attribute.name


def _floats(array):
    return np.ascontiguousarray(array, dtype=np.float32).reshape(-1)
