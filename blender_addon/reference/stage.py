# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender scene as the core's stage: camera, lights, world, and the parts in their places."""

import dataclasses
import json
from dataclasses import dataclass, field
from pathlib import Path

import bpy

from .. import core
from ..baked import assemble
from ..parts import part_bake, part_objects, part_scene
from ..parts.part_error import PartError
from ..picture import camera as picture_camera
from . import lights

CAMERA_NUMBERS = (
    "lens", "sensor_width", "sensor_height", "ortho_scale", "shift_x", "shift_y", "clip_start",
    "clip_end",
)  # fmt: skip
SOLIDS = ("MESH", "CURVE", "SURFACE", "META", "FONT", "VOLUME", "CURVES", "POINTCLOUD")
MOST_NAMES = 3  # in a message


class StageError(Exception):
    """A scene that cannot be drawn, in one sentence."""


@dataclass
class Part:
    """`key` finds the part again (part_bake.key_of), or is None; `item`: the baked object's name,
    or None; `request`: what to bake where there is none."""

    name: str
    scene: object
    matrix: list
    key: tuple | None = None
    item: str | None = None
    request: object = None


@dataclass
class Stage:
    """`text`: JSON for the core; `warnings`: what is not carried over, in sentences."""

    text: str
    parts: list
    width: int
    height: int
    warnings: list = field(default_factory=list)


def of_scene(context, texels=0):
    """The Stage of a context's scene; `texels` along a texture's side of what must be baked, 0: as
    the panel says. Raises StageError, PartError and sardf.Error."""
    scene, depsgraph = context.scene, context.evaluated_depsgraph_get()
    view, warnings = _camera(scene, depsgraph)
    world, problems = _world(scene)
    warnings += problems
    found, problems = lights.of_scene(context.view_layer, depsgraph)
    warnings += problems
    parts, problems = _parts(context, depsgraph, texels)
    warnings += problems + _others(context, parts)
    width, height, problems = _size(scene)
    stage = {
        "blender": list(bpy.app.version),
        "camera": view,
        "world": world,
        "lights": found,
        "parts": [{"scene": part.scene, "matrix_world": part.matrix} for part in parts],
    }
    return Stage(json.dumps(stage), parts, width, height, warnings + problems)


def _camera(scene, depsgraph):
    """(the camera as a camera.json has it, warnings)."""
    if scene.camera is None or scene.camera.type != "CAMERA":
        raise StageError(f"the scene '{scene.name}' has no camera; add one, or choose it as active")
    item = scene.camera.evaluated_get(depsgraph)
    data = item.data
    if data.type not in picture_camera.CHOICES["type"]:
        raise StageError(
            f"the camera '{item.name}' is a panoramic one; perspective and orthographic cameras "
            "can be rendered in POV-Ray"
        )
    view = {key: getattr(data, key) for key in CAMERA_NUMBERS}
    view |= {"type": data.type, "sensor_fit": data.sensor_fit, "matrix_world": _rows(item)}
    if data.dof.use_dof:
        return view, [f"the depth of field of the camera '{item.name}' is not carried over"]
    return view, []


def _rows(item):
    return [list(row) for row in item.matrix_world]


def _size(scene):
    """(width, height, warnings) of the picture in pixels."""
    settings = scene.render
    warnings = []
    if settings.pixel_aspect_x != settings.pixel_aspect_y:
        warnings.append("the pixels' aspect is not carried over")
    if settings.use_border:
        warnings.append("the render region is not carried over: the whole picture is rendered")
    share = settings.resolution_percentage
    return (
        max(1, settings.resolution_x * share // 100),
        max(1, settings.resolution_y * share // 100),
        warnings,
    )


def _world(scene):
    """(colour and strength of a plain world, warnings); of any other, black."""
    world, black = scene.world, {"color": [0.0, 0.0, 0.0]}
    if world is None:
        return black, []
    if not has_nodes(world):
        return {"color": list(world.color)}, []
    output = next((n for n in world.node_tree.nodes if n.type == "OUTPUT_WORLD" and
                   n.is_active_output), None)  # fmt: skip
    if output is None:
        return black, []
    warnings = []
    if output.inputs["Volume"].is_linked:
        warnings.append(f"the volume of the world '{world.name}' is not carried over")
    if not output.inputs["Surface"].is_linked:
        return black, warnings
    source = output.inputs["Surface"].links[0].from_node
    if source.type == "BACKGROUND" and not any(s.is_linked for s in source.inputs):
        color, strength = source.inputs["Color"], source.inputs["Strength"]
        light = {"color": list(color.default_value)[:3], "strength": strength.default_value}
        return light, warnings
    kinds = {node.type for node in world.node_tree.nodes}
    what = next(
        (
            said for kind, said in (("TEX_ENVIRONMENT", "environment picture (HDRI)"),
                                    ("TEX_SKY", "sky texture")) if kind in kinds
        ),
        "nodes",
    )  # fmt: skip
    return black, [
        *warnings,
        f"the {what} of the world '{world.name}' is not carried over; only a plain colour is, "
        "and without one the world is black",
    ]


def has_nodes(owner):
    """Blender 5.0 has nodes always and warns of the question."""
    return owner.node_tree is not None and (bpy.app.version >= (5, 0, 0) or owner.use_nodes)


def _parts(context, depsgraph, texels):
    """(the Parts of a scene, warnings): modelled ones, and what was baked from scene files."""
    sardf = core.load()
    scene, settings = context.scene, context.scene.sardf
    made, warnings = [], []
    rendered = lights.rendered(context.view_layer)
    for part in part_objects.parts(scene):
        if part not in rendered or part_objects.outermost(part) != part:
            continue
        document, problems = part_scene.scene_of(part, depsgraph)
        warnings += problems
        if not settings.sections:
            document = document | {"sections": []}
        baked = baked_of(part)
        request = None
        if baked is None:
            request, _ = part_bake.request_of(part, settings, depsgraph)
            request = dataclasses.replace(request, size=texels or request.size)
        matrix = _rows(part.evaluated_get(depsgraph))
        key, name = part_bake.key_of(part), baked and baked.name
        made.append(Part(part.name, document, matrix, key, name, request))
    for item in rendered:
        source = item.get(assemble.SOURCE)
        if item.type != "MESH" or not source or part_objects.is_part(item.parent):
            continue
        if not Path(source).is_file():
            warnings.append(f"'{item.name}' was baked from {source}, which is gone; it is left out")
            continue
        document = source
        if not settings.sections:
            document = json.loads(sardf.load(source).to_json()) | {"sections": []}
        matrix = _rows(item.evaluated_get(depsgraph))
        made.append(Part(item.name, document, matrix, None, item.name))
    if not made:
        raise StageError(
            "there is nothing to draw: the scene has no part, and nothing in it was baked"
        )
    return made, warnings


def baked_of(part):
    """The mesh object that a bake left under a part, or None."""
    made = [
        item for item in part.children
        if item.type == "MESH" and assemble.SOURCE in item and item.users_scene
    ]  # fmt: skip
    last = part.sardf_part.baked
    return last if last in made else next(iter(made), None)


def _others(context, parts):
    """A warning of the objects that only Cycles would show."""
    baked = {part.item for part in parts}
    names = [
        f"'{item.name}'" for item in lights.rendered(context.view_layer)
        if item.type in SOLIDS and item.name not in baked and assemble.SOURCE not in item
    ]  # fmt: skip
    if not names:
        return []
    more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
    return [f"objects that are no parts are left out: {', '.join(names[:MOST_NAMES])}{more}"]


__all__ = ["PartError", "Stage", "StageError", "of_scene"]
