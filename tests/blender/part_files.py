# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files through parts: imported, moved, exported; and what the objects alone would give."""

import json
import time
from pathlib import Path

import bpy
from sardf_blender.parts import part_objects, part_scene


def main(folder, *paths):
    results = {}
    for path in paths:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        started = time.perf_counter()
        bpy.ops.sardf.part_import(filepath=path)
        seconds = time.perf_counter() - started
        part = part_objects.parts(bpy.context.scene)[0]
        depsgraph = bpy.context.evaluated_depsgraph_get()
        results[path] = {
            "seconds": seconds,
            "document": part_scene.document_of(part, depsgraph)[0],
            "generated": part_scene.generated(part, depsgraph)[0],
            "objects": len(part.children_recursive),
            "changed": _changed(part),
        }
        # The part's own place does not count, nor does saving and loading.
        part.location, part.rotation_euler = (100, 50, 3), (1, 2, 3)
        saved = str(Path(folder) / "part.blend")
        bpy.ops.wm.save_as_mainfile(filepath=saved)
        bpy.ops.wm.open_mainfile(filepath=saved)
        part = part_objects.parts(bpy.context.scene)[0]
        bpy.context.view_layer.objects.active = part
        # Beside the file, so that its relative file names hold.
        exported = Path(path).with_name(f".exported-{Path(folder).name}.json")
        try:
            bpy.ops.sardf.part_export(filepath=str(exported))
            results[path]["exported"] = json.loads(exported.read_text())
        finally:
            exported.unlink(missing_ok=True)
    return results


def _changed(part):
    """The document after the first primitive with a name was moved by (1, 0, 0), and its name."""
    entries = part.sardf_part.entries
    found = next((e for e in entries if e.object and e.object.type == "MESH" and e.field), None)
    if found is None:
        return None
    item = found.object
    item.location.x += 1
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    document = part_scene.document_of(part, depsgraph)[0]
    item.location.x -= 1
    bpy.context.view_layer.update()
    return {"field": found.field, "document": document}
