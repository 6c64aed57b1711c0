# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes a scene again and again by the operator, brushed along different attributes; run as:
... -- ADDON_FOLDER SCENE.json RESULT.json [ATTRIBUTE or "" ...]

After the first bake the user sets the strength of the brushing to 0.3. The result has the state of
the material after each bake, and "error", what a wrong name makes the operator say.
"""

import importlib
import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
import addon_folder


def state(part):
    tree = part.data.materials[0].node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    attribute = tree.nodes.get("sardf tangent attribute")
    strength = tree.nodes.get("sardf anisotropic")
    return {
        "nodes": len(tree.nodes),
        "attribute": attribute.attribute_name if attribute else None,
        "strength": round(strength.inputs[1].default_value, 6) if strength else None,
        "linked": [shader.inputs[name].is_linked for name in ("Tangent", "Anisotropic")],
        "anisotropic": shader.inputs["Anisotropic"].default_value,
    }


def main(folder, scene_file, result_file, *names):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_folder.load(folder)
    settings = bpy.context.scene.sardf
    settings.filepath, settings.resolution, settings.size = scene_file, 8, "256"
    properties = importlib.import_module("sardf_blender.properties")
    result = {"summary": properties.summary(settings).lines, "states": []}
    for name in names:
        settings.tangent_attribute = name
        bpy.ops.sardf.bake()
        part = bpy.context.view_layer.objects.active
        result["states"].append(state(part))
        strength = part.data.materials[0].node_tree.nodes.get("sardf anisotropic")
        if strength:
            strength.inputs[1].default_value = 0.3
    settings.tangent_attribute = "along_z"
    try:
        bpy.ops.sardf.bake()
    except RuntimeError as error:
        result["error"] = str(error)
    Path(result_file).write_text(json.dumps(result))


main(*sys.argv[sys.argv.index("--") + 1 :])
