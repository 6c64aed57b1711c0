# SPDX-License-Identifier: GPL-3.0-or-later
"""An animated part as a .blend file, its wireframe frame by frame, and the pictures of its frames.

A ball whose radius is driven is cut by a plane that is keyed, seen by nobody here.
"""

import hashlib
from pathlib import Path

import bpy
import numpy as np
from sardf_blender import commands
from sardf_blender.parts import part_objects

FRAMES = range(1, 25)


def main(what, *arguments):
    return {"make": make, "read": read, "command": command}[what](*arguments)


def make(path):
    """{frame: [the ball's radius, the plane's y, the ring's radius and the highest point of its
    wireframe]}"""
    bpy.context.preferences.edit.keyframe_new_interpolation_type = "LINEAR"
    bpy.ops.sardf.primitive_add(kind="sphere")
    ball = bpy.context.active_object
    for axis in range(3):
        ball.driver_add("scale", axis).driver.expression = "0.9 + 0.01*frame"
    bpy.ops.sardf.primitive_add(kind="torus", operation="difference")
    ring = bpy.context.active_object
    ring.location, ring.rotation_euler.x = (0, 0.6, 0), 1.5707963
    driver = ring.sardf_primitive.driver_add("torus_minor_radius").driver
    driver.expression = "0.1 + 0.005*frame"
    (part,) = part_objects.parts(bpy.context.scene)
    for name, color in (("red", (0.5, 0.02, 0.01)), ("steel", (0.3, 0.3, 0.35))):
        part.sardf_part.materials.add().name = name
        part.sardf_part.materials[-1].color = color
    bpy.context.view_layer.objects.active = part
    bpy.ops.sardf.section_add(kind="plane")
    plane = bpy.context.active_object
    for frame, y in ((FRAMES[0], -0.85), (FRAMES[-1], -0.1)):
        plane.location.y = y
        plane.keyframe_insert("location", index=1, frame=frame)
    part.location = (3, 2, 1)  # wherever it stands, the picture is of its own frame
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    found = {}
    for frame in FRAMES:
        scene.frame_set(frame)
        evaluated = ring.evaluated_get(bpy.context.evaluated_depsgraph_get())
        top = max(vertex.co.z for vertex in ring.data.vertices)
        radius = evaluated.sardf_primitive.torus_minor_radius
        found[frame] = [ball.scale.x, plane.location.y, radius, top]
    bpy.ops.wm.save_as_mainfile(filepath=path)
    return found


def read(folder):
    """{frame: [pixels of the part, pixels of the cut, hashes of both pictures]}"""
    found = {}
    for path in sorted(Path(folder).glob("normals_*.exr")):
        number = path.stem.partition("_")[2]
        normals, shaded = pixels(path), pixels(path.with_name(f"part_{number}.png"))
        on_part = normals[..., 3] > 0.5
        on_cut = on_part & (np.abs(normals[..., :3] - (0.5, 0.0, 0.5)).max(axis=-1) < 1e-3)
        hashes = [hashlib.sha256(each.tobytes()).hexdigest() for each in (normals, shaded)]
        found[int(number)] = [int(on_part.sum()), int(on_cut.sum()), *hashes]
    return found


def pixels(path):
    image = bpy.data.images.load(str(path))
    values = np.empty(len(image.pixels), np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(*reversed(image.size), -1)


def command(*words):
    """The exit code of `blender -c sardf WORDS`."""
    return commands.run(list(words))
