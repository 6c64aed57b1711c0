# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts rendered in POV-Ray by a Blender scene's camera and lights, and compared with Cycles: what
each check below finds, as numbers and texts."""

import json
import math
from pathlib import Path

import bpy
from mathutils import Euler, Matrix, Vector
from sardf_blender import headless
from sardf_blender.parts import part_lists, part_objects
from sardf_blender.reference import compare, pictures

WIDTH, HEIGHT = 160, 120
NUMBERS = compare.NUMBERS


def start(width=WIDTH, height=HEIGHT, resolution=48):
    """An empty scene with a camera above one corner, and a black world."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.sardf.resolution, scene.sardf.size = resolution, "512"
    scene.sardf_reference.samples = 64
    data = bpy.data.cameras.new("camera")
    item = bpy.data.objects.new("camera", data)
    item.location = (5, -6, 4)
    item.rotation_euler = (-item.location).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(item)
    scene.camera = item
    return scene


def add_part(name, kind, color=(0.8, 0.8, 0.8), matrix=None, size=(1, 1, 1)):
    """A part of one primitive and one material."""
    collection = bpy.context.scene.collection
    part = part_objects.new_part(name, collection)
    primitive = part_objects.new_primitive(kind, f"{name} {kind}", collection)
    primitive.scale = size
    part_objects.add_entry(part, primitive)
    part.sardf_part.materials.add().name = "paint"
    part.sardf_part.materials[0].color = color
    if matrix is not None:
        part.matrix_world = matrix
    bpy.context.view_layer.update()
    return part


def add_light(kind, place, at=(0, 0, 0), **values):
    data = bpy.data.lights.new(kind.lower(), kind)
    for key, value in values.items():
        setattr(data, key, value)
    item = bpy.data.objects.new(data.name, data)
    item.location = place
    item.rotation_euler = (Vector(at) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(item)
    bpy.context.view_layer.update()
    return item


def compared(look="flat"):
    """The numbers of a comparison by the operator, or the error."""
    settings = bpy.context.scene.sardf_reference
    settings.look = look
    try:
        bpy.ops.sardf.reference()
    except RuntimeError as error:
        return {"error": str(error)}
    numbers = {name: getattr(settings, name) for name in NUMBERS}
    return numbers | {"warnings": settings.warnings.splitlines(), "compared": settings.compared}


def save(folder, name):
    for kind in pictures.NAMES:
        image = pictures.find(kind)
        path = Path(folder) / f"{name}_{kind}.exr"
        path.write_bytes(image.packed_file.data)


CAMERAS = {
    "landscape": {},
    "portrait": {"size": (90, 120)},
    "shift": {"shift_x": 0.2, "shift_y": -0.1},
    "vertical fit": {"sensor_fit": "VERTICAL", "sensor_height": 30},
    "horizontal portrait": {"sensor_fit": "HORIZONTAL", "size": (90, 120), "shift_y": 0.1},
    "orthographic": {"type": "ORTHO", "ortho_scale": 6},
    "orthographic portrait": {
        "type": "ORTHO", "ortho_scale": 8, "size": (90, 120), "shift_x": 0.1, "shift_y": 0.2
    },
}  # fmt: skip


def cameras():
    """A block baked once, seen by each of CAMERAS."""
    scene = start(resolution=16)
    add_part("block", "box", size=(1.5, 1, 0.7))
    result = {}
    data = scene.camera.data
    for name, values in CAMERAS.items():
        values = {"type": "PERSP", "sensor_fit": "AUTO", "shift_x": 0, "shift_y": 0} | values
        size = values.pop("size", (WIDTH, HEIGHT))
        scene.render.resolution_x, scene.render.resolution_y = size
        for key, value in values.items():
            setattr(data, key, value)
        result[name] = compared()
    return result


LIGHTS = {
    "point": ("POINT", {"energy": 800, "color": (1, 0.8, 0.6), "shadow_soft_size": 0}),
    "soft point": ("POINT", {"energy": 800, "shadow_soft_size": 0.6}),
    "sun": ("SUN", {"energy": 2, "angle": 0.05}),
    "spot": (
        "SPOT",
        {"energy": 1500, "spot_size": 0.5, "spot_blend": 0.6, "shadow_soft_size": 0.05},
    ),
    "rectangle": ("AREA", {"energy": 500, "shape": "RECTANGLE", "size": 2, "size_y": 1}),
    "disk": ("AREA", {"energy": 500, "shape": "DISK", "size": 2}),
}


def lights(folder):
    """A ball beside a block, under each of LIGHTS; then under a plain world, and flat."""
    scene = start()
    add_part("block", "box", size=(1.2, 1.2, 0.5), matrix=Matrix.Translation((0, 0, -0.5)))
    ball = Matrix.Translation((0.9, -0.9, 1.2)) @ Matrix.Scale(0.6, 4)
    add_part("ball", "sphere", (0.7, 0.2, 0.1), ball)
    result = {"flat": compared()}
    save(folder, "flat")
    for name, (kind, values) in LIGHTS.items():
        light = add_light(kind, (2, -4, 5), **values)
        result[name] = compared("shaded")
        save(folder, name)
        bpy.data.objects.remove(light)
    world = bpy.data.worlds.new("plain")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.1, 0.15, 0.25, 1)
    world.node_tree.nodes["Background"].inputs["Strength"].default_value = 2
    scene.world = world
    result["world"] = compared("shaded")
    return result


def turned():
    """Two parts, moved, turned and scaled, one cut open; then whole."""
    scene = start()
    matrix = Matrix.LocRotScale((0.8, 0, 0), Euler((0.3, 0.4, 0.5)), (0.8, 0.8, 0.8))
    part = add_part("block", "box", (0.1, 0.4, 0.8), matrix)
    add_part("ball", "sphere", (0.8, 0.1, 0.1), Matrix.Translation((-1.5, 0, 0)))
    plane = bpy.data.objects.new("cut", None)
    plane.rotation_euler = (math.pi / 2, 0, 0)
    plane.parent = part
    scene.collection.objects.link(plane)
    section = part_lists.add_item(bpy.context, part, "sections")
    section.object = plane
    bpy.context.view_layer.update()
    result = {"cut": compared()}
    for item in [o for o in scene.objects if "sardf_source" in o]:
        bpy.data.objects.remove(item)
    scene.sardf.sections = False
    result["whole"] = compared()
    return result


def counts():
    kinds = ("objects", "meshes", "materials", "images", "scenes", "worlds", "cameras", "lights")
    return {kind: len(getattr(bpy.data, kind)) for kind in kinds}


def leaves():
    """What a second and third run leave more than the first, and the user's settings."""
    scene = start(resolution=12)
    add_part("ball", "sphere")
    add_light("SUN", (0, 0, 5), energy=2)
    other = bpy.data.images.new("sardf reference", 4, 4)  # of the user's
    before = (scene.render.engine, scene.view_settings.view_transform, scene.render.filepath)
    result = {"first": compared(), "counts": [counts()]}
    for look in ("shaded", "flat"):
        compared(look)
        result["counts"].append(counts())
    after = (scene.render.engine, scene.view_settings.view_transform, scene.render.filepath)
    result["settings"] = before == after
    result["user's image"] = [other.name, *other.size]
    reference = pictures.find("reference")
    result["images"] = {kind: pictures.find(kind).name for kind in pictures.NAMES}
    result["size"] = list(reference.size)
    result["packed"] = all(pictures.find(kind).packed_file for kind in pictures.NAMES)
    scene.sardf_reference.keep_cycles = True
    last = pictures.find("cycles")
    compared()
    result["kept"] = pictures.find("cycles") == last
    scene.sardf_reference.compare = False
    result["alone"] = compared()
    return result


def bad():
    """What is said of scenes that cannot be drawn, or not wholly."""
    scene = start(resolution=12)
    scene.sardf_reference.compare = False
    result = {"nothing": compared()}
    add_part("ball", "sphere")
    camera, scene.camera = scene.camera, None
    result["no camera"] = compared()
    scene.camera = camera
    camera.data.type = "PANO"
    result["panoramic"] = compared()
    camera.data.type = "PERSP"
    camera.data.dof.use_dof = True
    light = add_light("AREA", (0, 0, 5), spread=1.0)
    ies = add_light("POINT", (0, 0, 5))
    ies.data.use_nodes = True
    ies.data.node_tree.nodes.new("ShaderNodeTexIES")
    hidden = add_light("SPOT", (0, 0, 5))
    hidden.hide_render = True
    world = scene.world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    nodes = world.node_tree.nodes
    picture = nodes.new("ShaderNodeTexEnvironment")
    world.node_tree.links.new(picture.outputs["Color"], nodes["Background"].inputs["Color"])
    mesh = bpy.data.objects.new("floor", bpy.data.meshes.new("floor"))
    scene.collection.objects.link(mesh)
    result["not carried over"] = compared("shaded")
    result["names"] = {"area": light.name, "ies": ies.name, "camera": camera.name}
    camera.rotation_euler = (math.pi, 0, 0)  # looks up, past everything
    scene.sardf_reference.compare = True
    result["empty"] = compared()
    return result


def missing():
    """Without POV-Ray: the environment names none."""
    scene = start(resolution=12)
    add_part("ball", "sphere")
    before = counts()
    result = compared()
    scene.sardf_reference.compare = False
    return {"compared": result, "alone": compared(), "left": counts() == before}


def scene_file(path):
    """An object that was baked from a scene file, moved; without the file's sections; and what is
    said when the file is gone."""
    scene = start(resolution=32)
    scene.sardf.filepath = path
    bpy.ops.sardf.bake()
    item = bpy.context.active_object
    item.matrix_world = Matrix.LocRotScale((0.3, 0, 0.2), Euler((0.1, 0.2, 0.3)), (0.3,) * 3)
    bpy.context.view_layer.update()
    result = {"cut": compared()}
    scene.sardf.sections = False
    bpy.ops.sardf.bake()
    result["whole"] = compared()
    Path(path).unlink()
    result["gone"] = compared()
    return result


def command(folder):
    """The command's exit codes, and the names and numbers of what it wrote."""
    start()
    add_part("ball", "sphere", (0.2, 0.4, 0.8))
    add_light("SUN", (1, -2, 5), energy=3)
    path = str(Path(folder) / "ball.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    output = Path(folder) / "out"
    words = ["-o", str(output), "--resolution", "32", "--size", "256", "--samples", "16"]
    codes = [
        headless.main([scene, *words], command="reference")
        for scene in (path, str(Path(folder) / "none.blend"), "scene.json")
    ]
    numbers = {
        look: json.loads((output / f"numbers_{look}.json").read_text())
        for look in ("flat", "shaded")
    }
    return {"codes": codes, "files": sorted(f.name for f in output.iterdir()), "numbers": numbers}


def main(check, *arguments):
    return globals()[check](*arguments)
