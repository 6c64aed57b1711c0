# SPDX-License-Identifier: GPL-3.0-or-later
"""From one made part to a Blender object with mesh, material and images."""

import bpy
from mathutils import Vector

from . import images, material, mesh_data

SOURCE = "sardf_source"  # custom property: the scene file that an object was baked from
DENSITY = "sardf_texels_per_unit"  # custom property: of the textures that were baked
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


def build_images(sardf, part, packed=True, keep=False):
    """One image for each baked texture, as {name: image}; publishes the part's files, and removes
    them where the .blend keeps them, unless they are to be kept besides. Raises StoreError and
    ColorSpaceError."""
    paths = part.store.publish(part.maps)
    built = {}
    try:
        for name, path in paths.items():
            built[name] = images.load(path, f"{part.name} {name}", sardf.is_color(name), packed)
    except images.ColorSpaceError:
        for image in built.values():
            bpy.data.images.remove(image)
        raise
    finally:
        if packed and not keep:
            for path in paths.values():
                path.unlink()
    return built


NEW = "new"  # in place of an earlier object: make another


def place(scene, part, built, earlier=None, layer=mesh_data.LAYER):
    """The object of `part` in `scene`: a new one, or our earlier one with its content renewed.

    An earlier object is given, or else known by its SOURCE property. It keeps its place, modifiers
    and its material's other nodes; mesh and images are replaced. Of a given mesh only attributes
    and material change, and `layer` is its UV map.
    """
    item = find(scene, part.source) if earlier is None else earlier
    old_images = [i for i in bpy.data.images if i.get(SOURCE) == part.source]
    old_mesh = None
    if part.given:
        mesh = item.data
    else:
        mesh = mesh_data.build(part.name, part.mesh)
        if item in (None, NEW):
            item = bpy.data.objects.new(part.name, mesh)
            scene.collection.objects.link(item)
        else:
            old_mesh = item.data
            for each in filter(None, old_mesh.materials):
                mesh.materials.append(each)
    if not part.given or SOURCE in item:  # another object is the user's: no bake may renew it
        item[SOURCE] = part.source
        item[DENSITY] = part.texels_per_unit
    mesh_data.forget_attributes(mesh)
    names = mesh_data.set_fractions(mesh, part.fractions, part.scene.materials)
    made = mesh_data.set_attributes(mesh, part.attributes)
    content = material.Content(
        images=built,
        materials=part.scene.materials,
        fractions=names,
        attributes=[name for each in made.values() for name in each],
        tangent=made[part.tangent][0] if part.tangent in made else "",
        layer=layer,
        glows=part.glows,
        osl=part.osl,
    )
    mesh_data.remember_attributes(mesh, [*content.fractions, *content.attributes])
    _update_materials(mesh, part, content)
    item.data = mesh
    _forget(old_mesh, old_images)
    if not part.given:
        mesh.name = part.name  # it was taken while the earlier mesh was there
    _label(part, built)
    return item


def _update_materials(mesh, part, content):
    """Our materials in the mesh's slots, or a new one; it comes after the user's own."""
    ours = [each for each in filter(None, mesh.materials) if material.is_ours(each)]
    if not ours:
        ours = [material.build(part.name)]
        if len(mesh.materials):
            part.warnings.append(
                f"the mesh has materials of its own; the baked one, '{ours[0].name}', is its last"
            )
        mesh.materials.append(ours[0])
    for each in ours:
        material.update(each, content)


def _forget(old_mesh, old_images):
    """Remove what an earlier bake left, unless something of the user's refers to it."""
    if old_mesh is not None and old_mesh.users == 0:
        bpy.data.meshes.remove(old_mesh)
    for image in old_images:
        if image.users - int(image.use_fake_user) == 0:
            bpy.data.images.remove(image)


def _label(part, built):
    """Name the images, and remember what they show."""
    for channel, image in built.items():
        image.name = f"{part.name} {channel}"
        image[SOURCE] = part.source
        if channel.startswith(material.FRACTIONS):  # three materials each, in red, green, blue
            first = 3 * (int(channel.removeprefix(material.FRACTIONS)) - 1)
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
