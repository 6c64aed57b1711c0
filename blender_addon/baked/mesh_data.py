# SPDX-License-Identifier: GPL-3.0-or-later
"""Arrays to a Blender mesh with UVs, custom normals, and materials and attributes at its points."""

import functools
import math

import bpy
import numpy as np

from . import job


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


LAYER = "UVMap"  # the UV map of a mesh that was made here
MADE = "sardf_attributes"  # custom property of a mesh: our attributes, which a bake may renew


def build(name, mesh):
    """A new bpy Mesh from a sardf mesh with texture coordinates, or without."""
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
    uv = mesh.uv
    if len(uv):
        data.uv_layers.new(name=LAYER).data.foreach_set("uv", _floats(uv[corners]))
    data.update(calc_edges=True)
    set_normals(data, mesh.normals[corners])
    return data


def set_normals(data, normals):
    """Give each corner its normal, (corners, 3) unit vectors."""
    if hasattr(data, "use_auto_smooth"):  # until Blender 4.0 custom normals need it
        data.use_auto_smooth = True
        data.auto_smooth_angle = math.pi
    data.normals_split_custom_set(np.asarray(normals, dtype=np.float32).tolist())


def forget_attributes(data):
    """Remove the attributes that an earlier bake made; others of the same names are the user's."""
    for name in filter(None, data.get(MADE, "").split("\n")):
        if name in data.attributes:
            data.attributes.remove(data.attributes[name])


def remember_attributes(data, names):
    data[MADE] = "\n".join(names)


def set_fractions(data, fractions, materials):
    """One FLOAT point attribute with the volume fraction of each material, named after it; returns
    the names that they got."""
    return [
        _add(data, material, "FLOAT", "value", fractions[:, column])
        for column, material in enumerate(materials)
    ]


def set_attributes(data, attributes):
    """Point attributes from {name: (V,) or (V, components)}; returns {name: the names it got}.

    Numbers become FLOAT, vectors of 2 or 3 components FLOAT_VECTOR, where a missing z is 0, and
    longer ones a FLOAT for each component: name_1, name_2, ... What is not finite becomes 0.
    """
    names = {}
    for name, values in attributes.items():
        values = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
        if values.ndim == 1:
            names[name] = [_add(data, name, "FLOAT", "value", values)]
        elif values.shape[1] <= 3:
            vectors = np.zeros((len(values), 3))
            vectors[:, : values.shape[1]] = values
            names[name] = [_add(data, name, "FLOAT_VECTOR", "vector", vectors)]
        else:
            names[name] = [
                _add(data, f"{name}_{column + 1}", "FLOAT", "value", values[:, column])
                for column in range(values.shape[1])
            ]
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


def read(data, layer, matrix, name):
    """A bpy Mesh as a job.GivenMesh of triangles, `matrix` from its own frame to the scene's.

    `layer`: the name of the UV map. Blender's own triangles, normals included.
    """
    if hasattr(data, "calc_normals_split"):  # until Blender 4.0
        data.calc_normals_split()
    data.calc_loop_triangles()
    corners = _values(data.loop_triangles, "loops", 3, np.int32)
    vertices = _values(data.loop_triangles, "vertices", 3, np.int32)
    places = _values(data.vertices, "co", 3, np.float32).astype(float)
    if hasattr(data, "corner_normals"):
        normals = _values(data.corner_normals, "vector", 3, np.float32)
    else:
        normals = _values(data.loops, "normal", 3, np.float32)
    uv = _values(data.uv_layers[layer].data, "uv", 2, np.float32)
    four = [0, 1, 2, 2]  # a triangle repeats its last corner
    turned = np.array(matrix.to_3x3().inverted().transposed())
    bent = normals[corners[:, four]].reshape(-1, 3).astype(float) @ turned.T
    length = (bent * bent).sum(axis=1, keepdims=True) ** 0.5
    whole = np.array(matrix)
    return job.GivenMesh(
        name=name,
        vertices=places @ whole[:3, :3].T + whole[:3, 3],
        faces=vertices[:, four].astype(np.uint32),
        normals=bent / np.maximum(length, 1e-30),
        uv=uv[corners[:, four]].reshape(-1, 2).astype(float),
    )


def _values(items, member, size, kind):
    values = np.empty(len(items) * size, dtype=kind)
    items.foreach_get(member, values)
    return values.reshape(-1, size)
