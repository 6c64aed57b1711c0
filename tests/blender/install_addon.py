# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the zip, bakes and renders without a window; run as: ... -- ZIP SCENE RESULT.json

In Blender 4.2 and later the zip is installed as an extension, before that as an add-on.
"""

import importlib
import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from installing import MODULE, install


def contents():
    """Names of everything a bake could add or leave behind."""
    kinds = ("objects", "meshes", "materials", "images", "scenes")
    made_by_rendering = ("Render Result", "Viewer Node")
    return {
        kind: sorted(x.name for x in getattr(bpy.data, kind) if x.name not in made_by_rendering)
        for kind in kinds
    }


def bake_error():
    try:
        bpy.ops.sardf.bake()
    except RuntimeError as error:
        return str(error)
    return ""


def main(zip_file, scene_file, result_file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    install(zip_file)
    module = MODULE
    result = {"module": module, "enabled": module in bpy.context.preferences.addons}
    scene = bpy.context.scene
    settings = scene.sardf
    settings.filepath, settings.resolution, settings.size = scene_file, 16, "256"
    properties = importlib.import_module(f"{module}.properties")
    result["summary"] = properties.summary(settings).lines
    bpy.ops.sardf.bake()
    result["core"] = sys.modules["sardf"].__file__
    result["baked"] = contents()
    part = bpy.context.view_layer.objects.active
    part.location.x = 5.0
    part.data.materials[0].node_tree.nodes.new("ShaderNodeValue").name = "the user's"
    settings.resolution = 24
    faces = len(part.data.polygons)
    bpy.ops.sardf.bake()
    result["rebaked"] = contents()
    result["finer"] = len(part.data.polygons) > faces
    result["kept"] = [part.location.x, "the user's" in part.data.materials[0].node_tree.nodes]
    settings.samples = 1
    scene.render.resolution_x, scene.render.resolution_y = 40, 30
    scene.render.resolution_percentage = 100
    bpy.ops.sardf.render()
    result["camera"] = scene.camera.name
    settings.filepath = scene_file + ".missing"
    result["error"] = bake_error()
    bpy.ops.preferences.addon_disable(module=module)
    result["left after disabling"] = hasattr(bpy.types.Scene, "sardf")
    Path(result_file).write_text(json.dumps(result))


main(*sys.argv[sys.argv.index("--") + 1 :])
