# SPDX-License-Identifier: GPL-3.0-or-later
"""Baked objects rendered in Cycles as POV-Ray renders the parts: one sample through each pixel's
centre or many, no filter, no bounces, linear; in a scene of its own, so that no setting of the
user's changes."""

from pathlib import Path

import bpy

from ..baked import assemble, groups, material
from ..picture import render
from . import lights

NAME = "sardf reference"
MATERIALS = {"flat": material.build_flat, "shaded": material.build_matte}


class NoPicture(Exception):
    """Why there is nothing to render, in one sentence."""


def picture(context, names, look, samples, size, path):
    """Render the objects of some names in a look into `path`, a .exr file, under the lights, the
    world and the camera of the context's scene. Raises NoPicture."""
    if not hasattr(bpy.types.Scene, "cycles"):
        raise NoPicture(
            "Cycles is not there to compare with; enable the add-on Cycles Render Engine"
        )
    items = [_object(name) for name in names]
    if context.scene.camera is None:
        raise NoPicture(f"the scene '{context.scene.name}' has no camera any more")
    textures = [base_color(item) for item in items]
    scene = bpy.data.scenes.new(NAME)
    made = []
    try:
        _light(scene, context)
        for item, texture in zip(items, textures, strict=True):
            copy = item.copy()
            copy.hide_render = False
            scene.collection.objects.link(copy)
            made += [copy, _dress(copy, MATERIALS[look](texture))]
        _set(scene, look, samples, size)
        render.to_file(scene, Path(path))
    except RuntimeError as error:
        raise NoPicture(f"Cycles: {' '.join(str(error).split())}") from error
    finally:
        bpy.data.scenes.remove(scene)
        bpy.data.batch_remove(made)


def _object(name):
    """A baked object, which may be gone since the reference began. Raises NoPicture."""
    item = bpy.data.objects.get(name or "")
    if item is None or assemble.SOURCE not in item:
        raise NoPicture(f"the baked object '{name}' is gone; bake it again")
    return item


def base_color(item):
    """The image that a bake made of an object's base colour. Raises NoPicture."""
    for slot in item.material_slots:
        nodes = slot.material.node_tree.nodes if slot.material and slot.material.node_tree else {}
        node = nodes.get(groups.node_name("base_color"))
        if node is not None and node.image is not None:
            return node.image
    source = item[assemble.SOURCE]
    for image in bpy.data.images:
        if image.get(assemble.SOURCE) == source and image.name.partition(" base_color")[1]:
            return image
    raise NoPicture(f"the image of the base colour of '{item.name}' is gone; bake it again")


def _light(scene, context):
    """The lights, the camera, the world and the frame of the context's scene."""
    origin = context.scene
    for item in lights.rendered(context.view_layer):
        if item.type == "LIGHT":
            scene.collection.objects.link(item)
    if origin.camera.name not in scene.collection.objects:
        scene.collection.objects.link(origin.camera)
    scene.camera = origin.camera
    scene.world = origin.world
    scene.frame_set(origin.frame_current, subframe=origin.frame_subframe)


def _dress(item, dress):
    """Let an object show one material without changing its mesh; returns the material."""
    for slot in item.material_slots:
        slot.link = "OBJECT"
        slot.material = dress
    return dress


def _set(scene, look, samples, size):
    render.set_common(scene)
    render.set_size(scene, *size)
    render.set_exact(scene)
    scene.cycles.max_bounces = scene.cycles.diffuse_bounces = 0
    if look == "shaded":
        scene.cycles.samples = samples
