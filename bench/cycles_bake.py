"""What bench/bake_against_cycles runs inside Blender: SIZE THREADS RESOLUTION."""

import importlib.util
import json
import os
import sys
import tempfile
import time
from pathlib import Path

import bpy
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
COLORS = {"bore": (0.1, 0.2, 0.3), "low": (0.9, 0.7, 0.5), "high": (0.3, 0.6, 0.9)}
CORNERS = {"low": (10, -6, 4), "high": (-10, 6, 4)}
RADIUS = 3
GUTTER = 8
HOLES = [(-8, -4), (-8, 4), (8, -4), (8, 4)]
FEATURES = [
    {"at": {"boundary": "bore"}, "material": "bore", "exponent": 2},
    *(
        {"at": {"point": {"at": at}}, "material": name, "exponent": 2}
        for name, at in CORNERS.items()
    ),
]
SCENE = {
    "sardf": 1,
    "units": "mm",
    "fields": {
        "block": {"box": {"size": [20, 12, 8]}},
        "bore": {"cylinder": {"radius": RADIUS}},
        **{
            f"hole_{i}": {"cylinder": {"center": [*at, 0], "radius": 1}}
            for i, at in enumerate(HOLES)
        },
        "ring": {"torus": {"major_radius": 5, "minor_radius": 1}},
        "drilled": {
            "difference": {
                "of": ["block", "bore", *(f"hole_{i}" for i in range(4))],
                "blend": {"sardf": 0.5},
            }
        },
        "part": {"union": {"of": ["drilled", "ring"], "blend": {"sardf": 0.5}}},
    },
    "solid": "part",
    "materials": {name: {"color": list(color)} for name, color in COLORS.items()},
    "fractions": {"inverse_distance": {"features": FEATURES}},
}


def addon(name):
    """A module of the add-on, whose package is in this checkout."""
    package = "sardf_blender"
    if package not in sys.modules:
        here = ROOT / "blender_addon"
        spec = importlib.util.spec_from_file_location(
            package, here / "__init__.py", submodule_search_locations=[str(here)]
        )
        sys.modules[package] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[package])
    return importlib.import_module(f"{package}.{name}")


class Nodes:
    """Makes nodes that compute with numbers, and links them."""

    def __init__(self, tree):
        self.tree = tree

    def new(self, kind, operation=None, *inputs, output=0):
        node = self.tree.nodes.new(kind)
        if operation:
            node.operation = operation
        for socket, given in zip(node.inputs, inputs, strict=False):
            if isinstance(given, bpy.types.NodeSocket):
                self.tree.links.new(given, socket)
            else:
                socket.default_value = given
        return node.outputs[output]

    def math(self, operation, *inputs):
        return self.new("ShaderNodeMath", operation, *inputs)

    def vector(self, operation, *inputs, output=0):
        return self.new("ShaderNodeVectorMath", operation, *inputs, output=output)

    def scaled(self, vector, factor):
        node = self.tree.nodes.new("ShaderNodeVectorMath")
        node.operation = "SCALE"
        self.tree.links.new(factor, node.inputs["Scale"])
        if isinstance(vector, bpy.types.NodeSocket):
            self.tree.links.new(vector, node.inputs[0])
        else:
            node.inputs[0].default_value = vector
        return node.outputs[0]


def node_material():
    """The emission Σ colour / u² / Σ 1 / u², by the nodes of Cycles."""
    material = bpy.data.materials.new("by nodes")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    nodes = Nodes(tree)
    position = nodes.new("ShaderNodeNewGeometry")
    flat = nodes.vector("MULTIPLY", position, (1, 1, 0))
    from_axis = nodes.vector("LENGTH", flat, output=1)
    distances = {"bore": nodes.math("SUBTRACT", from_axis, float(RADIUS))}
    for name, at in CORNERS.items():
        distances[name] = nodes.vector("DISTANCE", position, at, output=1)
    weights = {
        name: nodes.math("DIVIDE", 1.0, nodes.math("MAXIMUM", nodes.math("MULTIPLY", u, u), 1e-20))
        for name, u in distances.items()
    }
    total, color = None, None
    for name, weight in weights.items():
        total = weight if total is None else nodes.math("ADD", total, weight)
        term = nodes.scaled(COLORS[name], weight)
        color = term if color is None else nodes.vector("ADD", color, term)
    emission = tree.nodes.new("ShaderNodeEmission")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    mean = nodes.scaled(color, nodes.math("DIVIDE", 1.0, total))
    tree.links.new(mean, emission.inputs["Color"])
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


def place(mesh, material, image):
    """The object, alone and active in the scene, and the image as the target of a bake."""
    data = addon("baked.mesh_data").build("part", mesh)
    data.materials.append(material)
    item = bpy.data.objects.new("part", data)
    bpy.context.scene.collection.objects.link(item)
    bpy.context.view_layer.objects.active = item
    item.select_set(True)
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = image
    material.node_tree.nodes.active = node


def timed(work):
    """What work() returns, its seconds of processor time and of wall time."""
    processor, wall = time.process_time(), time.perf_counter()
    result = work()
    return result, time.process_time() - processor, time.perf_counter() - wall


def sardf_bake(size, resolution):
    sardf = addon("core").load()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.json"
        path.write_text(json.dumps(SCENE))
        scene = sardf.load(str(path))
    mesh = scene.mesh(resolution=resolution, size=size)
    bake = {"size": size, "channels": ["base_color"], "gutter": GUTTER}
    maps, processor, wall = timed(lambda: scene.bake(mesh, **bake))
    return mesh, maps["base_color"], (processor, wall)


def cycles_bake(mesh, size, threads):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    image = bpy.data.images.new("bake", size, size, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.generated_color = (0, 0, 0, 0)
    place(mesh, node_material(), image)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.threads_mode, scene.render.threads = "FIXED", threads
    scene.cycles.device, scene.cycles.samples = "CPU", 1
    scene.cycles.use_adaptive_sampling = scene.cycles.use_denoising = False
    scene.render.bake.margin, scene.render.bake.margin_type = GUTTER, "EXTEND"
    _, processor, wall = timed(lambda: bpy.ops.object.bake(type="EMIT"))
    pixels = np.empty(size * size * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(size, size, 4)[::-1], (processor, wall)


def report(name, times, texels):
    rate = texels / times[0] / 1e6
    print(f"{name:<8} processor {times[0]:8.3f} s   wall {times[1]:8.3f} s   {rate:8.2f} Mtexel/s")


def main():
    size, threads, resolution = map(int, sys.argv[sys.argv.index("--") + 1 :])
    # Holds for both: sardf takes as many threads as there are processors.
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[-threads:])
    mesh, ours, our_times = sardf_bake(size, resolution)
    theirs, their_times = cycles_bake(mesh, size, threads)
    covered = theirs[..., :3].max(axis=2) > 0  # no colour is black
    texels = int(covered.sum())
    print(f"{size}² texels, {texels} covered by Cycles, {len(mesh.faces)} faces, {threads} threads")
    report("sardf", our_times, texels)
    report("Cycles", their_times, texels)
    print(f"ratio    {their_times[0] / our_times[0]:.2f} of processor time")
    differ = np.abs(ours[covered] - theirs[covered][:, :3]).max(axis=1)
    print(f"differ   median {np.median(differ):.2e}, 99 % below {np.quantile(differ, 0.99):.2e}")


main()
