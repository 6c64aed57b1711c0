# SPDX-License-Identifier: GPL-3.0-or-later
"""What the next bake is of, on which UV map, and where its textures go."""

import dataclasses
from pathlib import Path

import bpy
from mathutils import Matrix

from . import bake_settings, core, properties
from .baked import assemble, exact, images, job, mesh_data, store, unwrap
from .parts import part_bake, part_objects
from .parts.part_error import PartError


def expected():
    """The exceptions whose text is the message: input that is wrong, not code."""
    found = (
        core.MissingCore, PartError, store.StoreError, unwrap.UnwrapError, images.ColorSpaceError,
    )  # fmt: skip
    try:
        return (*found, core.load().Error)
    except core.MissingCore:
        return found


@dataclasses.dataclass
class Plan:
    """`request` for the job; `part`: the key of the part, None for the scene file; `target`: the
    key of the object whose mesh is baked as it is, or None, and `layer` its UV map."""

    request: job.Request
    part: tuple | None
    target: tuple | None
    layer: str
    packed: bool
    warnings: list


def active_part(context):
    """The part that a bake would be of, or None."""
    return part_objects.outermost(part_objects.part_of(context.active_object))


def make(context):
    """The Plan of what the panel shows. Raises PartError and StoreError."""
    settings = context.scene.sardf
    part = active_part(context)
    if part is not None:
        request, warnings = part_bake.request_of(part, settings, context.evaluated_depsgraph_get())
    elif settings.filepath:
        request, warnings = properties.request(settings), []
    else:
        raise PartError("there is nothing to bake: no scene file, and no part is active")
    target, layer, given = None, mesh_data.LAYER, None
    if settings.uv_source == bake_settings.EXISTING:
        item = target_of(context.scene, settings, part, request.path)
        target, layer = part_bake.key_of(item), item.data.uv_layers.active.name
        given = mesh_data.read(item.data, layer, _frame(item, part, request.path), item.name)
    if settings.exact_shading and not exact.is_there():
        warnings.append("no exact shading: this Blender was built without OSL")
    packed = settings.destination == bake_settings.PACKED
    request = dataclasses.replace(
        request,
        channels=tuple(bake_settings.names_of(settings.channels)),
        uv={"ATLAS": job.ATLAS, "SMART": job.SMART, "EXISTING": job.GIVEN}[settings.uv_source],
        given=given,
        osl=settings.exact_shading and exact.is_there(),
        store=store_of(settings, _name(part, request), packed),
    )
    key = None if part is None else part_bake.key_of(part)
    return Plan(request, key, target, layer, packed, warnings)


def earlier(scene, part, source):
    """What an earlier bake made of the part, or of the scene file `source`, or None."""
    return assemble.find(scene, source) if part is None else part_bake.baked_of(part)


def target_of(scene, settings, part, source):
    """The object whose UV map is baked on. Raises PartError."""
    item = settings.uv_object or earlier(scene, part, source)
    if item is None:
        raise PartError(
            "there is no baked object yet whose UV map could be used: choose an object, or bake on "
            "an own atlas first"
        )
    if item.type != "MESH":
        raise PartError(f"'{item.name}' is no mesh; its UV map cannot be baked on")
    if item.library is not None or item.data.library is not None:
        raise PartError(f"'{item.name}' is linked from another file and cannot be changed")
    if item.mode == "EDIT":
        item.update_from_editmode()
    if not len(item.data.polygons):
        raise PartError(f"'{item.name}' has no faces to bake on")
    if item.data.uv_layers.active is None:
        raise PartError(f"'{item.name}' has no UV map: unwrap it, or choose another UV Map here")
    return item


def find_target(key, vertices):
    """The target of a key after the bake. Raises PartError."""
    item = bpy.data.objects.get(key)
    if item is None or item.type != "MESH":
        raise PartError(f"'{key[0]}' is gone; what was baked on it is dropped")
    if len(item.data.vertices) != vertices or item.mode == "EDIT":
        raise PartError(f"'{key[0]}' was edited while it was baked on; bake again")
    return item


def check(plan):
    """Whether what is baked is still there. Raises PartError."""
    if plan.part is not None:
        part_bake.find(plan.part)
    if plan.target is not None and bpy.data.objects.get(plan.target) is None:
        raise PartError(f"'{plan.target[0]}' is gone; the bake on it is stopped")


def _frame(item, part, source):
    """From the object's own frame to the scene's; what was baked has the same."""
    if item.get(assemble.SOURCE) == source:
        return Matrix.Identity(4)
    matrix = part_objects.world_of(item)
    if part is not None:
        matrix = part_objects.world_of(part).inverted_safe() @ matrix
    if not matrix.to_3x3().determinant():
        raise PartError(f"'{item.name}' has a scale of 0")
    return matrix


def _name(part, request):
    return Path(request.path).stem if part is None else part.name


def store_of(settings, name, packed):
    """Where the textures of something of this name are written. Raises StoreError."""
    if packed:
        return store.Store(Path(bpy.app.tempdir) / "sardf bake", name, replace=True)
    if not settings.folder:
        raise store.StoreError("choose a folder for the textures")
    if settings.folder.startswith("//") and not bpy.data.is_saved:
        raise store.StoreError(
            f"the folder {settings.folder} is beside the .blend, which is not saved yet; save it, "
            "or choose another folder"
        )
    return store.Store(bpy.path.abspath(settings.folder), name, settings.replace_files)
