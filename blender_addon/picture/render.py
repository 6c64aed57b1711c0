# SPDX-License-Identifier: GPL-3.0-or-later
"""Cycles settings of the three looks, and rendering into a file.

shaded   lights, Principled material, antialiased, 8-bit PNG
flat     the base colour texture alone, one sample through the pixel's centre, linear EXR
normals  the world shading normal n as n * 0.5 + 0.5, as flat
"""

from pathlib import Path

import bpy

LOOKS = {"shaded": "part.png", "flat": "flat.exr", "normals": "normals.exr"}


def set_common(scene):
    """Cycles on the CPU, nothing random from run to run, nothing that hides a wrong value."""
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.use_denoising = False  # Debian's Blender has no denoiser and fails on the default
    scene.cycles.seed = 0
    scene.render.dither_intensity = 0.0
    # Linear values through the plain sRGB curve; Blender's default differs between versions.
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.look = "None"
    scene.view_settings.exposure = 0.0
    scene.view_settings.gamma = 1.0


def set_size(scene, width, height):
    """The whole picture, square pixels, nothing done to it afterwards."""
    render = scene.render
    render.resolution_x = width
    render.resolution_y = height
    render.resolution_percentage = 100
    render.pixel_aspect_x = render.pixel_aspect_y = 1.0
    render.use_border = False
    render.use_compositing = render.use_sequencer = False


def set_shaded(scene, samples):
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    scene.cycles.filter_width = 1.5
    scene.cycles.sample_clamp_indirect = 4.0  # rough metals in front of small lights: fireflies
    scene.render.film_transparent = False


def set_exact(scene):
    """One sample through each pixel's centre, transparent film."""
    scene.cycles.samples = 1
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 0.01
    scene.cycles.sample_clamp_direct = scene.cycles.sample_clamp_indirect = 0.0
    scene.render.film_transparent = True


def to_file(scene, path):
    """Render into `path`: .png (8-bit sRGB) or .exr (linear 32-bit, alpha). Raises RuntimeError."""
    settings = scene.render.image_settings
    if Path(path).suffix == ".exr":
        settings.file_format = "OPEN_EXR"
        settings.color_mode = "RGBA"
        settings.color_depth = "32"
        settings.exr_codec = "ZIP"
    else:
        settings.file_format = "PNG"
        settings.color_mode = "RGB"
        settings.color_depth = "8"
    scene.render.use_file_extension = True
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True, scene=scene.name)
    scene.render.filepath = "//"
    if not Path(path).is_file():
        raise RuntimeError(f"Blender rendered but did not write {path}")
