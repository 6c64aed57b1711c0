# SPDX-License-Identifier: GPL-3.0-or-later
"""Soft lights and a neutral world around the object, placed as seen from the camera."""

import math

import bpy
from mathutils import Matrix, Vector

from ..baked import material

COLLECTION = "sardf studio"
WORLD = "sardf studio"

# name, direction to the light in the camera's axes (right, up, towards the camera), edge length
# in radii of the object, and the brightness it gives a white matte surface that faces it.
LIGHTS = (
    ("key", (-0.80, 0.75, 0.70), 6.5, 0.95),
    ("fill", (1.00, 0.05, 0.75), 6.5, 0.50),
    ("rim", (0.45, 0.75, -0.90), 5.0, 0.40),
)
DISTANCE = 5.0  # of each light from the object, in radii

# What the object sees, from straight below to straight above: position, linear grey. The dark band
# under the horizon gives polished metal its contrast.
SURROUNDINGS = ((0.0, 0.30), (0.40, 0.16), (0.52, 0.40), (0.75, 0.55), (1.0, 0.80))
# What the camera sees behind the object, from the picture's lower to its upper edge, linear.
BACKDROP = ((0.0, (0.84, 0.85, 0.86, 1.0)), (1.0, (0.52, 0.55, 0.59, 1.0)))


def build(scene, centre, radius, camera):
    """(Re)make our lights and world for an object in a ball, seen by the object `camera`."""
    collection = bpy.data.collections.get(COLLECTION)
    if collection is None:
        collection = bpy.data.collections.new(COLLECTION)
    if collection.name not in scene.collection.children:
        scene.collection.children.link(collection)
    for item in list(collection.objects):
        bpy.data.lights.remove(item.data)
    axes = camera.matrix_world.to_3x3().normalized()
    for name, direction, edge, brightness in LIGHTS:
        towards = (axes @ Vector(direction)).normalized()
        collection.objects.link(_light(name, centre, towards, radius, edge, brightness))
    scene.world = _world()


def _light(name, centre, towards, radius, edge, brightness):
    data = bpy.data.lights.new(f"sardf {name}", "AREA")
    data.shape = "DISK"
    data.size = edge * radius
    # A disk of power P gives a facing surface at distance d the irradiance P / (pi d^2) near its
    # axis, and white matte paint shows that divided by pi.
    data.energy = brightness * math.pi**2 * (DISTANCE * radius) ** 2
    item = bpy.data.objects.new(data.name, data)
    rotation = towards.to_track_quat("Z", "Y")  # a light shines along its -Z
    position = Vector(centre) + towards * DISTANCE * radius
    item.matrix_world = Matrix.LocRotScale(position, rotation, None)
    item.visible_camera = False
    return item


def _world():
    """A world that lights softly from above; the camera sees a plain gradient instead."""
    world = bpy.data.worlds.get(WORLD)
    if world is None:
        world = bpy.data.worlds.new(WORLD)
    tree = material.use_nodes(world)
    tree.nodes.clear()
    # A smooth world needs no finer importance map; the automatic one takes a second to make.
    world.cycles.sampling_method = "MANUAL"
    world.cycles.sample_map_resolution = 128
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    # The direction's z, in [-1, 1], to the ramp's [0, 1].
    height = _separate_z(tree, coordinates.outputs["Generated"])
    scaled = _multiply_add(tree, height, 0.5, 0.5)
    light = _ramp(tree, scaled, [(at, (grey, grey, grey, 1.0)) for at, grey in SURROUNDINGS])
    backdrop = _ramp(tree, _separate_y(tree, coordinates.outputs["Window"]), BACKDROP)
    mix = tree.nodes.new("ShaderNodeMixShader")
    path = tree.nodes.new("ShaderNodeLightPath")
    tree.links.new(path.outputs["Is Camera Ray"], mix.inputs["Fac"])
    tree.links.new(_background(tree, light), mix.inputs[1])
    tree.links.new(_background(tree, backdrop), mix.inputs[2])
    output = tree.nodes.new("ShaderNodeOutputWorld")
    tree.links.new(mix.outputs["Shader"], output.inputs["Surface"])
    return world


def _separate_z(tree, vector):
    return _separate(tree, vector).outputs["Z"]


def _separate_y(tree, vector):
    return _separate(tree, vector).outputs["Y"]


def _separate(tree, vector):
    node = tree.nodes.new("ShaderNodeSeparateXYZ")
    tree.links.new(vector, node.inputs["Vector"])
    return node


def _multiply_add(tree, value, factor, offset):
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = "MULTIPLY_ADD"
    tree.links.new(value, node.inputs[0])
    node.inputs[1].default_value = factor
    node.inputs[2].default_value = offset
    return node.outputs["Value"]


def _ramp(tree, value, stops):
    node = tree.nodes.new("ShaderNodeValToRGB")
    elements = node.color_ramp.elements
    while len(elements) < len(stops):
        elements.new(1.0)
    for element, (position, color) in zip(elements, stops, strict=True):
        element.position = position
        element.color = color
    tree.links.new(value, node.inputs["Fac"])
    return node.outputs["Color"]


def _background(tree, color):
    node = tree.nodes.new("ShaderNodeBackground")
    tree.links.new(color, node.inputs["Color"])
    return node.outputs["Background"]
