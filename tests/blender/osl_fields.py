# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows what OSL in Cycles computes of a scene; ... -- SHADER.osl RESULT.npz

A tilted plane of 32 x 32 pixels is seen along its normal. The result has "positions", (1024, 3),
and "values", (1024, names), of the shader's outputs, both as Cycles has them in single precision.
"""

import sys
from pathlib import Path

import bpy
import numpy as np
from mathutils import Euler, Matrix

sys.path.insert(0, str(Path(__file__).resolve().parent))
from seen_from_above import look_from_above, rendered_vectors, see_points

PIXELS = 32
FARTHEST = 32.0  # from 0, of what is shown


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
    look_from_above(scene, 6, PIXELS, turn @ Matrix.Translation((0, 0, 20)))
    see_points(scene)
    scene.cycles.shading_system = True
    return plane


def shown(scene, tree, sockets):
    """(1024, up to 3) of as many outputs that are numbers."""
    joined = tree.nodes.new("ShaderNodeCombineXYZ")
    for place, socket in enumerate(sockets):
        tree.links.new(socket, joined.inputs[place])
    values = rendered_vectors(scene, tree, joined.outputs[0], FARTHEST)
    tree.nodes.remove(joined)
    return values.reshape(-1, 3)[:, : len(sockets)]


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
    places = rendered_vectors(scene, tree, geometry.outputs["Position"], FARTHEST)
    arrays = {"positions": places.reshape(-1, 3)}
    outputs = list(node.outputs)
    columns = [
        shown(scene, tree, outputs[first : first + 3]) for first in range(0, len(outputs), 3)
    ]
    arrays["values"] = np.concatenate(columns, axis=1)
    arrays["names"] = np.array([output.name for output in outputs])
    np.savez(result_file, **arrays)


main(*sys.argv[sys.argv.index("--") + 1 :])
