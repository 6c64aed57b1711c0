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
import tempfile
from pathlib import Path

import bpy
import numpy as np

PIXELS = 60


def look_from_above(scene):
    camera = bpy.data.objects.new("above", bpy.data.cameras.new("above"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 4.0
    camera.location.z = 10.0
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = PIXELS
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"


def rendered(scene, samples):
    """The picture (rows, columns, 3), row 0 at the top, linear."""
    scene.cycles.samples = samples
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        values = np.empty(PIXELS * PIXELS * 4, dtype=np.float32)
        image.pixels.foreach_get(values)
        bpy.data.images.remove(image)
    return values.reshape(PIXELS, PIXELS, 4)[::-1, :, :3]


def links_of(tree, shader):
    return {
        link.to_socket.name: [link.from_node.name, link.from_socket.name]
        for link in tree.links
        if link.to_node == shader
    }


def show_vectors(tree, vectors):
    """The surface glows in the colour vector * 0.5 + 0.5."""
    scaled = tree.nodes.new("ShaderNodeVectorMath")
    scaled.operation = "MULTIPLY_ADD"
    scaled.inputs[1].default_value = scaled.inputs[2].default_value = (0.5, 0.5, 0.5)
    glow = tree.nodes.new("ShaderNodeEmission")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(vectors, scaled.inputs[0])
    tree.links.new(scaled.outputs["Vector"], glow.inputs["Color"])
    tree.links.new(glow.outputs["Emission"], output.inputs["Surface"])


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
    look_from_above(scene)
    part = next(item for item in scene.objects if item.type == "MESH")
    tree = part.data.materials[0].node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    attribute = tree.nodes["sardf tangent attribute"]
    links = links_of(tree, shader) | {"attribute": attribute.attribute_name}
    show_vectors(tree, shader.inputs["Tangent"].links[0].from_socket)
    arrays = {"tangents": rendered(scene, 1)}
    attribute.attribute_name = "along_x"
    part.rotation_euler.z = math.pi / 2
    arrays["turned"] = rendered(scene, 1)
    part.rotation_euler.z = 0.0
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(shader.outputs["BSDF"], output.inputs["Surface"])
    light_one_lamp(scene)
    arrays["highlight"] = rendered(scene, 32)
    np.savez(result_file, links=json.dumps(links), **arrays)


main(*sys.argv[sys.argv.index("--") + 1 :])
