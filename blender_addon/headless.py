# SPDX-License-Identifier: GPL-3.0-or-later
"""Render a scene file without a window.

    blender -b -P blender_addon/headless.py -- SCENE -o OUT [options]
    python blender_addon/headless.py SCENE -o OUT [options]      (with the bpy module)

Writes into the folder OUT: the picture of each look (part.png, flat.exr, normals.exr), camera.json
with the camera used, and, unless --no-keep-blend, part.blend with its images inside and the baked
channels as textures/*.exr. Exit code: 0 everything was written, 1 it was not, 2 wrong input or
usage; then one line on standard error says why.
"""

import argparse
import importlib.util
import json
import os
import shutil
import sys
import tempfile
import time
import traceback
from pathlib import Path

PACKAGE = "sardf_blender"
DONE, FAILED, WRONG_INPUT = 0, 1, 2


class Stop(Exception):
    """The end of the run with an exit code and one line of explanation."""

    def __init__(self, code, text):
        super().__init__(text)
        self.code = code


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise Stop(WRONG_INPUT, f"{message} (--help lists the options)")


def whole(low, high):
    """An argument type: a whole number in [low, high]."""

    def parse(text):
        try:
            value = int(text)
        except ValueError:
            value = None
        if value is None or not low <= value <= high:
            raise argparse.ArgumentTypeError(
                f"expected a whole number from {low} to {high}, found '{text}'"
            )
        return value

    return parse


def looks(text):
    known = ("shaded", "flat", "normals")
    names = text.split(",")
    for name in names:
        if name not in known:
            raise argparse.ArgumentTypeError(f"'{name}' is none of {', '.join(known)}")
    return [name for name in known if name in names]


def parse_arguments(arguments):
    parser = Parser(prog="headless.py", description=__doc__.split("\n")[0])
    flag = argparse.BooleanOptionalAction
    parser.add_argument("scene", metavar="SCENE", help="scene file")
    parser.add_argument("-o", "--output", required=True, metavar="OUT", help="folder to write to")
    parser.add_argument("--resolution", type=whole(4, 4096), default=128,
                        help="cells along the longest side (%(default)s)")  # fmt: skip
    parser.add_argument("--size", type=whole(64, 16384), default=2048,
                        help="texels along a texture's side (%(default)s)")  # fmt: skip
    parser.add_argument("--samples", type=whole(1, 65536), default=64,
                        help="samples of each pixel of the shaded look (%(default)s)")  # fmt: skip
    parser.add_argument("--width", type=whole(8, 16384), default=640, help="pixels (%(default)s)")
    parser.add_argument("--height", type=whole(8, 16384), default=480, help="pixels (%(default)s)")
    parser.add_argument("--camera", metavar="JSON", help="a camera.json to use, not our framing")
    parser.add_argument("--section", action=flag, default=True, help="cut the part open")
    parser.add_argument("--look", type=looks, default=["shaded"], metavar="LOOK[,LOOK]",
                        help="shaded, flat, normals (shaded)")  # fmt: skip
    parser.add_argument("--keep-blend", action=flag, default=True,
                        help="write part.blend and textures")  # fmt: skip
    return parser.parse_args(arguments)


def import_addon():
    """The package around this file, under a name of its own: the folder may be called anything."""
    if PACKAGE in sys.modules:
        return
    here = Path(__file__).resolve().parent
    spec = importlib.util.spec_from_file_location(
        PACKAGE, here / "__init__.py", submodule_search_locations=[str(here)]
    )
    sys.modules[PACKAGE] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[PACKAGE])


def addon(name):
    return importlib.import_module(f"{PACKAGE}.{name}")


def make_workplace(output):
    """A folder inside `output` where files are written before they get their names."""
    try:
        Path(output).mkdir(parents=True, exist_ok=True)
        return Path(tempfile.mkdtemp(prefix=".sardf-", dir=output))
    except OSError as error:
        raise Stop(FAILED, f"{output}: cannot be written: {error.strerror}") from error


def publish(workplace, output):
    """Move every file of the workplace to its place in `output`; return their paths."""
    files = sorted(file for file in workplace.rglob("*") if file.is_file())
    targets = [Path(output) / file.relative_to(workplace) for file in files]
    for file, target in zip(files, targets, strict=True):
        target.parent.mkdir(exist_ok=True)
        os.replace(file, target)
    return targets


def make_part(options):
    """The arrays of the scene file, and its camera."""
    core, job, camera = addon("core"), addon("job"), addon("camera")
    try:
        sardf = core.load()
    except core.MissingCore as error:
        raise Stop(FAILED, str(error)) from error
    wanted = job.CHANNELS if options.keep_blend or "shaded" in options.look else ("base_color",)
    request = job.Request(options.scene, options.resolution, options.size, options.section, wanted)
    try:
        given = camera.read(options.camera) if options.camera else None
        part = job.make_part(sardf, request)
        return part, given or part.scene.camera(width=options.width, height=options.height)
    except (sardf.Error, camera.CameraError) as error:
        raise Stop(WRONG_INPUT, str(error)) from error


def build_scene(part, view, options):
    """An empty Blender session with the part, its camera, lights and units in it."""
    import bpy  # not at the top: without it, main() says what is missing

    assemble, camera, studio, render = map(addon, ("assemble", "camera", "studio", "render"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    assemble.set_units(scene, part.scene)
    images = assemble.build_images(part)
    item = assemble.place(scene, part, images)
    camera.place(scene, view)
    bpy.context.view_layer.update()
    studio.build(scene, *assemble.ball(item), scene.camera)
    render.set_common(scene)
    render.set_size(scene, options.width, options.height)
    return scene, item, images


def render_looks(scene, item, images, options, workplace):
    material, render = addon("material"), addon("render")
    own = item.material_slots[0].material
    for look in sorted(options.look, key=["flat", "normals", "shaded"].index):
        if look == "shaded":
            render.set_shaded(scene, options.samples)
            item.material_slots[0].material = own
        else:
            render.set_exact(scene)
            item.material_slots[0].material = (
                material.build_flat(images["base_color"])
                if look == "flat"
                else material.build_normals()
            )
        render.to_file(scene, workplace / render.LOOKS[look])
    item.material_slots[0].material = own
    render.set_shaded(scene, options.samples)


def keep_blend(images, workplace):
    """Write the textures, pack them, and save the .blend without our temporary materials."""
    import bpy

    folder = workplace / "textures"
    folder.mkdir()
    for channel, image in images.items():
        path = folder / f"{channel}.exr"
        addon("images").write_exr(image, path, channel)
        addon("images").pack(image, path)
    for made in [m for m in bpy.data.materials if m.users == 0]:
        bpy.data.materials.remove(made)
    path = workplace / "part.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True)
    if not path.is_file():
        raise RuntimeError("Blender did not save part.blend")


def run(options):
    """Make everything and return the written files."""
    started = time.perf_counter()
    workplace = make_workplace(options.output)
    try:
        part, view = make_part(options)
        faces, vertices = len(part.mesh.faces), len(part.mesh.vertices)
        made = time.perf_counter()
        print(f"sardf: {vertices} vertices, {faces} faces, baked in {made - started:.1f} s")
        scene, item, images = build_scene(part, view, options)
        render_looks(scene, item, images, options, workplace)
        if options.keep_blend:
            keep_blend(images, workplace)
        (workplace / "camera.json").write_text(json.dumps(view, indent=1) + "\n")
        print(f"sardf: rendered in {time.perf_counter() - made:.1f} s")
        return publish(workplace, options.output)
    except OSError as error:
        raise Stop(FAILED, f"{options.output}: cannot be written: {error}") from error
    finally:
        shutil.rmtree(workplace, ignore_errors=True)


def main(arguments):
    """Run with a list of arguments; returns the exit code."""
    try:
        options = parse_arguments(arguments)
        try:
            import_addon()
        except ModuleNotFoundError as error:
            raise Stop(FAILED, f"{error}: run this in Blender or with the bpy module") from error
        for path in run(options):
            print(f"sardf: wrote {path}")
        return DONE
    except Stop as stop:
        print(f"sardf: {stop}", file=sys.stderr)
        return stop.code
    except SystemExit as stop:  # argparse's --help
        return int(stop.code or 0)
    except Exception as error:
        traceback.print_exc()
        text = " ".join(str(error).split())
        print(f"sardf: failed: {type(error).__name__}: {text}", file=sys.stderr)
        return FAILED


def leave(code):
    """End the process now: Blender would report success whatever a script did."""
    if "bpy" in sys.modules:
        shutil.rmtree(sys.modules["bpy"].app.tempdir, ignore_errors=True)
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


if __name__ == "__main__":
    in_blender = "--" in sys.argv
    leave(main(sys.argv[sys.argv.index("--") + 1 :] if in_blender else sys.argv[1:]))
