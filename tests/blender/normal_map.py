# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows the normals that Cycles makes of a baked normal map; ... -- PART.blend RESULT.npz

A part is seen from above, 2.4 units wide. "positions" and "normals" are what Cycles says of each
pixel, the normals through the part's Normal Map node, "smooth" without it. "decoded" are normals of
the map at the texels nearest to the middles of the triangles, by the tangents that Blender makes of
the mesh, and "at" those middles.
"""

import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from seen_from_above import look_from_above, rendered_vectors, see_points

PIXELS, WIDTH = 64, 2.4


def read(items, name, size):
    values = np.empty(len(items) * size, dtype=np.float32)
    items.foreach_get(name, values)
    return values.reshape(-1, size).astype(float)


def decoded(data, image):
    """Middles of the mesh's triangles, and the normals that the map says there."""
    data.calc_tangents(uvmap=data.uv_layers[0].name)
    normal, tangent = read(data.loops, "normal", 3), read(data.loops, "tangent", 3)
    sign = read(data.loops, "bitangent_sign", 1)
    uv, place = read(data.uv_layers[0].data, "uv", 2), read(data.vertices, "co", 3)
    vertex = np.array([loop.vertex_index for loop in data.loops])
    data.calc_loop_triangles()
    corners = np.array([list(triangle.loops) for triangle in data.loop_triangles])
    width, height = image.size
    pixels = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, 4)[..., :3].astype(float)
    # The middle of the texel nearest to the triangle's middle, if the triangle covers it.
    column, row = np.floor(uv[corners].mean(axis=1) * (width, height)).astype(int).T
    middle = (np.stack([column, row], axis=-1) + 0.5) / (width, height)
    a, b, c = uv[corners].transpose(1, 0, 2)
    basis = np.stack([b - a, c - a], axis=-1)
    large = np.abs(np.linalg.det(basis)) * width * height > 8  # texels, twice
    inner = np.linalg.solve(basis[large], (middle - a)[large][..., None])[..., 0]
    weight = np.concatenate([1 - inner.sum(axis=1, keepdims=True), inner], axis=1)
    covered = weight.min(axis=1) > 0

    def mixed(values):
        return (values[corners[large]] * weight[..., None]).sum(axis=1)

    t, n, s = mixed(tangent), mixed(normal), mixed(sign)
    color = pixels[row[large], column[large]] * 2 - 1
    bent = color[:, :1] * t + color[:, 1:2] * s * np.cross(n, t) + color[:, 2:] * n
    bent /= np.linalg.norm(bent, axis=1, keepdims=True)
    return mixed(place[vertex])[covered], bent[covered]


def main(blend, result_file):
    bpy.ops.wm.open_mainfile(filepath=blend)
    scene = bpy.context.scene
    look_from_above(scene, WIDTH, PIXELS)
    see_points(scene)
    scene.world = None  # black beside the part
    part = next(item for item in scene.objects if item.type == "MESH")
    tree = part.data.materials[0].node_tree
    bent = tree.nodes["sardf normal map"].outputs["Normal"]
    arrays = {"linked": bent.links[0].to_socket.name}
    image = tree.nodes["sardf normal"].image
    arrays["colorspace"] = image.colorspace_settings.name
    arrays["at"], arrays["decoded"] = decoded(part.data, image)
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    arrays["normals"] = rendered_vectors(scene, tree, bent)
    arrays["smooth"] = rendered_vectors(scene, tree, geometry.outputs["Normal"])
    arrays["positions"] = rendered_vectors(scene, tree, geometry.outputs["Position"], largest=2.0)
    np.savez(result_file, **arrays)


main(*sys.argv[sys.argv.index("--") + 1 :])
