# SPDX-License-Identifier: GPL-3.0-or-later
"""A graded sphere baked with exact shading, where this Blender has OSL; run by part_run.py with a
scene file. The result has the colours of 48 x 48 pixels by the shader and by the textures, and the
points that they show."""

import sys
from pathlib import Path

import bpy
import numpy as np
from sardf_blender.baked import exact, groups
from seen_from_above import look_from_above, rendered_color, rendered_vectors, see_points

PIXELS = 48
WIDTH, FARTHEST = 12, 8.0


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
    look_from_above(scene, WIDTH, PIXELS)
    see_points(scene)
    switch = tree.nodes[groups.node_name(exact.SWITCH)].outputs[0]
    mixed = tree.nodes[groups.node_name("exact base_color")]
    color = next(socket for socket in mixed.outputs if socket.identifier == "Result_Color")
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    result = {"switch": switch.default_value}
    seen = rendered_vectors(scene, tree, geometry.outputs["Position"], FARTHEST).reshape(-1, 3)
    hit = np.abs(seen).max(axis=-1) < WIDTH / 2  # what is beside the part is black
    result["positions"] = np.where(hit[:, None], seen, 0).tolist()
    result["shader"] = rendered_color(scene, tree, color).reshape(-1, 3).tolist()
    switch.default_value = 0.0
    result["textures"] = rendered_color(scene, tree, color).reshape(-1, 3).tolist()
    return result
