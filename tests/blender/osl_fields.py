# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows what OSL in Cycles computes of a scene; ... -- SHADER.osl RESULT.npz

A tilted plane of 32 x 32 pixels is seen along its normal. The result has "positions", (1024, 3),
and "values", (1024, names), of the shader's outputs, both as Cycles has them in single precision.
"""

import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from mathutils import Euler, Vector

PIXELS = 32
RANGE = 64.0  # of what is shown, around 0


def python_of_blender():
    """The bpy wheel keeps oslquery where no path leads (in Blender itself it is found)."""
    for folder in Path(bpy.utils.resource_path("LOCAL")).glob("python/lib/*/site-packages"):
        sys.path.append(str(folder))


def look_at_plane(scene):
    """A square of edge 6 through (0.3, 0.2, 0.4), turned so that no axis lies in it."""
    bpy.ops.mesh.primitive_plane_add(size=6)
    plane = bpy.context.active_object
    plane.data.transform(plane.matrix_world)
    turn = Euler((0.5, 0.4, 0.3)).to_matrix().to_4x4()
    turn.translation = (0.3, 0.2, 0.4)
    plane.data.transform(turn)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 6
    shift = turn.copy()
    shift.translation = turn @ Vector((0, 0, 20))
    camera.matrix_world = shift
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = PIXELS
    scene.render.resolution_percentage = 100
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 0.01
    scene.cycles.shading_system = True
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    return plane


def rendered(scene, tree, sockets):
    """(1024, 3): up to three outputs."""
    scene.render.filepath = str(Path(tempfile.mkdtemp()) / "picture.exr")
    joined = tree.nodes.new("ShaderNodeCombineXYZ")
    scaled = tree.nodes.new("ShaderNodeVectorMath")
    scaled.operation = "MULTIPLY_ADD"
    scaled.inputs[1].default_value = (1 / RANGE,) * 3
    scaled.inputs[2].default_value = (0.5,) * 3
    glow = tree.nodes.new("ShaderNodeEmission")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    if len(sockets) == 1 and sockets[0].type == "VECTOR":
        tree.links.new(sockets[0], scaled.inputs[0])
    else:
        for place, socket in enumerate(sockets):
            tree.links.new(socket, joined.inputs[place])
        tree.links.new(joined.outputs[0], scaled.inputs[0])
    tree.links.new(scaled.outputs["Vector"], glow.inputs["Color"])
    tree.links.new(glow.outputs["Emission"], output.inputs["Surface"])
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    values = np.empty(PIXELS * PIXELS * 4, dtype=np.float32)
    image.pixels.foreach_get(values)
    bpy.data.images.remove(image)
    for node in (joined, scaled, glow):
        tree.nodes.remove(node)
    return (values.reshape(-1, 4)[:, :3].astype(float) - 0.5) * RANGE


def script_node(tree, text):
    from cycles import osl

    node = tree.nodes.new("ShaderNodeScript")
    node.mode = "INTERNAL"
    node.script = bpy.data.texts.new("fields.osl")
    node.script.write(text)
    said = []
    osl.update_script_node(node, lambda kind, message: said.append((kind, message)))
    assert node.outputs, said
    return node


def main(text_file, result_file):
    python_of_blender()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    plane = look_at_plane(scene)
    material = bpy.data.materials.new("osl")
    material.use_nodes = True
    plane.data.materials.append(material)
    tree = material.node_tree
    tree.nodes.remove(next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"))
    node = script_node(tree, Path(text_file).read_text())
    geometry = tree.nodes.new("ShaderNodeNewGeometry")
    arrays = {"positions": rendered(scene, tree, [geometry.outputs["Position"]])}
    outputs = list(node.outputs)
    columns = [
        rendered(scene, tree, outputs[first : first + 3])[:, : len(outputs[first : first + 3])]
        for first in range(0, len(outputs), 3)
    ]
    arrays["values"] = np.concatenate(columns, axis=1)
    arrays["names"] = np.array([output.name for output in outputs])
    np.savez(result_file, **arrays)


main(*sys.argv[sys.argv.index("--") + 1 :])
