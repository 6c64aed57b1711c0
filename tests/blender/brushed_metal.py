# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders how the part.blend of headless.py is brushed; run as: ... -- PART.blend RESULT.npz

A plate is seen straight from above, 4 units wide. The result has "tangents", the vectors that reach
Principled's Tangent, "turned", those of the attribute along_x with the object turned by 90 degrees
around z, "highlight", the reflection of a small lamp in a plate that is brushed along x, and
"links", what is linked to the shader as JSON.
"""

import json
import math
import sys
from pathlib import Path

import bpy
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from seen_from_above import look_from_above, rendered, rendered_vectors

PIXELS, WIDTH = 60, 4.0


def links_of(tree, shader):
    return {
        link.to_socket.name: [link.from_node.name, link.from_socket.name]
        for link in tree.links
        if link.to_node == shader
    }


def light_one_lamp(scene):
    """Nothing but a small lamp above the plate's middle shines."""
    for lamp in [item for item in scene.objects if item.type == "LIGHT"]:
        bpy.data.objects.remove(lamp)
    scene.world = None
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
    lamp.location.z = 4.0
    lamp.data.energy, lamp.data.shadow_soft_size = 100.0, 0.01
    scene.collection.objects.link(lamp)


def main(blend, result_file):
    bpy.ops.wm.open_mainfile(filepath=blend)
    scene = bpy.context.scene
    look_from_above(scene, WIDTH, PIXELS)
    part = next(item for item in scene.objects if item.type == "MESH")
    tree = part.data.materials[0].node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    attribute = tree.nodes["sardf tangent attribute"]
    links = links_of(tree, shader) | {"attribute": attribute.attribute_name}
    tangent = shader.inputs["Tangent"].links[0].from_socket
    arrays = {"tangents": rendered_vectors(scene, tree, tangent)}
    attribute.attribute_name = "along_x"
    part.rotation_euler.z = math.pi / 2
    arrays["turned"] = rendered_vectors(scene, tree, tangent)
    part.rotation_euler.z = 0.0
    light_one_lamp(scene)
    arrays["highlight"] = rendered(scene, 32)
    np.savez(result_file, links=json.dumps(links), **arrays)


main(*sys.argv[sys.argv.index("--") + 1 :])
