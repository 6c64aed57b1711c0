# SPDX-License-Identifier: GPL-3.0-or-later
"""A part seen straight from above (or along any direction) by Cycles, as numbers: of its light, or
of a socket's vectors."""

import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix


def look_from_above(scene, width, pixels, matrix=None):
    """Square pictures `width` units wide, of a camera 20 above the ground or at `matrix`; OpenEXR,
    so that nothing is rounded or encoded."""
    camera = bpy.data.objects.new("above", bpy.data.cameras.new("above"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", width
    camera.matrix_world = Matrix.Translation((0, 0, 20)) if matrix is None else matrix
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = pixels
    scene.render.resolution_percentage = 100
    scene.cycles.use_denoising = False
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"


def see_points(scene):
    """Each pixel is what its middle shows, instead of a mean."""
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01


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


def rendered_color(scene, tree, color):
    """(rows, columns, 3) of a socket of the material's tree, which is as it was afterwards."""
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    links = output.inputs["Surface"].links
    before = links[0].from_socket if links else None
    glow = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(color, glow.inputs["Color"])
    tree.links.new(glow.outputs["Emission"], output.inputs["Surface"])
    values = rendered(scene, 1).astype(float)
    tree.nodes.remove(glow)
    if before is not None:
        tree.links.new(before, output.inputs["Surface"])
    return values


def rendered_vectors(scene, tree, vectors, largest=1.0):
    """The same of vectors, whose components are at most `largest`; -largest beside the part."""
    scaled = tree.nodes.new("ShaderNodeVectorMath")
    scaled.operation = "MULTIPLY_ADD"
    scaled.inputs[1].default_value = (0.5 / largest,) * 3
    scaled.inputs[2].default_value = (0.5,) * 3
    tree.links.new(vectors, scaled.inputs[0])
    values = rendered_color(scene, tree, scaled.outputs["Vector"])
    tree.nodes.remove(scaled)
    return (values - 0.5) * 2 * largest
