# SPDX-License-Identifier: GPL-3.0-or-later
"""Curves, meshes, formulas, features and parts in parts; parameters that are animated."""

import bpy
from mathutils import Euler, Matrix
from sardf_blender.parts import part_bake, part_objects, part_scene

TURN = Matrix.Translation((1, -2, 0.5)) @ Euler((0.4, 0.2, -0.9)).to_matrix().to_4x4()
CURVES = ("poly", "ring", "nurbs", "closed", "weighted", "free", "bezier", "loop")


def fresh(check, *arguments):
    """What a check finds in an empty file."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return check(*arguments)


def scene(part):
    return part_scene.scene_of(part, bpy.context.evaluated_depsgraph_get())[0]


def link(item):
    bpy.context.collection.objects.link(item)
    return item


def part_with(*items, origin=(0, 0, 0), **kinds):
    part = part_objects.new_part("part", bpy.context.collection, origin)
    bpy.context.view_layer.update()
    for item in items:
        part_objects.add_entry(part, item, **kinds)
    return part


def main(imported):
    return {
        "curves": {name: fresh(curve, name) for name in CURVES},
        "swept": fresh(swept),
        "nested": fresh(nested),
        "imported inside": fresh(imported_inside, imported),
        "features": fresh(features),
        "animated": fresh(animated),
    }


def curve(name):
    """The distance to a curve, and points of the curve as Blender draws it, in the part's frame."""
    data = bpy.data.curves.new(name, "CURVE")
    data.dimensions = "3D"
    data.resolution_u = 12
    kind = {"poly": "POLY", "ring": "POLY", "bezier": "BEZIER", "loop": "BEZIER"}.get(name, "NURBS")
    spline = data.splines.new(kind)
    points = [(0, 0, 0), (1, 2, 0.5), (2.5, -1, 1), (4, 1, -1), (5, 0, 0.3), (5, 3, 1)]
    if kind == "BEZIER":
        spline.bezier_points.add(len(points) - 1)
        for to, (x, y, z) in zip(spline.bezier_points, points, strict=True):
            to.co = (x, y, z)
            to.handle_left, to.handle_right = (x - 0.5, y + 0.2, z), (x + 0.4, y - 0.3, z + 0.3)
    else:
        spline.points.add(len(points) - 1)
        for number, (to, point) in enumerate(zip(spline.points, points, strict=True)):
            to.co = (*point, 1 + number % 3 if name == "weighted" else 1)
    spline.use_cyclic_u = name in ("ring", "closed", "loop")
    if kind == "NURBS":
        spline.order_u = 4
        spline.use_endpoint_u = name in ("nurbs", "weighted")
    item = link(bpy.data.objects.new(name, data))
    item.matrix_world = TURN @ Matrix.Diagonal((1, 1.5, 0.7, 1))
    part = part_with(item, link(bpy.data.objects.new("origin", None)),
                     origin=(3, 1, 0))  # fmt: skip
    ball = part_objects.new_primitive("sphere", "ball", bpy.context.collection)
    part_objects.add_entry(part, ball)
    field = part.sardf_part.entries[0]
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    back = part.matrix_world.inverted() @ evaluated.matrix_world
    drawn = [list(back @ vertex.co) for vertex in evaluated.to_mesh().vertices]
    evaluated.to_mesh_clear()
    return {"scene": scene(part), "drawn": drawn, "operation": field.operation}


def swept():
    data = bpy.data.curves.new("tube", "CURVE")
    data.dimensions, data.bevel_depth = "3D", 0.25
    spline = data.splines.new("POLY")
    spline.points.add(1)
    spline.points[1].co = (3, 0, 0, 1)
    item = link(bpy.data.objects.new("tube", data))
    item.scale = (2, 2, 2)
    return scene(part_with(item, origin=(3, 1, 0)))


def nested():
    """A part in a part in a part, the middle one turned; and one that contains itself."""
    inner = part_with(part_objects.new_primitive("box", "inner box", bpy.context.collection))
    inner.name = "inner"
    middle = part_objects.new_part("middle", bpy.context.collection)
    part_objects.add_entry(middle, inner)
    part_objects.add_entry(
        middle, part_objects.new_primitive("sphere", "hole", bpy.context.collection), "difference"
    )
    outer = part_objects.new_part("outer", bpy.context.collection)
    part_objects.add_entry(outer, middle)
    middle.location, middle.rotation_euler, middle.scale = (4, 0, 0), (0, 0, 0.5), (2, 2, 2)
    result = {"scene": scene(outer)}
    part_objects.add_entry(inner, outer)
    try:
        scene(outer)
    except part_scene.PartError as error:
        result["error"] = str(error)
    inner.sardf_part.entries.remove(1)
    return result


def imported_inside(imported):
    """A part that came from a file inside one of our own: its parameters and names come along."""
    bpy.ops.sardf.part_import(filepath=imported)
    part = bpy.context.active_object
    outer = part_objects.new_part("outer", bpy.context.collection)
    part_objects.add_entry(outer, part)
    foot = part_objects.new_primitive("box", "foot", bpy.context.collection)
    part_objects.add_entry(outer, foot)
    part.location, foot.scale = (1000, 0, 0), (5, 5, 5)
    return scene(outer)


def features():
    """Each rule of the list, with objects that are no entries."""
    part = part_with(part_objects.new_primitive("box", "block", bpy.context.collection))
    settings = part.sardf_part
    for name in ("red", "blue"):
        settings.materials.add().name = name
    blend = bpy.data.materials.new("from Blender")
    blend.diffuse_color = (0.25, 0.5, 0.75, 1)
    if blend.node_tree:  # 5.0 always has nodes
        blend.node_tree.nodes[0].inputs["Base Color"].default_value = (0.25, 0.5, 0.75, 1)
    settings.materials[0].source = blend
    point = link(bpy.data.objects.new("point", None))
    point.location = (1, 0, 0)
    for item, material in ((point, "red"), (settings.entries[0].object, "blue")):
        feature = settings.features.add()
        feature.name, feature.object, feature.material = item.name, item, material
    settings.features[0].exponent = 2
    settings.features[0].influence = "exp(u/3)"
    settings.features[1].function, settings.features[1].other = "exp(-u^2)", "red"
    settings.features[1].distance = 0.5
    cut = link(bpy.data.objects.new("cut", None))
    cut.rotation_euler.x = 3.14159265 / 2
    settings.sections.add().object = cut
    made = {}
    for rule in ("inverse_distance", "blend_between", "ramp", "partition"):
        settings.rule = rule
        made[rule] = scene(part)
    return made


def animated():
    """A keyed parameter, a driven scale and a keyed radius of a blend, frame by frame."""
    ball = part_objects.new_primitive("sphere", "ball", bpy.context.collection)
    ring = part_objects.new_primitive("torus", "ring", bpy.context.collection)
    part = part_with(ball, ring)
    for axis in range(3):
        ball.driver_add("scale", axis).driver.expression = "frame * 0.5"
    ring.location.x = 4
    entry = part.sardf_part.entries[1]
    entry.blend = "sardf"
    for frame, minor, radius in ((1, 0.1, 0.5), (11, 0.3, 1.5)):
        ring.sardf_primitive.torus_minor_radius = minor
        ring.sardf_primitive.keyframe_insert("torus_minor_radius", frame=frame)
        entry.radius = radius
        part.keyframe_insert("sardf_part.entries[1].radius", frame=frame)
    scenes, widths = {}, {}
    for frame in (1, 6, 11):
        bpy.context.scene.frame_set(frame)
        scenes[frame] = scene(part)["fields"]
    settings = bpy.context.scene.sardf
    settings.resolution, settings.size = 12, "256"
    before = None
    for frame, item in part_bake.rebake_frames(bpy.context, part, (2, 4), ("base_color",)):
        widths[frame] = max(abs(vertex.co.y) for vertex in item.data.vertices)
        count = (len(bpy.data.meshes), len(bpy.data.images), len(bpy.data.objects))
        assert before in (None, count), (before, count)
        before = count
    return {"scenes": scenes, "half widths": widths}
