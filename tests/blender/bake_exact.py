# SPDX-License-Identifier: GPL-3.0-or-later
"""A graded sphere baked with exact shading, where this Blender has OSL; run by part_run.py with a
scene file. The result has the colours of 48 x 48 pixels by the shader and by the textures, and the
points that they show."""

import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from sardf_blender.baked import exact, groups

PIXELS = 48
WIDTH, RANGE = 12, 16.0


def main(scene_file):
    for folder in Path(bpy.utils.resource_path("LOCAL")).glob("python/lib/*/site-packages"):
        sys.path.append(str(folder))  # the bpy wheel keeps its compiler of shaders there
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    settings = scene.sardf
    settings.filepath, settings.resolution, settings.size = scene_file, 96, "1024"
    settings.exact_shading = True
    finished = bpy.ops.sardf.bake() == {"FINISHED"}
    item = bpy.context.view_layer.objects.active
    tree = item.data.materials[0].node_tree
    names = (exact.SCRIPT, exact.SWITCH)
    result = {"is there": exact.is_there(), "finished": finished, "nodes": ours(tree, names)}
    if result["nodes"]:
        result |= pictures(scene, tree)
    settings.exact_shading = False
    bpy.ops.sardf.bake()
    result["nodes after"] = ours(tree, names)
    shader = next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED")
    result["base color from"] = shader.inputs["Base Color"].links[0].from_node.name
    return result


def ours(tree, names):
    return [name for each in names if (name := groups.node_name(each)) in tree.nodes]


def pictures(scene, tree):
    camera = bpy.data.objects.new("above", bpy.data.cameras.new("above"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", WIDTH
    camera.location.z = 20
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.resolution_x = scene.render.resolution_y = PIXELS
    scene.render.resolution_percentage = 100
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    switch = tree.nodes[groups.node_name(exact.SWITCH)].outputs[0]
    mixed = tree.nodes[groups.node_name("exact base_color")]
    color = next(socket for socket in mixed.outputs if socket.identifier == "Result_Color")
    place = tree.nodes.new("ShaderNodeVectorMath")
    place.operation = "MULTIPLY_ADD"
    place.inputs[1].default_value = (1 / RANGE,) * 3
    place.inputs[2].default_value = (0.5,) * 3
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    tree.links.new(geometry.outputs["Position"], place.inputs[0])
    result = {"switch": switch.default_value}
    seen = (picture(scene, tree, place.outputs["Vector"]) - 0.5) * RANGE
    hit = np.abs(seen).max(axis=-1) < WIDTH / 2  # what is beside the part is black
    result["positions"] = np.where(hit[:, None], seen, 0).tolist()
    result["shader"] = picture(scene, tree, color).tolist()
    switch.default_value = 0.0
    result["textures"] = picture(scene, tree, color).tolist()
    return result


def picture(scene, tree, color):
    """(pixels, 3) of what glows in a socket's colour."""
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    before = output.inputs["Surface"].links[0].from_socket
    glow = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(color, glow.inputs["Color"])
    tree.links.new(glow.outputs["Emission"], output.inputs["Surface"])
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = str(Path(folder) / "picture.exr")
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(scene.render.filepath)
        values = np.empty(PIXELS * PIXELS * 4, dtype=np.float32)
        image.pixels.foreach_get(values)
        bpy.data.images.remove(image)
    tree.nodes.remove(glow)
    tree.links.new(before, output.inputs["Surface"])
    return values.reshape(-1, 4)[:, :3].astype(float)
