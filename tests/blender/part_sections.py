# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts cut open by section objects: what is removed, pieces, which parts, and what is wrong."""

import json
from pathlib import Path

import bmesh
import bpy
from sardf_blender.parts import (
    part_bake,
    part_now,
    part_objects,
    part_preview,
    part_scene,
    part_status,
)
from sardf_blender.preview import preview

CASES = {}


def case(check):
    CASES[check.__name__] = check
    return check


def main(scene_file, folder):
    """Each check in an empty file with the part of the scene file."""
    result = {}
    for name, check in CASES.items():
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        bpy.ops.sardf.part_import(filepath=scene_file)
        settings = bpy.context.scene.sardf
        settings.resolution, settings.size = 24, "256"
        result[name] = check(bpy.context.active_object, Path(folder))
    return result


def depsgraph():
    return bpy.context.evaluated_depsgraph_get()


def sections(part):
    return part_scene.read(part, depsgraph()).scene.get("sections", [])


def add(part, kind, **more):
    """A new section object of the part."""
    bpy.context.view_layer.objects.active = part
    bpy.ops.sardf.section_add(kind=kind, **more)
    return bpy.context.active_object


def run(operator, part):
    """What an operator says of a part, or how it ends."""
    bpy.context.view_layer.objects.active = part
    try:
        return list(operator())
    except RuntimeError as error:
        return str(error)


def mesh_of(item):
    """Vertices, the fraction "red" at each, the volume, and whether every edge has two faces."""
    made = bmesh.new()
    made.from_mesh(item.data)
    closed = all(len(edge.link_faces) == 2 for edge in made.edges)
    result = {
        "points": [list(vertex.co) for vertex in item.data.vertices],
        "red": [value.value for value in item.data.attributes["red"].data],
        "volume": made.calc_volume(),
        "closed": closed,
    }
    made.free()
    return result


@case
def planes(part, _folder):
    """What a plane removes, after it, its part or both were moved, turned and scaled."""
    plane = add(part, "plane")
    made = {"new": sections(part), "parent": plane.parent == part, "lines": len(plane.data.edges)}
    part.location, part.rotation_euler, part.scale = (5, 6, 7), (0.3, 0.2, 0.1), (2, 2, 2)
    made["part moved"] = sections(part)
    plane.location = (0, -1, 0)
    made["moved"] = sections(part)
    plane.scale.x *= -1
    made["mirrored"] = sections(part)
    plane.scale.z *= -1
    made["inside out"] = sections(part)
    plane.sardf_section.mute = True
    made["muted"] = sections(part)
    return made


@case
def box(part, _folder):
    item = add(part, "box")
    item.location, item.scale = (1, 2, 3), (1, 2, -3)
    return sections(part)


@case
def together(part, _folder):
    """A quarter is removed where two planes cut together."""
    add(part, "plane")
    other = add(part, "plane")
    other.rotation_euler = (0, 1.57079633, 0)
    part.sardf_part.sections[1].operation = "intersection"
    made = {"sections": sections(part), "planes": [len(cut) for cut in shown(part).cuts]}
    made["bake"] = run(bpy.ops.sardf.bake, part)
    made["mesh"] = mesh_of(part.sardf_part.baked)
    part.sardf_part.sections[1].keep = "ball"
    made["kept"] = sections(part)
    made["planes where something is kept"] = [len(cut) for cut in shown(part).cuts]
    return made


def shown(part):
    """What the preview is given of the part."""
    return part_preview.from_parts(bpy.context.scene, depsgraph()).get(part.name)


@case
def everywhere(part, folder):
    """A plane for all parts, and the ways in which a part is left whole."""
    path = folder / "again.json"
    bpy.ops.sardf.part_export(filepath=str(path))
    bpy.ops.sardf.part_import(filepath=str(path))
    other = bpy.context.active_object
    other.location.y = 1
    plane = add(part, "plane", everywhere=True)
    plane.location.y = -0.5
    made = {"both": [sections(part), sections(other)], "free": plane.parent is None}
    bpy.context.view_layer.objects.active = part
    bpy.ops.sardf.section_list(name=plane.name)
    made["listed"] = [sections(part), sections(other)]
    part.sardf_part.sections[0].mute = True
    made["muted in one"] = [sections(part), sections(other)]
    part.sardf_part.sections.clear()
    part.sardf_part.scene_sections = False
    made["ignored by one"] = [sections(part), sections(other)]
    plane.sardf_section.mute = True
    made["muted"] = [sections(part), sections(other)]
    return made


@case
def pieces(part, _folder):
    """Two planes at right angles, and what they cut the ball into."""
    first, second = add(part, "plane"), add(part, "plane")
    second.rotation_euler = (0, 1.57079633, 0)
    first.location.y, second.location.x = -1, 2
    first.sardf_section.spread = 4
    for frame, spread in ((1, 0), (11, 6)):
        second.sardf_section.spread = spread
        second.sardf_section.keyframe_insert("spread", frame=frame)
    made = {"bake": run(bpy.ops.sardf.bake_pieces, part)}
    items = {i.get("sardf_piece", "00"): i for i in part.children if "sardf_source" in i}
    made["meshes"] = {code: mesh_of(item) for code, item in items.items()}
    made["places"] = {frame: places(items, frame) for frame in (1, 11)}
    before = [len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.images)]
    run(bpy.ops.sardf.bake_pieces, part)
    made["again"] = before == [len(bpy.data.objects), len(bpy.data.meshes), len(bpy.data.images)]
    second.location.x = 20
    run(bpy.ops.sardf.bake_pieces, part)
    made["cut by one"] = sorted(i["sardf_piece"] for i in part.children if "sardf_piece" in i)
    return made


def places(items, frame):
    bpy.context.scene.frame_set(frame)
    return {code: list(item.evaluated_get(depsgraph()).matrix_local.translation)
            for code, item in items.items()}  # fmt: skip


@case
def nothing_left(part, _folder):
    """Sections that remove everything: a message, and an empty object that is filled again."""
    plane = add(part, "plane")
    first = run(bpy.ops.sardf.bake, part)
    item = part.sardf_part.baked
    full, material = len(item.data.vertices), item.data.materials[0]
    bpy.context.scene.sardf_preview.enabled = True
    plane.location.y = 50
    bpy.context.view_layer.update()
    part.sardf_part.show = "preview"
    updated = list(bpy.ops.sardf.preview_update())  # a message is no error
    said = {key: [of.error, of.note] for key, of in preview.CURRENT.parts.items()}
    part.sardf_part.show = "newer"
    second = run(bpy.ops.sardf.bake, part)
    empty = [len(item.data.vertices), item.data.materials[0] == material]
    plane.location.y = 0
    frames = [len(i.data.vertices) for _, i in part_bake.rebake_frames(bpy.context, part, (1,))]
    bpy.context.scene.sardf_preview.enabled = False
    preview.collect()
    return {"ends": [first, second, updated], "full": full, "empty": empty, "frames": frames,
            "said": said, "kept": item.data.materials[0] == material}  # fmt: skip


@case
def wrong(part, _folder):
    """Each in one sentence, as the panel says it."""
    plane = add(part, "plane")
    plane.scale = (0, 0, 0)
    made = {"zero": said(part), "zero baked": run(bpy.ops.sardf.bake, part)}
    plane.scale = (1, 1, 1)
    empty = bpy.data.objects.new("empty", None)
    bpy.context.collection.objects.link(empty)
    section = part.sardf_part.sections[0]
    section.object, empty.scale = empty, (1, 0, 1)
    made["flat empty"] = said(part)
    section.object = plane
    bpy.context.scene.collection.objects.unlink(plane)
    made["deleted"] = said(part)
    bpy.data.objects.remove(plane)
    made["removed"] = said(part)
    section.text = "{"
    made["text"] = said(part)
    part.sardf_part.sections.clear()
    made["no pieces"] = run(bpy.ops.sardf.bake_pieces, part)
    for _ in range(5):
        add(part, "plane")
    made["too many"] = run(bpy.ops.sardf.bake_pieces, part)
    return made


def said(part):
    status = part_status.status(part, depsgraph())
    return [status.error] if status.error else list(status.lines)


@case
def linked(part, folder):
    """A section object of a library cuts a part of this file, and a linked part is cut here."""
    plane = add(part, "plane")
    plane.name, part.name = "its plane", "its part"
    path = str(folder / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    bpy.ops.sardf.primitive_add(kind="box")
    (own,) = part_objects.parts(bpy.context.scene)
    for name in ("its plane", "its part"):
        bpy.ops.wm.append(directory=f"{path}/Object/", filename=name, link=True,
                          instance_collections=False)  # fmt: skip
    theirs = next(i for i in bpy.data.objects if i.library and i.sardf_part.is_part)
    own.sardf_part.sections.add().object = bpy.data.objects["its plane"]
    made = {"own": sections(own), "theirs": sections(theirs)}
    add(theirs, "plane").location.y = 3
    made["cut here"] = sections(theirs)
    made["own is cut, too"] = len(sections(own))
    return made


@case
def once(part, _folder):
    """How often a part is read after a change, though status, preview and mark ask."""
    plane = add(part, "plane")
    count, original = [0], part_scene.read

    def read(*arguments):
        count[0] += 1
        return original(*arguments)

    part_scene.read = read
    made = []
    try:
        for step in range(4):
            if step < 2:
                plane.location.y = step + 1
            elif step == 2:
                bpy.data.objects.remove(plane)
            count[0] = 0
            for _ in range(3):
                part_status.status(part, depsgraph())
                shown(part)
                part_now.now(part, depsgraph()).mark  # noqa: B018
            made.append(count[0])
    finally:
        part_scene.read = original
    return made


@case
def choice(part, _folder):
    """Which of preview and baked object is seen, by the part's choice."""
    plane = add(part, "plane")
    made = {"before": shown(part) is not None}
    run(bpy.ops.sardf.bake, part)
    baked = part.sardf_part.baked
    made["up to date"] = [shown(part) is not None, said(part)]
    plane.location.y = -1
    made["changed"] = [shown(part) is not None, said(part)]
    plane.location.y = 0
    made["back"] = shown(part) is not None
    baked.hide_set(True)
    made["hidden by hand"] = [shown(part) is not None, baked.hide_get()]
    baked.hide_set(False)
    for name in ("preview", "newer", "preview", "baked"):
        part.sardf_part.show = name
        made[name] = [shown(part) is not None, baked.hide_get()]
    baked.hide_set(True)
    part.sardf_part.show = "preview"
    part.sardf_part.show = "newer"
    made["still hidden by hand"] = baked.hide_get()
    part.sardf_part.show = "baked"
    plane.location.y = -1
    made["baked, though changed"] = shown(part) is not None
    plane.location.y = 0
    part.sardf_part.show = "newer"
    baked.location.z = 9
    made["baked stands elsewhere"] = shown(part) is not None
    part.sardf_part.show = "baked"
    bpy.data.objects.remove(baked)
    made["baked is gone"] = shown(part) is not None
    return made


@case
def file(part, _folder):
    """The sections of a file are objects; moving one changes it alone."""
    scene = json.loads(part.sardf_part.imported)
    quarter = {"remove": {"intersection": [{"half_space": {"normal": "x"}},
                                           {"half_space": {"normal": [0, -1, 0]}}]}}  # fmt: skip
    scene["sections"] = [quarter, {"remove": {"box": {"size": [2, 2, 2], "center": [0, 3, 0]}},
                                   "keep": ["ball"]}]  # fmt: skip
    path = Path(_folder) / "sections.json"
    path.write_text(json.dumps(scene))
    bpy.ops.sardf.part_import(filepath=str(path))
    part = bpy.context.active_object
    listed = part.sardf_part.sections
    made = {"kinds": [s.object.sardf_primitive.kind for s in listed],
            "are": [s.object.sardf_section.is_section for s in listed],
            "how": [s.operation for s in listed], "same": sections(part)}  # fmt: skip
    listed[1].object.location.y = -1
    made["moved"] = sections(part)
    made["original"] = scene["sections"]
    return made
