# SPDX-License-Identifier: GPL-3.0-or-later
"""The Principled material of a baked part, and the plain materials that comparisons render."""

import warnings

import bpy

# Socket names: the first that exists is used (Blender 4.0 renamed Emission).
SOCKETS = {
    "base_color": ("Base Color",),
    "roughness": ("Roughness",),
    "metallic": ("Metallic",),
    "emission": ("Emission Color", "Emission"),
}


def use_nodes(owner):
    """Switch a material or world to nodes; 5.0 always has them and warns about the switch."""
    if not owner.node_tree:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)
            owner.use_nodes = True
    return owner.node_tree


def node_name(channel):
    return f"sardf {channel}"


def build(name, images):
    """A Principled material reading the images of SOCKETS' channels that are given."""
    material = bpy.data.materials.new(name)
    tree = use_nodes(material)
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    for row, channel in enumerate(c for c in SOCKETS if c in images):
        node = _image_node(tree, channel, (-400, 300 - 290 * row))
        socket = next(s for n in SOCKETS[channel] if (s := shader.inputs.get(n)) is not None)
        tree.links.new(node.outputs["Color"], socket)
    # Zero lets Cycles drop the emission; a black texture would make each face a lamp to sample.
    shader.inputs["Emission Strength"].default_value = 0.0
    return material


def assign_images(material, images, glows):
    """Put images into the nodes that `build` made; whatever else the user built stays.

    `glows`: whether the emission image holds anything; then an emission of strength 0 gets 1.
    """
    for channel, image in images.items():
        node = material.node_tree.nodes.get(node_name(channel))
        if node is not None:
            node.image = image
            if channel == "base_color":  # the one that solid shading with textures shows
                material.node_tree.nodes.active = node
    for shader in (n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED"):
        strength = shader.inputs["Emission Strength"]
        if glows and strength.default_value == 0.0:
            strength.default_value = 1.0


def build_flat(image):
    """Emission of the base colour alone: what the picture shows is the texture's value."""
    tree, output, material = _bare("sardf flat")
    node = _image_node(tree, "base_color", (-400, 0))
    node.image = image
    tree.links.new(_emission(tree, node.outputs["Color"]), output.inputs["Surface"])
    return material


def build_normals():
    """Emission of the world shading normal n as the colour n * 0.5 + 0.5."""
    tree, output, material = _bare("sardf normals")
    scale = tree.nodes.new("ShaderNodeVectorMath")
    scale.operation = "MULTIPLY_ADD"
    scale.inputs[1].default_value = scale.inputs[2].default_value = (0.5, 0.5, 0.5)
    normal = tree.nodes.new("ShaderNodeNewGeometry").outputs["Normal"]
    tree.links.new(normal, scale.inputs[0])
    tree.links.new(_emission(tree, scale.outputs["Vector"]), output.inputs["Surface"])
    return material


def _bare(name):
    material = bpy.data.materials.new(name)
    tree = use_nodes(material)
    tree.nodes.clear()
    return tree, tree.nodes.new("ShaderNodeOutputMaterial"), material


def _emission(tree, color):
    node = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(color, node.inputs["Color"])
    return node.outputs["Emission"]


def _image_node(tree, channel, location):
    node = tree.nodes.new("ShaderNodeTexImage")
    node.name = node.label = node_name(channel)
    node.location = location
    node.interpolation = "Linear"
    node.extension = "EXTEND"
    return node
