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
NORMAL = "normal"  # the channel that Principled reads through a Normal Map node
READ = (*SOCKETS, NORMAL)  # the channels that the material reads
# What set_tangent makes: from an attribute to the direction of Principled's anisotropy.
TANGENT_NODES = ("tangent attribute", "tangent in world", "tangent", "anisotropic")
ANISOTROPIC = 0.8  # of pure metal
# Of a full turn: Principled stretches reflections along the tangent, and brushed metal does across
# its scratches.
ACROSS = 0.25


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


def set_normal_map(material, image):
    """Let Principled's Normal read a tangent-space normal map; None ends that.

    The nodes are made once, where Normal is free. They mean the mesh's first UV map.
    """
    tree = material.node_tree
    names = [node_name(NORMAL), node_name("normal map")]
    if image is None:
        for name in filter(tree.nodes.__contains__, names):
            tree.nodes.remove(tree.nodes[name])
        return
    if names[0] not in tree.nodes:
        shader = next((n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"), None)
        if shader is None or shader.inputs["Normal"].is_linked:
            return
        source = _image_node(tree, NORMAL, (-700, -1200))
        bent = _node(tree, "ShaderNodeNormalMap", "normal map", (-400, -1200))
        bent.space = "TANGENT"
        tree.links.new(source.outputs["Color"], bent.inputs["Color"])
        tree.links.new(bent.outputs["Normal"], shader.inputs["Normal"])
    tree.nodes[names[0]].image = image


def set_tangent(material, attribute):
    """Let metal reflect as if brushed along a vector attribute of the mesh; "" ends that.

    The nodes are made once, where Principled's Tangent is free and a metallic image is read; then
    only the attribute's name changes, so that what the user did to them stays.
    """
    tree = material.node_tree
    if not attribute:
        for name in map(node_name, TANGENT_NODES):
            if name in tree.nodes:
                tree.nodes.remove(tree.nodes[name])
        return
    if node_name(TANGENT_NODES[0]) not in tree.nodes:
        shader = next((n for n in tree.nodes if n.type == "BSDF_PRINCIPLED"), None)
        metallic = tree.nodes.get(node_name("metallic"))
        if shader is None or metallic is None or shader.inputs["Tangent"].is_linked:
            return
        _add_tangent(tree, shader, metallic)
    tree.nodes[node_name(TANGENT_NODES[0])].attribute_name = attribute


def _add_tangent(tree, shader, metallic):
    """Attribute -> from the object's axes to the world's -> unit length -> Tangent, and
    metallic * ANISOTROPIC -> Anisotropic."""
    kinds = ("Attribute", "VectorTransform", "VectorMath", "Math")
    source, turned, unit, strength = (
        _node(tree, f"ShaderNode{kind}", name, (-900 + 200 * place, -900))
        for place, (kind, name) in enumerate(zip(kinds, TANGENT_NODES, strict=True))
    )
    source.attribute_type = "GEOMETRY"
    turned.vector_type, turned.convert_from, turned.convert_to = "VECTOR", "OBJECT", "WORLD"
    unit.operation = "NORMALIZE"
    strength.operation = "MULTIPLY"
    strength.inputs[1].default_value = ANISOTROPIC
    tree.links.new(source.outputs["Vector"], turned.inputs["Vector"])
    tree.links.new(turned.outputs["Vector"], unit.inputs[0])
    tree.links.new(unit.outputs["Vector"], shader.inputs["Tangent"])
    tree.links.new(metallic.outputs["Color"], strength.inputs[0])
    tree.links.new(strength.outputs["Value"], shader.inputs["Anisotropic"])
    shader.inputs["Anisotropic Rotation"].default_value = ACROSS


def build_flat(image):
    """Emission of the base colour alone: what the picture shows is the texture's value."""
    tree, output, material = _bare("sardf flat")
    node = _image_node(tree, "base_color", (-400, 0))
    node.image = image
    tree.links.new(_emission(tree, node.outputs["Color"]), output.inputs["Surface"])
    return material


def build_matte(image):
    """A diffuse surface of the base colour: what it shows is light times the texture's value."""
    tree, output, material = _bare("sardf matte")
    node = _image_node(tree, "base_color", (-400, 0))
    node.image = image
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    tree.links.new(node.outputs["Color"], shader.inputs["Color"])
    tree.links.new(shader.outputs["BSDF"], output.inputs["Surface"])
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
    node = _node(tree, "ShaderNodeTexImage", channel, location)
    node.interpolation = "Linear"
    node.extension = "EXTEND"
    return node


def _node(tree, kind, name, location):
    node = tree.nodes.new(kind)
    node.name = node.label = node_name(name)
    node.location = location
    return node
