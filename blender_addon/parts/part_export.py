# SPDX-License-Identifier: GPL-3.0-or-later
"""A part as a scene file, with the meshes that it reads beside it."""

import json
import os
import shutil
from pathlib import Path

import bpy

from . import mesh_files, part_scene
from .part_error import PartError

ENDING = "_meshes"  # of the folder beside the file for meshes of our own


def write(part, path, depsgraph):
    """Write the scene file; returns warnings. Raises PartError and OSError."""
    document, warnings = part_scene.document_of(part, depsgraph)
    path = Path(bpy.path.abspath(str(path))).resolve()
    if not path.parent.is_dir():
        raise PartError(f"{path}: there is no folder {path.parent}")
    document = _with_paths(document, part.sardf_part.folder, path)
    text = json.dumps(document, indent=1, ensure_ascii=False) + "\n"
    unfinished = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        unfinished.write_text(text, encoding="utf-8")
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)
    return warnings


def _with_paths(value, folder, target):
    """JSON data whose file names are right seen from the target's folder."""
    if isinstance(value, list):
        return [_with_paths(each, folder, target) for each in value]
    if not isinstance(value, dict):
        return value
    return {
        key: _path(each, folder, target) if key == "path" and isinstance(each, str)
        else _with_paths(each, folder, target)
        for key, each in value.items()
    }  # fmt: skip


def _path(name, folder, target):
    if Path(name).parent == mesh_files.folder():
        kept = target.with_name(target.stem + ENDING)
        kept.mkdir(exist_ok=True)
        shutil.copyfile(name, kept / Path(name).name)
        return f"{kept.name}/{Path(name).name}"
    if Path(name).is_absolute() or not folder or Path(folder).resolve() == target.parent:
        return name
    return os.path.relpath(Path(folder, name), target.parent)
