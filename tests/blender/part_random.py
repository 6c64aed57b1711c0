# SPDX-License-Identifier: GPL-3.0-or-later
"""Random work on parts: build, edit, move, bake, undo, copy, delete, save, load, import, export."""

import random
from pathlib import Path

import bpy
from sardf_blender.parts import part_objects, part_presets, part_scene, primitives

KINDS = ("objects", "meshes", "curves", "materials", "images", "collections", "actions")


class Work:
    """Random steps; each is one operator or what a user does by hand."""

    def __init__(self, seed, folder):
        self.random = random.Random(seed)
        self.folder = Path(folder)
        self.done = dict.fromkeys(STEPS, 0)
        self.unexpected = []

    def step(self):
        weights = {"add": 4, "bake": 4, "bake_pieces": 4, "redo": 8, "delete": 1}
        often = [weights.get(name, 2) for name in STEPS]
        (name,) = self.random.choices(list(STEPS), often)
        try:
            STEPS[name](self)
            self.done[name] += 1
        except RuntimeError as error:  # an operator's report is one line that names the cause
            text = str(error).strip()
            refused = "poll() failed" in text and name in ("undo", "redo", "bake", "bake_pieces")
            if not (text.startswith("Error: ") or refused) or "Traceback" in text:
                self.unexpected.append(f"{name}: {text}")
        except part_scene.PartError:
            pass  # one sentence; test_blender_bad_parts reads them
        except Exception as error:
            self.unexpected.append(f"{name}: {type(error).__name__}: {error}")
        if name not in ("undo", "redo"):
            bpy.ops.ed.undo_push(message=name)

    def pick(self, items):
        items = list(items)
        return self.random.choice(items) if items else None

    def activate(self, item):
        if item is not None and item.name in bpy.context.view_layer.objects:
            bpy.ops.object.select_all(action="DESELECT")
            item.select_set(True)
            bpy.context.view_layer.objects.active = item
        return item

    def part(self):
        return self.activate(self.pick(part_objects.parts(bpy.context.scene)))

    def number(self, low=-2.0, high=2.0):
        return self.random.uniform(low, high)


def add(work):
    work.part()
    kind = work.pick(primitives.KINDS)
    operation = work.pick(("union", "intersection", "difference"))
    bpy.ops.sardf.primitive_add(kind=kind, operation=operation)
    bpy.context.active_object.location = [work.number() for _ in range(3)]


def new_part(work):
    bpy.ops.object.select_all(action="DESELECT")
    for item in work.random.sample(list(bpy.context.scene.objects),
                                   min(2, len(bpy.context.scene.objects))):  # fmt: skip
        item.select_set(True)
    bpy.ops.sardf.part_new()


def move(work):
    item = work.pick(bpy.context.scene.objects)
    if item is not None:
        item.location = [work.number() for _ in range(3)]
        item.rotation_euler = [work.number() for _ in range(3)]
        item.scale = [work.pick((1, 1, 1, 0.5, 1.5, 2, -1, -1, 1, 0)) for _ in range(3)]


def edit_list(work):
    part = work.part()
    which = work.pick(("entries", "materials", "features", "sections"))
    if part is not None:
        setattr(part.sardf_part, {"entries": "entry_index", "materials": "material_index"}.get(
            which, "feature_index"), work.random.randrange(4))  # fmt: skip
    action = work.pick(("add", "remove", "up", "down", "show", "restore"))
    bpy.ops.sardf.list(which=which, action=action)


def edit_entry(work):
    part = work.part()
    entry = work.pick(part.sardf_part.entries) if part else None
    if entry is not None:
        entry.mute = work.pick((True, False))
        entry.blend = work.pick(("min_max", "sardf", "smooth", "r_function", "sardf_c1"))
        entry.operation = work.pick(("union", "difference", "none"))
        entry.radius = work.number(0)
        entry.name = work.pick(("one", "two", "x", "größe", ""))


def add_section(work):
    work.part()
    everywhere = work.pick((True, False, False))
    bpy.ops.sardf.section_add(kind=work.pick(("plane", "box")), everywhere=everywhere)
    bpy.context.active_object.location = [work.number() for _ in range(3)]


def edit_section(work):
    part = work.part()
    section = work.pick(part.sardf_part.sections) if part else None
    if section is not None:
        section.mute = work.pick((True, False, False))
        section.operation = work.pick(("union", "intersection"))
        section.keep = work.pick(("", "", "nothing of that name"))
        part.sardf_part.show = work.pick(("newer", "preview", "baked"))


def bake_pieces(work):
    part = work.part()
    if part is not None and not part.sardf_part.sections:
        bpy.ops.sardf.section_add(kind="plane")
        work.activate(part)
    bpy.context.scene.sardf.resolution, bpy.context.scene.sardf.size = 4, "256"
    bpy.ops.sardf.bake_pieces()


def preset(work):
    work.part()
    bpy.ops.sardf.preset(choice=work.pick(part_presets.PRESETS), depth=work.number(0.1))


def bake(work):
    work.part()
    bpy.context.scene.sardf.resolution, bpy.context.scene.sardf.size = 4, "256"
    bpy.ops.sardf.bake()


def read(work):
    part = work.part()
    if part is not None:
        part_scene.scene_of(part, bpy.context.evaluated_depsgraph_get())


def undo(_work):
    bpy.ops.ed.undo()


def redo(_work):
    bpy.ops.ed.redo()


def copy(work):
    part = work.part()
    if part is not None and len(bpy.data.objects) < 60:
        for item in part.children_recursive:
            item.select_set(True)
        bpy.ops.object.duplicate()


def delete(work):
    work.activate(work.pick(bpy.context.scene.objects))
    bpy.ops.object.delete()


def remove_part(work):
    work.part()
    bpy.ops.sardf.part_remove()


def save_and_load(work):
    path = str(work.folder / "random.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)


def export_and_import(work):
    work.part()
    path = str(work.folder / "random.json")
    bpy.ops.sardf.part_export(filepath=path)
    bpy.ops.sardf.part_import(filepath=path)


STEPS = {
    each.__name__: each
    for each in (add, new_part, move, edit_list, edit_entry, add_section, edit_section, bake_pieces,
                 preset, bake, read, undo, redo, copy,
                 delete, remove_part, save_and_load, export_and_import)
}  # fmt: skip


def remove_all():
    """Remove all parts, then what no one uses, as saving does; returns what is still there."""
    for item in list(bpy.data.objects):
        if item.sardf_part.is_part:
            item.sardf_part.entries.clear()
            item.sardf_part.features.clear()
            item.sardf_part.sections.clear()
            item.sardf_part.baked = None
    bpy.data.batch_remove(list(bpy.context.scene.objects))
    bpy.data.orphans_purge(do_recursive=True)
    left = {kind: [item.name for item in getattr(bpy.data, kind)] for kind in KINDS}
    return {kind: names for kind, names in left.items() if names}


def main(sequences, steps, seed, folder):
    work = Work(int(seed), folder)
    left = {}
    for sequence in range(int(sequences)):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        add(work)
        add(work)
        bpy.ops.ed.undo_push(message="start")
        for _ in range(int(steps)):
            work.step()
        names = remove_all()
        if names:
            left[sequence] = names
    return {"done": work.done, "unexpected": work.unexpected, "left": left}
