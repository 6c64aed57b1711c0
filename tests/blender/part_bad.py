# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with parts, and what is said about it; and a part of 10 000 objects."""

import time
from pathlib import Path

import bpy
from sardf_blender.parts import (
    part_now,
    part_objects,
    part_properties,
    part_scene,
    part_status,
)

CASES = {}


def case(check):
    """A check in an empty file with a part of a box and a cylinder that is taken off."""
    CASES[check.__name__] = check
    return check


def main(folder):
    result = {}
    for name, check in CASES.items():
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        bpy.ops.sardf.primitive_add(kind="box")
        bpy.ops.sardf.primitive_add(kind="cylinder", operation="difference")
        part = part_objects.parts(bpy.context.scene)[0]
        bpy.context.view_layer.objects.active = part
        bpy.context.scene.sardf.resolution, bpy.context.scene.sardf.size = 8, "256"
        result[name] = check(part, Path(folder))
    result["many"] = many()
    return result


def said(part):
    """The sentence of the error, or the warnings."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    part_now.forget()
    status = part_status.status(part, depsgraph)  # what the panel shows
    try:
        text, shown = part_scene.scene_of(part, depsgraph)[1], list(status.lines)
    except part_scene.PartError as error:
        text, shown = str(error), status.error
    return text if text == shown else f"{text}, but the panel says {shown}"


def reported(operator, **arguments):
    """What an operator reports when it fails."""
    try:
        return str(operator(**arguments))
    except RuntimeError as error:
        return str(error)


@case
def zero_scale(part, _folder):
    part.sardf_part.entries[0].object.scale.y = 0
    return [said(part), reported(bpy.ops.sardf.bake)]


@case
def zero_scale_of_the_part(part, _folder):
    part.scale = (0, 0, 0)
    item = part.sardf_part.entries[0].object
    item.parent = None
    return said(part)


@case
def zero_scale_muted(part, _folder):
    part.sardf_part.entries[1].object.scale.y = 0
    part.sardf_part.entries[1].mute = True
    return said(part)


@case
def deleted(part, _folder):
    item = part.sardf_part.entries[1].object
    bpy.ops.object.select_all(action="DESELECT")
    item.select_set(True)
    bpy.ops.object.delete()
    before = said(part)
    bpy.context.view_layer.objects.active = part
    part.sardf_part.entry_index = 1
    bpy.ops.sardf.list(which="entries", action="restore")
    return [before, said(part), len(part.children)]


@case
def removed_from_the_file(part, _folder):
    bpy.data.objects.remove(part.sardf_part.entries[1].object)
    return said(part)


@case
def everything_deleted(part, _folder):
    for entry in part.sardf_part.entries:
        bpy.data.objects.remove(entry.object)
    return [said(part), reported(bpy.ops.sardf.bake)]


@case
def contains_itself(part, _folder):
    part_objects.add_entry(part, part)
    return [said(part), reported(bpy.ops.sardf.part_check)]


@case
def newer_version(part, folder):
    part.sardf_part.version = part_properties.VERSION + 1
    path = str(folder / "newer.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    part = part_objects.parts(bpy.context.scene)[0]
    bpy.context.view_layer.objects.active = part
    return [said(part), reported(bpy.ops.sardf.bake)]


@case
def older_version(part, _folder):
    part.sardf_part.version = 0
    return said(part)


@case
def broken_memory(part, _folder):
    part.sardf_part.imported = "{"
    return said(part)


@case
def wrong_kind(part, _folder):
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.collection.objects.link(camera)
    part_objects.add_entry(part, camera)
    return said(part)


@case
def mesh_without_faces(part, _folder):
    item = bpy.data.objects.new("wire", bpy.data.meshes.new("wire"))
    bpy.context.collection.objects.link(item)
    part_objects.add_entry(part, item)
    return said(part)


@case
def curve_without_bevel(part, _folder):
    data = bpy.data.curves.new("line", "CURVE")
    data.splines.new("POLY").points.add(1)
    item = bpy.data.objects.new("line", data)
    bpy.context.collection.objects.link(item)
    entry = part_objects.add_entry(part, item)
    entry.as_feature, entry.operation = False, "union"
    return said(part)


@case
def formula(part, _folder):
    bpy.ops.sardf.primitive_add(kind="formula")
    item = bpy.context.active_object
    item.sardf_primitive.formula = " "
    empty = said(part)
    item.sardf_primitive.formula = "1 - nonsense(x)"
    return [empty, reported(bpy.ops.sardf.bake)]


@case
def radii(part, _folder):
    bpy.ops.sardf.primitive_add(kind="torus")
    bpy.context.active_object.sardf_primitive.torus_minor_radius = 2
    return said(part)


@case
def materials(part, _folder):
    made = []
    for _ in range(2):
        part.sardf_part.materials.add().name = "same"
    made.append(said(part))
    part.sardf_part.materials[1].name = "größer/kleiner"
    made.append(said(part))
    part.sardf_part.materials[1].name = "other"
    part.sardf_part.rule = "ramp"
    made.append(said(part))
    feature = part.sardf_part.features.add()
    made.append(said(part))
    feature.object = part
    made.append(said(part))
    feature.material = "missing"
    made.append(said(part))
    feature.material, feature.faces = "other", "first"
    made.append(said(part))
    return made


@case
def names(part, _folder):
    first, second = part.sardf_part.entries
    first.name, second.name = "größe (1)", "größe 1!"
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return sorted(part_scene.scene_of(part, depsgraph)[0]["fields"])


@case
def no_part(_part, folder):
    bpy.ops.object.select_all(action="DESELECT")
    bpy.ops.object.empty_add()
    path = str(folder / "nothing.json")
    operators = bpy.ops.sardf
    return [
        reported(operators.part_export, filepath=path),
        reported(operators.part_check),
        reported(operators.preset, choice="inlay"),
        reported(operators.list, which="entries", action="add"),
        reported(operators.entries_add),
        Path(path).exists(),
    ]


@case
def wrong_files(_part, folder):
    before = len(bpy.data.objects)
    made = []
    for text in ("{", '{"sardf": 1}', '{"sardf": 1, "solid": {"sphere": {"radius": -1}}}', "[]",
                 '{"sardf": 1, "solid": "a", "fields": {"a": {"union": ["a", "b"]}}}',
                 '{"sardf": 1, "solid": {"sphere": {"radius": 1}}, "materials": 3, '
                 '"attributes": {"fitted": 1}}'):  # fmt: skip
        path = folder / "wrong.json"
        path.write_text(text)
        made.append(reported(bpy.ops.sardf.part_import, filepath=str(path)))
    made.append(reported(bpy.ops.sardf.part_import, filepath=str(folder / "missing.json")))
    made.append(reported(bpy.ops.sardf.part_export, filepath=str(folder / "no folder" / "x.json")))
    assert len(bpy.data.objects) == before
    return made


@case
def uneven(part, _folder):
    part.sardf_part.entries[0].object.scale = (1, 2, 3)
    bpy.ops.sardf.primitive_add(kind="torus")
    bpy.context.active_object.scale.z = 2
    bpy.ops.sardf.part_check()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return list(part_status.status(part, depsgraph).lines)


def many():
    """Seconds for a part of 10 000 spheres: to make, to read, to show."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    times = [time.perf_counter()]
    part = part_objects.new_part("many", bpy.context.collection)
    first = part_objects.new_primitive("sphere", "first", bpy.context.collection)
    for number in range(10000):
        item = first.copy() if number else first
        item.location = (3 * (number % 100), 3 * (number // 100), 0)
        if number:
            bpy.context.collection.objects.link(item)
        part_objects.add_entry(part, item)
    times.append(time.perf_counter())
    bpy.context.view_layer.update()
    times.append(time.perf_counter())
    depsgraph = bpy.context.evaluated_depsgraph_get()
    scene, _ = part_scene.scene_of(part, depsgraph)
    times.append(time.perf_counter())
    status = part_status.status(part, depsgraph).lines
    times.append(time.perf_counter())
    steps = ("make", "evaluate", "read", "status")
    seconds = {name: times[i + 1] - times[i] for i, name in enumerate(steps)}
    return {"seconds": seconds, "fields": len(scene["fields"]), "status": status}
