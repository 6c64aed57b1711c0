# SPDX-License-Identifier: GPL-3.0-or-later
"""The core's camera dictionary, shared with the POV-Ray generator, to a camera object."""

import json
import math

import bpy
from mathutils import Matrix

NAME = "sardf camera"
# What a camera file may leave out, as the core reads it; lengths in mm or scene units.
DEFAULTS = {
    "type": "PERSP",
    "sensor_fit": "AUTO",
    "lens": 50.0,
    "sensor_width": 36.0,
    "sensor_height": 24.0,
    "ortho_scale": 1.0,
    "shift_x": 0.0,
    "shift_y": 0.0,
    "clip_start": 0.1,
    "clip_end": 1000.0,
}
CHOICES = {"type": ("PERSP", "ORTHO"), "sensor_fit": ("HORIZONTAL", "VERTICAL", "AUTO")}
SHIFTS = ("shift_x", "shift_y")
POSITIVE = tuple(key for key in DEFAULTS if key not in CHOICES and key not in SHIFTS)


class CameraError(Exception):
    """A camera file that cannot be used, in one sentence."""


def read(path):
    """The camera dictionary of a JSON file as headless.py writes it. Raises CameraError."""
    try:
        with open(path, encoding="utf-8") as file:
            camera = json.load(file)
    except OSError as error:
        raise CameraError(f"{path}: cannot be read: {error.strerror}") from error
    except ValueError as error:
        raise CameraError(f"{path}: is not JSON: {error}") from error
    if not isinstance(camera, dict):
        raise CameraError(f"{path}: expected an object with the keys of camera.json")
    camera = DEFAULTS | camera
    problem = _problem(camera)
    if problem:
        raise CameraError(f"{path}: {problem}")
    return camera


def _problem(camera):
    for key in POSITIVE:
        if not (_is_number(camera[key]) and camera[key] > 0):
            return f"'{key}' must be a positive number, found {camera[key]!r}"
    for key in SHIFTS:
        if not _is_number(camera[key]):
            return f"'{key}' must be a number, found {camera[key]!r}"
    rows = camera.get("matrix_world")
    if not isinstance(rows, list) or [len(r) for r in rows if isinstance(r, list)] != [4] * 4:
        return "'matrix_world' must be a list of 4 rows of 4 numbers"
    if not all(_is_number(value) for row in rows for value in row):
        return "'matrix_world' holds something that is not a finite number"
    for key, accepted in CHOICES.items():
        if camera[key] not in accepted:
            return f"'{key}' must be one of {', '.join(accepted)}, found {camera[key]!r}"
    return ""


def _is_number(value):
    return isinstance(value, (int, float)) and math.isfinite(value)


def place(scene, camera, world=None):
    """Make (or move) our camera object in `scene` and make it the active camera.

    `world`: the object's matrix when it does not stand at the origin.
    """
    item = next((o for o in scene.objects if o.type == "CAMERA" and o.name.startswith(NAME)), None)
    if item is None:
        item = bpy.data.objects.new(NAME, bpy.data.cameras.new(NAME))
        scene.collection.objects.link(item)
    location, rotation, scale = ((world or Matrix()) @ Matrix(camera["matrix_world"])).decompose()
    item.matrix_world = Matrix.LocRotScale(location, rotation, None)
    size = sum(scale) / 3
    data = item.data
    for key in (*CHOICES, "lens", "sensor_width", "sensor_height", *SHIFTS):
        setattr(data, key, camera[key])
    data.ortho_scale = camera["ortho_scale"] * size
    data.clip_start = camera["clip_start"] * size
    data.clip_end = camera["clip_end"] * size
    scene.camera = item
    return item
