# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as images in the .blend: POV-Ray's, Cycles' and their difference."""

import contextlib
import tempfile
from pathlib import Path

import bpy
import numpy as np

from ..baked import images

MARK = "sardf_reference"  # custom property of our images: the look that they show
NAMES = {
    "reference": "sardf reference",
    "cycles": "sardf cycles",
    "difference": "sardf difference ×16",
}
FACTOR = 16  # of the difference


@contextlib.contextmanager
def exr_file(name):
    """The path of an .exr file that may be written, and is gone afterwards."""
    with tempfile.TemporaryDirectory(dir=bpy.app.tempdir or None) as folder:
        yield Path(folder) / f"{name}.exr"


def from_exr(content, kind):
    """A packed image of an EXR file's bytes: linear colour, and alpha 0 where nothing is."""
    with exr_file(NAMES[kind]) as path:
        path.write_bytes(content)
        return images.load(path, "", is_color=True, packed=True)


def keep(kind, image, look):
    """Let an image take the place and the name of the last one of its kind; returns it."""
    earlier = find(kind)
    if earlier is not None:
        earlier.user_remap(image)  # what shows the last one shows this one
        bpy.data.images.remove(earlier)
    image.name = _free_name(NAMES[kind], image)
    image[MARK] = look
    image.use_fake_user = True
    return image


def _free_name(name, image):
    """A name that takes no other image's: some versions of Blender would rename that one."""
    known = {each.name for each in bpy.data.images if each != image}
    names = [name, *(f"{name}.{number:03}" for number in range(1, len(known) + 2))]
    return next(each for each in names if each not in known)


def find(kind):
    """Our image of a kind, or None. Another image of that name is not ours."""
    return next((i for i in bpy.data.images if MARK in i and i.name.startswith(NAMES[kind])), None)


def array(image):
    """(height, width, 4) float32, row 0 at the top."""
    width, height = image.size
    pixels = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return np.ascontiguousarray(pixels.reshape(height, width, 4)[::-1])


def difference(sardf, values, look):
    """The image of an array (height, width, 3)."""
    with exr_file(NAMES["difference"]) as path:
        sardf.write_exr(path, values)
        image = images.load(path, "", is_color=True, packed=True)
    return keep("difference", image, look)


def show(context, kind):
    """Put an image into the Image Editors of the window that are open; returns how many."""
    image, shown = find(kind), 0
    if image is None or context.window is None:
        return 0
    for area in context.window.screen.areas:
        if area.type == "IMAGE_EDITOR":
            area.spaces.active.image = image
            shown += 1
    return shown
