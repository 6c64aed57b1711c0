# SPDX-License-Identifier: GPL-3.0-or-later
"""What the core says about its words, for menus and tooltips: nothing of it is typed here again."""

import functools
import json

from .. import core

# Blender stores the number of a choice, so a number once given to a word stays its own.
BLEND_NUMBERS = {"min_max": 0, "sardf": 1, "sardf_c1": 2, "r_function": 3, "smooth": 4}
UNKNOWN = "(the compiled module was not found, which describes this)"


@functools.cache
def _definitions():
    """The definitions of the core's JSON Schema; empty where the core cannot be loaded."""
    try:
        return json.loads(core.load().schema())["$defs"]
    except core.MissingCore:
        return {}


def _alternative(schema, key):
    """The object that has `key` among the properties of one of the schema's alternatives."""
    for each in schema.get("anyOf", (schema,)):
        if key in each.get("properties", {}):
            return each["properties"][key]
    return {}


def _constructor(name):
    found = _alternative(_definitions().get("field", {}), name)
    # Where the first parameter may stand alone, the object is one of two alternatives.
    return next((each for each in found.get("anyOf", ()) if "properties" in each), found)


def about(constructor):
    """The sentence that describes a constructor."""
    return _tooltip(_constructor(constructor).get("description", UNKNOWN))


def about_parameter(constructor, parameter):
    """What a constructor's parameter means, with unit and range."""
    return _described(_constructor(constructor).get("properties", {}).get(parameter, {}))


def about_material(key):
    """What a material's key accepts."""
    found = _definitions().get("material", {}).get("properties", {}).get(key, {})
    return _range(found)


def about_rule(name):
    """The sentence that describes a fraction rule."""
    found = _alternative(_definitions().get("fractions", {}), name)
    texts = [each["description"] for each in (found, *found.get("anyOf", ()))
             if "description" in each]  # fmt: skip
    return _tooltip(texts[0] if texts else UNKNOWN)


def about_feature(key):
    """What a key of an inverse_distance feature means."""
    rule = _alternative(_definitions().get("fractions", {}), "inverse_distance")
    items = rule.get("properties", {}).get("features", {}).get("items", {})
    return _described(items.get("properties", {}).get(key, {}))


def _tooltip(text):
    """Blender puts a full stop behind every tooltip itself."""
    return text.removesuffix(".")


def _described(schema):
    text = _tooltip(schema.get("description", UNKNOWN))
    limits = _range(schema)
    return f"{text}; {limits}" if limits else text


def _range(schema):
    for each in (schema, *schema.get("anyOf", ())):
        low = [f"> {each['exclusiveMinimum']:g}"] if "exclusiveMinimum" in each else []
        low += [f"≥ {each['minimum']:g}"] if "minimum" in each else []
        low += [f"≤ {each['maximum']:g}"] if "maximum" in each else []
        if low:
            return "accepted: " + ", ".join(low)
    return ""


def blends():
    """The field's blends as (name, description, number), in the core's order."""
    schema = _definitions().get("blend", {})
    found = {}
    for each in schema.get("anyOf", ()):
        found |= each.get("properties", {})
    names = found or BLEND_NUMBERS
    numbers = BLEND_NUMBERS | {
        name: 100 + place for place, name in enumerate(names) if name not in BLEND_NUMBERS
    }
    return [
        (name, _tooltip(found.get(name, {}).get("description", UNKNOWN)), numbers[name])
        for name in names
    ]


def blend_parameter(name):
    """The name of a blend's parameter in scene files, or "" for one that has none."""
    schema = _alternative(_definitions().get("blend", {}), name)
    for each in (schema, *schema.get("anyOf", ())):
        if each.get("properties"):
            return next(iter(each["properties"]))
    return ""


def about_parameter_of_blend(name):
    """What a blend's parameter means."""
    schema = _alternative(_definitions().get("blend", {}), name)
    for each in (schema, *schema.get("anyOf", ())):
        for parameter in each.get("properties", {}).values():
            return _described(parameter)
    return UNKNOWN
