# SPDX-License-Identifier: GPL-3.0-or-later
"""A part seen straight from above by Cycles, as numbers: of its light, or of a socket's vectors."""

import tempfile
from pathlib import Path

import bpy
import numpy as np


def look_from_above(scene, width, pixels):
    """Square pictures `width` units wide; OpenEXR, so that nothing is rounded or encoded."""
    camera = bpy.data.objects.new("above", bpy.data.cameras.new("above"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", width
    camera.location.z = 10.0
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = pixels
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"


def rendered(scene, samples):
    """(rows, columns, 3), row 0 at the top, linear."""
    scene.cycles.samples = samples
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        columns, rows = image.size
        values = np.empty(columns * rows * 4, dtype=np.float32)
        image.pixels.foreach_get(values)
        bpy.data.images.remove(image)
    return values.reshape(rows, columns, 4)[::-1, :, :3]


def rendered_vectors(scene, tree, vectors, largest=1.0):
    """The vectors of a socket of the material's tree, whose components are at most `largest`."""
    scaled = tree.nodes.new("ShaderNodeVectorMath")
    scaled.operation = "MULTIPLY_ADD"
    scaled.inputs[1].default_value = (0.5 / largest,) * 3
    scaled.inputs[2].default_value = (0.5,) * 3
    glow = tree.nodes.new("ShaderNodeEmission")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    tree.links.new(vectors, scaled.inputs[0])
    tree.links.new(scaled.outputs["Vector"], glow.inputs["Color"])
    tree.links.new(glow.outputs["Emission"], output.inputs["Surface"])
    return (rendered(scene, 1).astype(float) - 0.5) * 2 * largest
