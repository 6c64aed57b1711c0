# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's lights as the core describes them (core/sardf/stage.hpp)."""

import math

FULL_SPREAD = math.pi - 1e-4  # what an area light has unless it is narrowed
SAME_SCALE = 1e-4  # relative difference of the axes of a round spot
SHAPES = {"SQUARE": "rectangle", "RECTANGLE": "rectangle", "DISK": "ellipse", "ELLIPSE": "ellipse"}


def of_scene(view_layer, depsgraph):
    """(lights, warnings) of all that Cycles renders of a view layer."""
    made, warnings = [], []
    for item in rendered(view_layer):
        if item.type != "LIGHT":
            continue
        light, problems = light_of(item.evaluated_get(depsgraph))
        warnings += problems
        if light is not None:
            made.append(light)
    return made, warnings


def rendered(view_layer):
    """The objects of a view layer that are not hidden from renders, by themselves or by their
    collections."""
    found = {}
    waiting = [view_layer.layer_collection]
    while waiting:
        layer = waiting.pop()
        if layer.exclude or layer.collection.hide_render:
            continue
        found |= {item.name_full: item for item in layer.collection.objects}
        waiting += layer.children
    return [item for item in found.values() if not item.hide_render]


def light_of(item):
    """(light or None, warnings): a light object as a dictionary."""
    data = item.data
    warnings = _unsupported(item, data)
    if getattr(_cycles(data), "is_portal", False):
        return None, [f"the light '{item.name}' is a portal: it is left out"]
    light = {
        "name": item.name,
        "type": data.type.lower(),
        "matrix_world": [list(row) for row in item.matrix_world],
        "color": list(data.color),
        "power": data.energy,
        "exposure": getattr(data, "exposure", 0.0),  # since Blender 4.4
        "shadow": _casts_shadow(data),
    }
    if getattr(data, "use_temperature", False):  # since Blender 4.5
        light["tint"] = list(data.temperature_color)
    return light | _shape(data), warnings


def _shape(data):
    if data.type == "SUN":
        return {"angle": data.angle}
    if data.type == "AREA":
        one_size = data.shape in ("SQUARE", "DISK")
        return {
            "shape": SHAPES[data.shape],
            "size_x": data.size,
            "size_y": data.size if one_size else data.size_y,
        }
    ball = {
        "radius": data.shadow_soft_size,
        "soft_falloff": getattr(data, "use_soft_falloff", True),  # since Blender 4.1
    }
    if data.type == "SPOT":
        ball |= {"spot_size": data.spot_size, "spot_blend": data.spot_blend}
    return ball


def _casts_shadow(data):
    """Cycles' own property until Blender 4.1, then the light's."""
    return bool(getattr(_cycles(data), "cast_shadow", data.use_shadow))


def _cycles(data):
    """Cycles' properties of a light, or None where that add-on is not enabled."""
    return getattr(data, "cycles", None)


def _unsupported(item, data):
    """What of a light is not carried over, in sentences."""
    warnings, name = [], item.name
    scale = item.matrix_world.to_scale()
    if data.type == "SPOT" and max(scale) - min(scale) > SAME_SCALE * max(scale):
        warnings.append(f"the uneven scale of the light '{name}' is not carried over")
    linking = getattr(item, "light_linking", None)  # since Blender 4.0
    if linking and (linking.receiver_collection or linking.blocker_collection):
        warnings.append(f"the light linking of '{name}' is not carried over")
    if data.type == "AREA" and data.spread < FULL_SPREAD:
        warnings.append(f"the spread of the light '{name}' is not carried over")
    if not getattr(data, "normalize", True):
        warnings.append(f"the light '{name}' is not normalised; its power is taken as if it were")
    if data.use_nodes and data.node_tree is not None and not _is_plain(data.node_tree):
        kinds = {node.type for node in data.node_tree.nodes}
        what = "IES texture" if "TEX_IES" in kinds else "nodes"
        warnings.append(f"the {what} of the light '{name}' is not carried over")
    return warnings


def _is_plain(tree):
    """Whether a light's nodes are those that Blender makes: white emission of strength 1."""
    nodes = [node for node in tree.nodes if node.type not in ("OUTPUT_LIGHT", "FRAME", "REROUTE")]
    if len(nodes) != 1 or nodes[0].type != "EMISSION":
        return False
    color, strength = nodes[0].inputs["Color"], nodes[0].inputs["Strength"]
    return (
        not color.is_linked
        and not strength.is_linked
        and tuple(color.default_value)[:3] == (1.0, 1.0, 1.0)
        and strength.default_value == 1.0
    )
