# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked float arrays to Blender images and to EXR files."""

import contextlib
import os
import tempfile
from pathlib import Path

import bpy
import numpy as np

COLOR_CHANNELS = ("base_color", "emission")  # all others are data, not colours
SINGLE_CHANNELS = ("roughness", "metallic", "field")
LINEAR_NAMES = ("Linear Rec.709", "Linear")  # Blender 4.0 renamed it


def set_colorspace(image, channel):
    """Linear Rec. 709 for colours, Non-Color for everything else."""
    names = LINEAR_NAMES if channel in COLOR_CHANNELS else ("Non-Color", "Raw")
    for name in names:
        try:
            image.colorspace_settings.name = name
            return
        except TypeError:  # not in this version's or the user's colour configuration
            continue
    raise RuntimeError(
        f"the colour configuration has none of the spaces {', '.join(names)} for '{channel}'"
    )


def build(name, channel, array):
    """A new float image from (H,W,C) float32, C of 1 or 3, row 0 at the top."""
    height, width, channels = array.shape
    pixels = np.ones((height, width, 4), dtype=np.float32)
    pixels[..., :3] = array[::-1] if channels == 3 else array[::-1, :, :1]
    image = bpy.data.images.new(name, width, height, alpha=False, float_buffer=True)
    # The space comes first: setting it later makes Blender fill the image anew.
    set_colorspace(image, channel)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    return image


def write_exr(image, path, channel):
    """Write a float image's values, unchanged, as 32-bit EXR.

    Image.save() bakes the sRGB curve into a linear EXR (measured on 3.4.1); save_render() is exact
    and compresses.
    """
    with _exr_scene("BW" if channel in SINGLE_CHANNELS else "RGB") as scene:
        image.save_render(str(path), scene=scene)


def pack(image, path):
    """Keep the EXR file's bytes inside the .blend as the image's content."""
    content = Path(path).read_bytes()
    colorspace = image.colorspace_settings.name
    image.pack(data=content, data_len=len(content))
    image.source = "FILE"
    image.colorspace_settings.name = colorspace


def build_packed(name, channel, array):
    """`build`, packed so that it survives saving and reopening the .blend."""
    image = build(name, channel, array)
    handle, path = tempfile.mkstemp(suffix=".exr", dir=bpy.app.tempdir)
    os.close(handle)
    try:
        write_exr(image, path, channel)
        pack(image, path)
    finally:
        os.unlink(path)
    return image


@contextlib.contextmanager
def _exr_scene(color_mode):
    """A throw-away scene with EXR settings, so that the user's output settings stay."""
    scene = bpy.data.scenes.new("sardf exr")
    try:
        settings = scene.render.image_settings
        settings.file_format = "OPEN_EXR"
        settings.color_mode = color_mode
        settings.color_depth = "32"
        settings.exr_codec = "ZIP"
        yield scene
    finally:
        bpy.data.scenes.remove(scene)
