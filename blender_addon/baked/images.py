# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked EXR files as Blender images."""

import bpy

LINEAR_NAMES = ("Linear Rec.709", "Linear")  # Blender 4.0 renamed it
DATA_NAMES = ("Non-Color", "Raw")


class ColorSpaceError(Exception):
    """The user's colour configuration has no place for the textures: one sentence."""


def set_colorspace(image, is_color):
    """Linear Rec. 709 for colours, Non-Color for everything else. Raises ColorSpaceError."""
    names = LINEAR_NAMES if is_color else DATA_NAMES
    for name in names:
        try:
            image.colorspace_settings.name = name
            return
        except TypeError:  # not in this version's or the user's colour configuration
            continue
    raise ColorSpaceError(f"the colour configuration has none of the spaces {', '.join(names)}")


def load(path, name, is_color, packed):
    """A new image of an EXR file, called as the file is where `name` is "". `packed`: the .blend
    keeps the file's bytes, and unpacking writes textures/NAME.exr; else it names the file, relative
    to a saved .blend."""
    image = bpy.data.images.load(str(path), check_existing=False)
    if name:
        image.name = name
    try:
        set_colorspace(image, is_color)
    except ColorSpaceError:
        bpy.data.images.remove(image)
        raise
    if packed:
        image.pack()
        image.filepath_raw = f"//textures/{path.name}"
    elif bpy.data.is_saved:
        image.filepath_raw = bpy.path.relpath(str(path))
    return image
