# SPDX-License-Identifier: GPL-3.0-or-later
"""Channels and attributes as arrays: which images hold them, and their files. No bpy here."""

from ..progress import between

GRAIN = "grain_direction"  # the attribute that directs metal's reflections unless one is named
PER_IMAGE = 3  # components of a channel that one image holds


def image_names(components):
    """{image: (channel, first component)} of {channel: its number of components}: more than
    PER_IMAGE of them become an image for each three, name_1, name_2, ..."""
    names = {}
    for name, count in components.items():
        if count <= PER_IMAGE:
            names[name] = (name, 0)
            continue
        for number, first in enumerate(range(0, count, PER_IMAGE), 1):
            names[f"{name}_{number}"] = (name, first)
    return names


def split(maps):
    """{image: array of 1 to 3 components} of {channel: array}."""
    names = image_names({name: array.shape[2] for name, array in maps.items()})
    return {
        image: maps[name][..., first : first + PER_IMAGE] for image, (name, first) in names.items()
    }


def write(sardf, target, maps, progress):
    """Write the arrays as files, and let go of each."""
    names = list(maps)
    for place, name in enumerate(names):
        part = between(progress, place / len(names), (place + 1) / len(names))
        sardf.write_exr(target.path(name), maps[name], part)
        maps[name] = None


def attributes_at(scene, points):
    """{name: (points,) or (points, components)}; components that have names stand alone, as
    stress_xx does."""
    attributes = {}
    for name, evaluate in scene.attributes.items():
        values = evaluate(points)
        if isinstance(values, dict):
            attributes |= {f"{name}_{component}": of for component, of in values.items()}
        else:
            attributes[name] = values
    return attributes


def tangent_of(scene, name):
    """The checked name of the attribute along which metal is brushed, or "" for none.

    A name must be that of an attribute with 3 components: raises sardf.Error. "" stands for GRAIN
    where the scene has such a vector of that name.
    """
    # sardf is found by core.load(), not when Blender reads this file.
    from sardf._words import components_of, vector_attribute

    if name:
        vector_attribute(scene, name, (3,), "metal is brushed along")
        return name
    known = scene.attributes
    return GRAIN if GRAIN in known and components_of(known[GRAIN]) == 3 else ""
