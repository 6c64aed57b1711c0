# SPDX-License-Identifier: GPL-3.0-or-later
"""The Principled material of a baked part, and the plain materials that comparisons render."""

import warnings
from dataclasses import dataclass

import bpy

from . import exact, groups

# Socket names: the first that exists is used (Blender 4.0 renamed Emission).
SOCKETS = {
    "base_color": ("Base Color",),
    "roughness": ("Roughness",),
    "metallic": ("Metallic",),
    "emission": ("Emission Color", "Emission"),
}
NORMAL = "normal"  # the channel that Principled reads through a Normal Map node
FRACTIONS = "fractions_"  # how the names of images of three fractions each begin
# From an attribute to the direction of Principled's anisotropy.
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


def build(name):
    """A new Principled material, for `update`."""
    material = bpy.data.materials.new(name)
    tree = use_nodes(material)
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    shader.location, output.location = (300, 400), (700, 400)
    # Zero lets Cycles drop the emission; a black texture would make each face a lamp to sample.
    shader.inputs["Emission Strength"].default_value = 0.0
    return material


def is_ours(material):
    """Whether a bake made it: `update` leaves materials of the user's alone."""
    tree = material.node_tree
    return tree is not None and any(n.name.startswith(groups.PREFIX) for n in tree.nodes)


@dataclass
class Content:
    """What a material shows: {image's name: image}, the scene's materials' names, the names of the
    mesh's attributes for fractions and for the scene's attributes, the one along which metal is
    brushed or "", the UV map's name, whether anything gives off light, and the OSL text with its
    outputs or None."""

    images: dict
    materials: list
    fractions: list
    attributes: list
    tangent: str
    layer: str
    glows: bool
    osl: tuple | None = None


def update(material, content):
    """Make or renew our nodes; whatever else the user built stays."""
    tree = groups.Tree(material)
    images = content.images
    uv = groups.uv_map(tree, content.layer) if images else None
    _textures(tree, images, uv, content.glows)
    if NORMAL in images:
        groups.normal_map(tree, images[NORMAL], uv, content.layer)
    if content.tangent:
        _tangent(tree, content.tangent)
    groups.attributes(tree, "Fractions", content.fractions)
    groups.attributes(tree, "Attributes", content.attributes)
    masks = {name: shown for name, shown in images.items() if name.startswith(FRACTIONS)}
    groups.masks(tree, masks, content.materials, uv)
    rest = {n: shown for n, shown in images.items() if n not in (*SOCKETS, NORMAL, *masks)}
    groups.more_textures(tree, rest, uv)
    exact.update(tree, content.osl, SOCKETS)
    tree.finish()


def _textures(tree, images, uv, glows):
    """The images that Principled reads; an emission of strength 0 gets 1 if anything glows."""
    shader = tree.shader()
    for row, channel in enumerate(SOCKETS):
        if channel not in images:
            continue
        is_new = groups.node_name(channel) not in tree.tree.nodes
        node = groups.image(tree, channel, "Textures", row, uv, images[channel])
        if node is None or shader is None:
            continue
        if channel == "base_color":  # the one that solid shading with textures shows
            tree.tree.nodes.active = node
        if is_new:
            socket = next(s for n in SOCKETS[channel] if (s := shader.inputs.get(n)) is not None)
            tree.link(node.outputs["Color"], socket)
        if channel == "emission" and glows:
            strength = shader.inputs["Emission Strength"]
            strength.default_value = strength.default_value or 1.0


def _tangent(tree, attribute):
    """Metal reflects as if brushed along a vector attribute of the mesh, where Principled's Tangent
    is free and a metallic image is read: attribute -> from the object's axes to the world's ->
    unit length -> Tangent, and metallic * ANISOTROPIC -> Anisotropic."""
    shader = tree.shader()
    metallic = tree.tree.nodes.get(groups.node_name("metallic"))
    is_new = groups.node_name(TANGENT_NODES[0]) not in tree.tree.nodes
    if shader is None or metallic is None or (is_new and shader.inputs["Tangent"].is_linked):
        return
    kinds = ("Attribute", "VectorTransform", "VectorMath", "Math")
    source, turned, unit, strength = (
        tree.node(f"ShaderNode{kind}", name, "Brushed metal", 200 * place)
        for place, (kind, name) in enumerate(zip(kinds, TANGENT_NODES, strict=True))
    )
    if source is not None:
        source.attribute_type, source.attribute_name = "GEOMETRY", attribute
    if not is_new or None in (source, turned, unit, strength):
        return
    turned.vector_type, turned.convert_from, turned.convert_to = "VECTOR", "OBJECT", "WORLD"
    unit.operation = "NORMALIZE"
    strength.operation = "MULTIPLY"
    strength.inputs[1].default_value = ANISOTROPIC
    tree.link(source.outputs["Vector"], turned.inputs["Vector"])
    tree.link(turned.outputs["Vector"], unit.inputs[0])
    tree.link(unit.outputs["Vector"], shader.inputs["Tangent"])
    tree.link(metallic.outputs["Color"], strength.inputs[0])
    tree.link(strength.outputs["Value"], shader.inputs["Anisotropic"])
    shader.inputs["Anisotropic Rotation"].default_value = ACROSS


def build_flat(image):
    """Emission of the base colour alone: what the picture shows is the texture's value."""
    tree, output, material = _bare("sardf flat")
    tree.links.new(_emission(tree, _texture(tree, image)), output.inputs["Surface"])
    return material


def build_matte(image):
    """A diffuse surface of the base colour: what it shows is light times the texture's value."""
    tree, output, material = _bare("sardf matte")
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    tree.links.new(_texture(tree, image), shader.inputs["Color"])
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


def _texture(tree, image):
    node = tree.nodes.new("ShaderNodeTexImage")
    node.location, node.extension, node.image = (-400, 0), "EXTEND", image
    return node.outputs["Color"]


def _emission(tree, color):
    node = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(color, node.inputs["Color"])
    return node.outputs["Emission"]
