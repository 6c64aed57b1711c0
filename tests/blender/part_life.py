# SPDX-License-Identifier: GPL-3.0-or-later
"""One part through all that Blender does to objects: undo, save, copy, append, link, bake."""

from pathlib import Path

import bpy
from sardf_blender.parts import part_bake, part_lists, part_objects, part_scene


def scene(part=None):
    part = part or part_objects.parts(bpy.context.scene)[0]
    return part_scene.scene_of(part, bpy.context.evaluated_depsgraph_get())[0]


def build():
    """A block with a bore, lined, in a section; by operators alone."""
    bpy.ops.sardf.primitive_add(kind="box")
    bpy.context.active_object.scale = (2, 1.5, 1)
    bpy.ops.sardf.primitive_add(kind="cylinder", operation="difference")
    bpy.context.active_object.scale = (0.5, 0.5, 3)
    bpy.ops.sardf.preset(choice="lined_bore", depth=0.25)
    settings = bpy.context.scene.sardf
    settings.resolution, settings.size = 12, "256"
    return part_objects.parts(bpy.context.scene)[0]


def counts():
    kinds = ("objects", "meshes", "materials", "images", "collections")
    return {kind: len(getattr(bpy.data, kind)) for kind in kinds}


def main(folder):
    result = {}
    part = build()
    part.location = (10, 20, 30)
    result["scene"] = scene()
    result["undo"] = undo_and_redo()
    result["copy"] = duplicate()
    result["bake"] = bake(Path(folder) / "saved.blend")
    result["append"] = bring_in(Path(folder) / "saved.blend", link=False)
    result["library"] = bring_in(Path(folder) / "saved.blend", link=True)
    return result


def undo_and_redo():
    part = part_objects.parts(bpy.context.scene)[0]
    bpy.ops.ed.undo_push(message="before")
    before = scene()
    part.sardf_part.entries[1].object.location.x = 0.75
    part.sardf_part.entries[1].blend = "sardf"
    part_lists.add_item(bpy.context, part, "materials").name = "third"
    bpy.ops.ed.undo_push(message="changed")
    after = scene()
    bpy.ops.ed.undo()
    undone = scene()
    bpy.ops.ed.redo()
    redone = scene()
    bpy.ops.ed.undo()
    return {"before": before, "after": after, "undone": undone, "redone": redone}


def duplicate():
    """The copy has entries of its own: moving its bore leaves the original as it is."""
    original = part_objects.parts(bpy.context.scene)[0]
    bpy.ops.object.select_all(action="DESELECT")
    for item in (original, *original.children_recursive):
        item.select_set(True)
    bpy.context.view_layer.objects.active = original
    bpy.ops.object.duplicate()
    copy = next(p for p in part_objects.parts(bpy.context.scene) if p != original)
    same = scene(copy)
    copy.sardf_part.entries[1].object.location.x = 0.5
    bpy.context.view_layer.update()
    result = {"same": same, "changed": scene(copy), "original": scene(original)}
    part_objects.remove_part(copy)
    return result


def bake(path):
    part = part_objects.parts(bpy.context.scene)[0]
    bpy.context.view_layer.objects.active = part
    bpy.ops.ed.undo_push(message="before the bake")
    before = counts()
    bpy.ops.sardf.bake()
    item = bpy.context.active_object
    result = {
        "parent": item.parent.name,
        "matrix": [list(row) for row in item.matrix_local],
        "points": [list(vertex.co) for vertex in item.data.vertices],
        "wireframes": all(o.hide_render for o in part.children if o.sardf_primitive.kind != "none"),
    }
    first = counts()
    item.location, item["mine"] = (0, 0, 1), 5  # what the user does to it stays
    bpy.context.view_layer.objects.active = part.sardf_part.entries[0].object
    bpy.ops.sardf.bake()
    result["again"] = bpy.context.active_object == item and item["mine"] == 5
    result["counts"] = [before, first, counts()]
    bpy.ops.ed.undo_push(message="baked")
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    result["loaded"] = scene()
    result["baked after loading"] = part_objects.parts(bpy.context.scene)[0].sardf_part.baked.name
    return result


def bring_in(path, link):
    """The part from another file, appended or linked with what it points to."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    directory = f"{path}/Object/"
    bpy.ops.wm.append(directory=directory, filename="Part", link=link, instance_collections=False)
    part = next(o for o in bpy.data.objects if o.sardf_part.is_part)
    result = {"scene": scene(part), "entries": len(part.sardf_part.entries)}
    settings = bpy.context.scene.sardf
    settings.resolution, settings.size = 12, "256"
    bpy.context.view_layer.objects.active = part
    if link:
        try:
            bpy.ops.sardf.list(which="materials", action="add")
        except RuntimeError as error:
            result["error"] = str(error)
    request, _ = part_bake.request_of(part, settings, bpy.context.evaluated_depsgraph_get())
    result["request"] = request.scene == result["scene"]
    for _ in range(2):
        bpy.context.view_layer.objects.active = part
        bpy.ops.sardf.bake()
    result["baked"] = [o.name for o in part.children if o.library is None and "sardf_source" in o]
    return result
