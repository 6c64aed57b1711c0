# SPDX-License-Identifier: GPL-3.0-or-later
"""What the bake's settings do, for a scene file and for a part alike: channels, UV maps,
destinations, and what is said when they cannot be had; run by part_run.py with a folder."""

import functools
import json
import threading
from pathlib import Path

import bpy
import numpy as np
import sardf_blender
from sardf_blender import bake_info, bake_operator, bake_plan, core
from sardf_blender.baked import assemble, job, unwrap
from sardf_blender.parts import part_objects

LIMIT = 60.0  # seconds for anything at most
SCENE = {
    "sardf": 1,
    "title": "graded",
    "fields": {"ball": {"sphere": {"radius": 5}}},
    "solid": "ball",
    "materials": {
        "red": {"color": "#c03020", "roughness": 0.25, "density": 2},
        "steel": {"color": "#8a8f98", "metallic": 1, "roughness": 0.75, "density": 8},
    },
    "fractions": {
        "inverse_distance": {
            "features": [
                {"at": {"point": {"at": [-8, 0, 0]}}, "material": "red", "exponent": 2},
                {"at": {"point": {"at": [8, 0, 0]}}, "material": "steel", "exponent": 2},
            ]
        }
    },
    "attributes": {"heat": "=20 + x", "four": ["=x", "=y", "=z", 1]},
}


def main(folder):
    folder = Path(folder)
    path = folder / "graded.json"
    path.write_text(json.dumps(SCENE))
    return {kind: cases(folder / kind, prepare) for kind, prepare in kinds(path).items()}


def kinds(path):
    def file():
        bpy.context.scene.sardf.filepath = str(path)

    def part():
        bpy.ops.sardf.part_import(filepath=str(path))

    return {"file": file, "part": part}


def cases(folder, prepare):
    folder.mkdir()
    result = {}
    for case in (channels, existing, smart, destinations, mistakes, material, info, disabled):
        bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
        settings = bpy.context.scene.sardf
        settings.resolution, settings.size = 16, "256"
        prepare()
        subject = bpy.context.active_object
        result[case.__name__] = case(folder, settings, functools.partial(again, subject))
    return result


def again(subject):
    """Bake the subject, a part or None, and return what the operator made, or says."""
    bpy.context.view_layer.objects.active = subject
    try:
        bpy.ops.sardf.bake()
    except RuntimeError as error:
        return str(error)
    return bpy.context.view_layer.objects.active


def pixels(image):
    width, height = image.size
    values = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(height, width, 4)


def images_of(item):
    nodes = item.data.materials[0].node_tree.nodes
    return {n.name: n.image for n in nodes if n.type == "TEX_IMAGE"}


def channels(_folder, settings, bake):
    settings.channels = "base_color"
    bpy.ops.sardf.bake_channel(channel="density")
    bpy.ops.sardf.bake_channel(channel="heat")
    bpy.ops.sardf.bake_channel(channel="four")
    bpy.ops.sardf.bake_channel(channel="base_color")
    result = {"text": settings.channels}
    item = bake()
    result["first"] = sorted(images_of(item))
    heat = pixels(images_of(item)["sardf heat"])
    result["heat"] = [float(heat[..., 0].min()), float(heat[..., 0].max())]
    density = pixels(images_of(item)["sardf density"])
    result["density"] = [float(density[..., 0].min()), float(density[..., 0].max())]
    settings.channels = "base_color, nothing, fractions"
    result["second"] = sorted(images_of(bake()))
    result["images"] = sorted(image.name for image in bpy.data.images)
    settings.channels = "base_colour"
    result["wrong"] = bake()
    return result


def existing(_folder, settings, bake):
    settings.uv_source = "EXISTING"
    result = {"nothing yet": bake()}
    settings.uv_source = "ATLAS"
    item = bake()
    faces = len(item.data.polygons)
    item.location.x = 3  # its own frame is the scene's in any case
    item.data.uv_layers[0].data.foreach_set("uv", squeezed(item.data))
    settings.uv_source = "EXISTING"
    settings.resolution = 8
    settings.channels = "base_color, heat"
    result["same object"] = bake() == item and len(item.data.polygons) == faces
    result["heat"] = heat_error(item)
    result["attributes"] = sorted(a.name for a in item.data.attributes if a.name in ("heat", "red"))
    result["left half"] = covered_half(images_of(item)["sardf heat"])
    result |= faults(bake, item)
    settings.uv_object = other_mesh()
    result["other"] = other_object(settings, bake)
    return result


def squeezed(data):
    """The UV map in the left half of the image."""
    uv = np.empty(2 * len(data.loops), dtype=np.float32)
    data.uv_layers[0].data.foreach_get("uv", uv)
    uv[0::2] *= 0.5
    return uv


def heat_error(item):
    """|heat in the texture - (20 + x)| at the middles of the faces, at worst."""
    data = item.data
    layer = data.uv_layers.active.data
    texture = pixels(images_of(item)["sardf heat"])[..., 0]
    worst = 0.0
    for polygon in data.polygons:
        uv = np.mean([layer[i].uv for i in polygon.loop_indices], axis=0)
        x = np.mean([data.vertices[v].co.x for v in polygon.vertices])
        row, column = (min(255, int(256 * each)) for each in (uv[1], uv[0]))
        worst = max(worst, abs(float(texture[row, column]) - (20 + x)))
    return worst


def covered_half(image):
    """How much values vary on the left and on the right half: there is nothing on the right."""
    values = pixels(image)[..., 0]
    return [float(np.ptp(values[:, :128])), float(np.ptp(values[:, 160:]))]


def faults(bake, item):
    """What is said about wrong UV maps; the object stays as it is."""
    result = {}
    layer = item.data.uv_layers[0].data
    good = squeezed(item.data)
    good[0::2] *= 2
    before = [image.name for image in bpy.data.images]
    for name, change in {
        "outside": lambda uv: uv + 0.4,
        "overlap": lambda uv: np.where(np.arange(len(uv)) % 2, uv, np.abs(uv - 0.25)),
        "nothing": lambda uv: uv * 0,
    }.items():
        layer.foreach_set("uv", change(good))
        result[name] = bake()
    layer.foreach_set("uv", good)
    for vertex in list(item.data.vertices)[:20]:
        vertex.co *= 1.2
    result["moved vertices"] = isinstance(bake(), bpy.types.Object)
    for vertex in item.data.vertices:
        vertex.co *= 1.5
    result["other shape"] = bake()
    for vertex in item.data.vertices:
        vertex.co /= 1.5
    item.data.uv_layers.remove(item.data.uv_layers[0])
    result["no map"] = bake()
    result["kept images"] = len(before) == len(bpy.data.images)
    return result


def other_mesh():
    """The user's coarse ball, moved and unwrapped, with a material of its own."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12, radius=5)
    item = bpy.context.active_object
    item.name = "mine"
    item.data.materials.append(bpy.data.materials.new("my own"))
    return item


def other_object(settings, bake):
    parts = part_objects.parts(bpy.context.scene)
    item = settings.uv_object
    settings.uv_source = "EXISTING"
    if parts:  # the part's frame counts, not the world's
        parts[0].location.z = 7
        item.location.z = 7
        bpy.context.view_layer.update()
    made = bake()
    if not isinstance(made, bpy.types.Object):
        return made
    ours = made.data.materials[-1]
    first = made.data.materials[0]
    made.data.materials[0] = ours  # for images_of
    error = heat_error(made)
    made.data.materials[0] = first
    return {
        "object": made.name,
        "materials": [m.name for m in made.data.materials],
        "slots used": sorted({p.material_index for p in made.data.polygons}),
        "heat": error,
        "marked": assemble.SOURCE in made,
    }


def smart(_folder, settings, bake):
    settings.uv_source = "SMART"
    settings.channels = "base_color, heat"
    bpy.ops.mesh.primitive_cube_add()
    cube = bpy.context.active_object
    before = {kind: len(getattr(bpy.data, kind)) for kind in ("objects", "meshes")}
    item = bake()
    result = {"heat": heat_error(item)}
    result["more"] = {k: len(getattr(bpy.data, k)) - before[k] for k in before}
    result["density"] = item[assemble.DENSITY]
    bpy.context.view_layer.objects.active = cube
    bpy.ops.object.mode_set(mode="EDIT")
    try:
        unwrap.smart(bpy.context, None, 256)
    except unwrap.UnwrapError as error:
        result["in edit mode"] = str(error)
    bpy.ops.object.mode_set(mode="OBJECT")
    return result


def destinations(folder, settings, bake):
    settings.channels = "base_color, roughness"
    settings.destination = "FOLDER"
    result = {"unsaved": bake()}
    target = folder / "new" / "textures"
    settings.folder = str(target)
    item = bake()
    result["files"] = sorted(p.name for p in target.iterdir())
    result["packed"] = [i.packed_file is not None for i in images_of(item).values()]
    first = {p.name: p.read_bytes() for p in target.iterdir()}
    result["again"] = bake()
    result["unchanged"] = first == {p.name: p.read_bytes() for p in target.iterdir()}
    settings.replace_files = True
    settings.size = "512"
    result["replaced"] = isinstance(bake(), bpy.types.Object)
    result["larger"] = all(p.stat().st_size != len(first[p.name]) for p in target.iterdir())
    name = sorted(p.name for p in target.iterdir())[0]
    (target / name).unlink()
    (target / name).mkdir()
    result["folder in the way"] = bake()
    settings.folder = str(folder / "graded.txt")
    Path(settings.folder).write_text("a file")
    result["a file"] = bake()
    settings.folder = ""
    result["none"] = bake()
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "beside.blend"))
    settings.folder = "//maps"
    item = bake()
    result["relative"] = sorted(i.filepath for i in images_of(item).values())
    result["left"] = sorted(str(p.relative_to(folder)) for p in folder.rglob(".sardf*"))
    return result


def mistakes(folder, settings, bake):
    """Nothing is left of a bake that fails: no folder, no data-blocks."""
    settings.destination, settings.folder = "FOLDER", str(folder / "never" / "there")
    settings.channels = "nothing"
    before = {kind: len(getattr(bpy.data, kind)) for kind in ("objects", "meshes", "images")}
    result = {"no channel": bake()}
    result["folder left"] = (folder / "never").exists()
    result["same"] = before == {kind: len(getattr(bpy.data, kind)) for kind in before}
    return result


def material(_folder, settings, bake):
    settings.channels = (
        "base_color, roughness, metallic, emission, fractions, normal, density, heat"
    )
    item = bake()
    tree = item.data.materials[0].node_tree
    boxes = {
        node.name: [*absolute(node), node.width, node.parent.label if node.parent else ""]
        for node in tree.nodes
        if node.type != "FRAME"
    }
    result = {"boxes": boxes}
    switch = tree.nodes["sardf normal switch"]
    bent = tree.nodes["sardf normal map"]
    result["switch"] = [switch.outputs[0].default_value, bent.inputs["Strength"].is_linked]
    result["in panel"] = bake_info.normal_switch(bpy.context) == switch.outputs[0]
    result["labels"] = sorted(n.label for n in tree.nodes if n.type == "FRAME")
    result["masks"] = sorted(n.label for n in tree.nodes if n.type == "REROUTE")
    switch.outputs[0].default_value = 0.0
    tree.nodes.remove(tree.nodes["sardf roughness"])
    settings.channels = "base_color, roughness, fractions, normal"
    bake()
    names = {n.name for n in tree.nodes}
    result["kept off"] = tree.nodes["sardf normal switch"].outputs[0].default_value
    result["stays deleted"] = "sardf roughness" not in names
    result["no longer baked"] = sorted(names & {"sardf emission", "sardf density", "sardf heat"})
    return result


def absolute(node):
    x, y = node.location
    while node.parent is not None:
        node = node.parent
        x, y = x + node.location.x, y + node.location.y
    return x, y


def info(_folder, _settings, bake):
    found = bake_info.measure_now(bpy.context)
    cost = bake_info.cost(bpy.context)
    item = bake()
    return {
        "channels": list(found.channels),
        "error": found.error,
        "estimated": cost.texels_per_unit,
        "baked": item[assemble.DENSITY],
        "faces": [cost.faces, len(item.data.polygons)],
    }


class WatchedJob(job.Job):
    """A job that tells when its thread is at work."""

    def __init__(self, sardf, request):
        self.begun = threading.Event()
        super().__init__(sardf, request)

    def _progress(self, share):
        self.begun.set()
        return super()._progress(share)


def disabled(folder, settings, bake):
    """The add-on is disabled while its thread bakes, and enabled again."""
    target = folder / "stopped"
    settings.destination, settings.folder = "FOLDER", str(target)
    settings.resolution, settings.size = 200, "4096"
    before = {kind: len(getattr(bpy.data, kind)) for kind in ("objects", "meshes", "images")}
    running = WatchedJob(core.load(), bake_plan.make(bpy.context).request)
    bake_operator.SARDF_OT_bake.job = running  # as in a window, where it goes on by itself
    running.begun.wait(LIMIT)
    sardf_blender.unregister()
    running.join(LIMIT)
    result = {"cancelled": running.cancelled and running.part is None}
    result["left"] = target.exists()
    result["same"] = before == {kind: len(getattr(bpy.data, kind)) for kind in before}
    sardf_blender.register()
    settings = bpy.context.scene.sardf
    settings.resolution, settings.size = 16, "256"
    result["again"] = isinstance(bake(), bpy.types.Object)
    result["files"] = sorted(path.name for path in target.iterdir())
    return result
