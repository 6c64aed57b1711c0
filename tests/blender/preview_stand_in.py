# SPDX-License-Identifier: GPL-3.0-or-later
"""The preview without a window; run as: ... -- ZIP SCENE RESULT.json

In Blender 4.2 and later the zip is installed as an extension, before that as an add-on.
"""

import importlib
import json
import sys
import threading
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

sys.path.insert(0, str(Path(__file__).resolve().parent))
from installing import MODULE, install


def contents():
    return {kind: [x.name for x in getattr(bpy.data, kind)] for kind in ("objects", "meshes")}


def mesh_of(item):
    """Vertices in the world, and their colours, linear."""
    data = item.data
    points = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", points)
    colors = np.empty(4 * len(data.vertices), np.float32)
    data.color_attributes.active_color.data.foreach_get("color", colors)
    return points.reshape(-1, 3).tolist(), colors.reshape(-1, 4).tolist()


def update_error():
    try:
        bpy.ops.sardf.preview_update()
    except RuntimeError as error:
        return str(error)
    return ""


def main(zip_file, scene_file, result_file):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    install(zip_file)
    module = MODULE
    preview = importlib.import_module(f"{module}.preview.preview")
    result = {"before": contents()}
    bpy.context.scene.sardf.filepath = scene_file
    settings = bpy.context.scene.sardf_preview
    settings.enabled = True
    result["error"] = update_error()
    (item,) = bpy.data.objects
    result["whole"] = mesh_of(item)
    result["hidden from renders"] = item.hide_render
    bpy.ops.sardf.section_add(kind="plane")  # there is no part: it cuts all that is shown
    plane = bpy.context.active_object
    update_error()
    result["cut"] = mesh_of(item)
    bpy.data.meshes.remove(plane.data)
    settings.show = "fraction of red"
    update_error()
    result["fraction"] = mesh_of(item)
    settings.show = "hardness"
    result["unknown"] = update_error()
    settings.show = "colour"
    matrix = Matrix.Translation((1, 2, 3))
    source = Path(scene_file).read_text()
    shown = preview.Shown(source, matrix)
    preview.providers[:] = [lambda _scene, _depsgraph: {scene_file: shown}]
    update_error()
    result["place"] = list(item.matrix_world.translation)
    wrong = preview.Shown(ValueError("the part is empty"), matrix)
    preview.providers[:] = [lambda *_: {scene_file: wrong}]
    result["part's error"] = update_error()
    settings.enabled = False
    preview.collect()
    result["after"] = contents()
    preview.providers[:] = [preview.from_file]
    settings.enabled = True
    update_error()
    bpy.ops.preferences.addon_disable(module=module)
    result["disabled"] = contents()
    result["threads"] = [t.name for t in threading.enumerate() if t.name == "sardf preview"]
    Path(result_file).write_text(json.dumps(result))


main(*sys.argv[sys.argv.index("--") + 1 :])
