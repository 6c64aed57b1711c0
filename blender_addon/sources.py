# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a headless run finds what to make: a scene file, or a part in a .blend file."""

import importlib
from pathlib import Path

from .arguments import FAILED, WRONG_INPUT, Stop


def find(options):
    """(path, scene) for job.Request: the scene file and None, or the name of a part and its
    dictionary. Raises Stop."""
    if options.scene and not options.scene.lower().endswith(".blend"):
        return options.scene, None
    part = part_of(options)
    part_scene, error = _module("parts.part_scene"), _module("parts.part_error").PartError
    try:
        scene, warnings = part_scene.scene_of(part, _depsgraph())
    except error as problem:
        raise Stop(WRONG_INPUT, str(problem)) from problem
    for warning in warnings:
        print(f"sardf: {warning}")
    return part.name, scene


def part_of(options):
    """The part of the .blend file that the options name, or of the opened file. Raises Stop."""
    import bpy

    register()
    if options.scene:
        open_file(options.scene)
    place = options.scene or bpy.data.filepath or "the opened file"
    parts = [item for item in bpy.context.scene.objects if item.sardf_part.is_part]
    used = {entry.object for part in parts for entry in part.sardf_part.entries}
    whole = [part for part in parts if part not in used]  # others are entries of parts
    names = ", ".join(f"'{part.name}'" for part in parts)
    if options.part:
        found = next((part for part in parts if part.name == options.part), None)
        if found is None:
            known = f"; it has {names}" if parts else ""
            raise Stop(WRONG_INPUT, f"{place}: has no part '{options.part}'{known}")
        return found
    if len(whole) != 1:
        said = f"has the parts {names}; choose one with --part" if whole else "has no part"
        raise Stop(WRONG_INPUT, f"{place}: {said}")
    return whole[0]


def start_empty(as_command):
    """An empty Blender session. A command belongs to an enabled add-on, so it keeps the
    preferences; a script starts from factory settings."""
    import bpy

    if as_command:
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    else:
        bpy.ops.wm.read_factory_settings(use_empty=True)


def register():
    """Let Blender know the properties of parts, unless an enabled add-on did already."""
    import bpy

    if not hasattr(bpy.types.Object, "sardf_part"):
        importlib.import_module(__package__).register()


def open_file(path):
    """Open a .blend file. Raises Stop."""
    import bpy

    if not Path(path).is_file():
        raise Stop(WRONG_INPUT, f"{path}: there is no such file")
    try:
        bpy.ops.wm.open_mainfile(filepath=str(Path(path).resolve()), load_ui=False)
    except RuntimeError as error:
        text = " ".join(str(error).split())
        raise Stop(FAILED, f"{path}: Blender cannot open it: {text}") from error


def _depsgraph():
    import bpy

    return bpy.context.evaluated_depsgraph_get()


def _module(name):
    return importlib.import_module(f".{name}", __package__)
