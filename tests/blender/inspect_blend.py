# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes what a folder of headless.py holds, as this Blender reads it; ... -- FOLDER RESULT.npz

The result has the pictures' and textures' pixels (row 0 at the top), mesh arrays, and "facts": the
rest as JSON.
"""

import json
import sys
from pathlib import Path

import bpy
import numpy as np


def pixels(image):
    width, height = image.size
    values = np.empty(width * height * image.channels, dtype=np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, image.channels)[::-1]


def read(data, attribute, size, kind=np.float32):
    values = np.empty(len(data) * size, dtype=kind)
    data.foreach_get(attribute, values)
    return values.reshape(-1, size) if size > 1 else values


def image_facts(node):
    image = node.image
    return {
        "to": node.outputs["Color"].links[0].to_socket.name,
        "colorspace": image.colorspace_settings.name,
        "extension": node.extension,
        "interpolation": node.interpolation,
        "packed": image.packed_file is not None,
        "float": image.is_float,
    }


def scene_facts(scene):
    camera = scene.camera
    return {
        "unit": [scene.unit_settings.length_unit, scene.unit_settings.scale_length],
        "engine": scene.render.engine,
        "device": scene.cycles.device,
        "denoise": scene.cycles.use_denoising,
        "dither": scene.render.dither_intensity,
        "view": scene.view_settings.view_transform,
        "materials": sorted(material.name for material in bpy.data.materials if material.users),
        "camera": {
            "matrix_world": [list(row) for row in camera.matrix_world],
            "lens": camera.data.lens,
            "sensor_width": camera.data.sensor_width,
            "sensor_fit": camera.data.sensor_fit,
        },
    }


def main(folder, result_file):
    folder = Path(folder)
    bpy.ops.wm.open_mainfile(filepath=str(folder / "part.blend"))
    part = next(item for item in bpy.context.scene.objects if item.type == "MESH")
    mesh = part.data
    nodes = [n for n in mesh.materials[0].node_tree.nodes if n.type == "TEX_IMAGE"]
    facts = scene_facts(bpy.context.scene) | {
        "images": {node.name: image_facts(node) for node in nodes},
        "packed": sorted(image.name for image in bpy.data.images if image.packed_file),
        "attributes": {a.name: [a.data_type, a.domain] for a in mesh.attributes},
        "custom normals": mesh.has_custom_normals,
        "object": part.name,
    }
    arrays = {"vertices": read(mesh.vertices, "co", 3)}
    arrays["uv"] = read(mesh.uv_layers.active.data, "uv", 2)
    arrays["totals"] = read(mesh.polygons, "loop_total", 1, np.int32)
    for name in facts["attributes"]:
        if mesh.attributes[name].data_type == "FLOAT":
            arrays[f"attribute {name}"] = read(mesh.attributes[name].data, "value", 1)
        elif mesh.attributes[name].data_type == "FLOAT_VECTOR":
            arrays[f"attribute {name}"] = read(mesh.attributes[name].data, "vector", 3)
    for node in nodes:
        arrays[f"packed {node.name}"] = pixels(node.image)
    for path in [*folder.glob("*.exr"), *folder.glob("textures/*.exr"), *folder.glob("*.png")]:
        arrays[f"file {path.name}"] = pixels(bpy.data.images.load(str(path)))
    np.savez(result_file, facts=json.dumps(facts), **arrays)


main(*sys.argv[sys.argv.index("--") + 1 :])
