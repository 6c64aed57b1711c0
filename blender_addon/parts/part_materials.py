# SPDX-License-Identifier: GPL-3.0-or-later
"""A part's list of materials as the scene file says it."""

import re

from .part_error import PartError
from .part_frame import with_values
from .transforms import number

NAME = re.compile(r"[A-Za-z0-9_.-][A-Za-z0-9 _.-]*")
# What a material is where it says nothing: such values are not written.
PLAIN = {"roughness": 0.5, "metallic": 0.0, "density": 0.0, "index_of_refraction": 0.0}


def materials_of(settings, evaluated):
    """{name: material} in the order of the list. Raises PartError."""
    made = {}
    for item, values in with_values(settings.materials, evaluated.materials):
        if not NAME.fullmatch(item.name):
            raise PartError(
                f"the material is called '{item.name}'; letters, digits, spaces and _ . - are "
                "accepted, no space first"
            )
        if item.name in made:
            raise PartError(f"two materials are called '{item.name}'; rename one")
        made[item.name] = _material(item, values)
    return made


def _material(item, values):
    color = followed(item.source) if item.source else values.color
    made = {"color": [number(value) for value in color]}
    for key, plain in PLAIN.items():
        value = number(getattr(values, key))
        if value != plain:
            made[key] = value
    if any(values.emission):
        made["emission"] = [number(value) for value in values.emission]
    return made


def followed(material):
    """The linear base colour of a Blender material."""
    owner, key = color_property(material)
    return tuple(getattr(owner, key))[:3]


def color_property(material):
    """(owner, name) of the property that is a Blender material's base colour: its Principled
    node's, or the viewport's."""
    nodes = material.node_tree.nodes if material.node_tree else ()
    for node in nodes:
        if node.type == "BSDF_PRINCIPLED" and not node.inputs["Base Color"].is_linked:
            return node.inputs["Base Color"], "default_value"
    return material, "diffuse_color"
