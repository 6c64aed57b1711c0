# SPDX-License-Identifier: GPL-3.0-or-later
"""From one made part to a Blender object with mesh, material and images."""

import bpy
import numpy as np
from mathutils import Vector

from . import images, material, mesh_data

SOURCE = "sardf_source"  # custom property: the scene file that an object was baked from
UNITS = {
    "um": ("METRIC", "MICROMETERS"),
    "mm": ("METRIC", "MILLIMETERS"),
    "cm": ("METRIC", "CENTIMETERS"),
    "m": ("METRIC", "METERS"),
    "in": ("IMPERIAL", "INCHES"),
}


def set_units(scene, part_scene):
    """One Blender unit becomes one unit of the scene file; coordinates stay as they are."""
    system, length = UNITS[part_scene.units]
    settings = scene.unit_settings
    settings.system = system
    settings.length_unit = length
    settings.scale_length = part_scene.metres_per_unit


def build_images(part):
    """One float image for each baked channel, as {channel: image}."""
    return {
        channel: images.build(f"{part.name} {channel}", channel, array)
        for channel, array in part.maps.items()
    }


def glows(part):
    return bool(np.any(part.maps["emission"] > 0)) if "emission" in part.maps else False


NEW = "new"  # in place of an earlier object: make another


def place(scene, part, built, earlier=None):
    """The object of `part` in `scene`: a new one, or our earlier one with its content renewed.

    An earlier object is given, or else known by its SOURCE property. It keeps its place, modifiers
    and its material's other nodes; mesh and images are replaced.
    """
    mesh = mesh_data.build(part.name, part.mesh, part.fractions, part.scene.materials)
    names = mesh_data.set_attributes(mesh, part.attributes)
    old_images = [i for i in bpy.data.images if i.get(SOURCE) == part.source]
    read = {channel: image for channel, image in built.items() if channel in material.READ}
    item = find(scene, part.source) if earlier is None else earlier
    if item in (None, NEW):
        item = bpy.data.objects.new(part.name, mesh)
        item[SOURCE] = part.source
        scene.collection.objects.link(item)
        old_mesh, kept = None, []
    else:
        old_mesh, kept = item.data, list(filter(None, item.data.materials))
    for each in kept or [material.build(part.name, read)]:
        mesh.materials.append(each)
        material.assign_images(each, read, glows(part))
        material.set_normal_map(each, built.get(material.NORMAL))
        material.set_tangent(each, names.get(part.tangent, ""))
    item.data = mesh
    _forget(old_mesh, old_images)
    mesh.name = part.name  # it was taken while the earlier mesh was there
    _label(part, built)
    return item


def _forget(old_mesh, old_images):
    """Remove what an earlier bake left, unless something of the user's refers to it."""
    if old_mesh is not None and old_mesh.users == 0:
        bpy.data.meshes.remove(old_mesh)
    for image in old_images:
        if image.users - int(image.use_fake_user) == 0:
            bpy.data.images.remove(image)


def _label(part, built):
    """Name the images, remember what they show, and keep those that no material reads."""
    for channel, image in built.items():
        image.name = f"{part.name} {channel}"
        image[SOURCE] = part.source
        image.use_fake_user = channel not in material.READ
        if channel.startswith("fractions_"):  # three materials each, in red, green, blue
            first = 3 * (int(channel.split("_")[1]) - 1)
            image["sardf_materials"] = ", ".join(part.scene.materials[first : first + 3])


def find(scene, source):
    """The mesh object in `scene` that was baked from the file `source`, or None."""
    baked = (o for o in scene.objects if o.type == "MESH" and o.get(SOURCE) == source)
    return next(baked, None)


def ball(item):
    """Centre and radius in world space of a ball around the object's bounding box."""
    corners = [item.matrix_world @ Vector(corner) for corner in item.bound_box]
    centre = sum(corners, Vector()) / 8
    return centre, max((corner - centre).length for corner in corners)
