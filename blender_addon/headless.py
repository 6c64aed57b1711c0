# SPDX-License-Identifier: GPL-3.0-or-later
"""Render a scene file, or a part in a .blend file, without a window.

    blender -b -P blender_addon/headless.py -- SCENE -o OUT [options]
    python blender_addon/headless.py SCENE -o OUT [options]      (with the bpy module)

Writes into the folder OUT: the picture of each look (part.png, flat.exr, normals.exr), camera.json
with the camera used, and, unless --no-keep-blend, part.blend with its images inside and the baked
channels as textures/*.exr. With --frames FIRST LAST the part of a .blend is baked and rendered in
each frame, into part_0001.png and so on, each of which has its name as soon as it is complete.

Exit code: 0 everything was written, 1 it was not, 2 wrong input or usage; then one line on standard
error says why. The commands of commands.py run here as well.
"""

import importlib.util
import json
import os
import shutil
import sys
import time
import traceback
from pathlib import Path

TEXTURES = "textures"
PACKAGE = __package__ or "sardf_blender"  # a script has no package: called as when installed


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


import_addon()
arguments, outputs = addon("arguments"), addon("outputs")
DONE, FAILED, WRONG_INPUT = arguments.DONE, arguments.FAILED, arguments.WRONG_INPUT
Stop = arguments.Stop


def load_core():
    try:
        return addon("core").load()
    except addon("core").MissingCore as error:
        raise Stop(FAILED, str(error)) from error


def make_part(options, signals, workplace):
    """The arrays of the scene or part, its textures in the workplace, and its camera."""
    job, camera, sardf = addon("baked.job"), addon("picture.camera"), load_core()
    path, scene = addon("sources").find(options)
    whole = options.command == "bake" or options.keep_blend or "shaded" in options.look
    wanted = job.CHANNELS if whole else ("base_color",)
    wanted += (job.NORMAL_MAP,) if options.normal_map else ()
    request = job.Request(
        path, options.resolution, options.size, options.section, wanted, options.tangent, scene,
        store=addon("baked.store").Store(workplace / TEXTURES),
    )  # fmt: skip
    try:
        given = camera.read(options.camera) if options.camera else None
        part = job.make_part(sardf, request, progress=lambda share: not signals.name)
        return part, given or part.scene.camera(width=options.width, height=options.height)
    except (sardf.Error, camera.CameraError, job.NothingLeft) as error:
        raise Stop(WRONG_INPUT, str(error)) from error
    except addon("baked.store").StoreError as error:
        raise Stop(FAILED, str(error)) from error
    except sardf.Cancelled:
        signals.check()
        raise


def build_scene(part, view, options):
    """An empty Blender session with the part, its camera, lights and units in it."""
    import bpy

    assemble = addon("baked.assemble")
    camera, studio, render = (addon(f"picture.{name}") for name in ("camera", "studio", "render"))
    addon("sources").start_empty(options.as_command)
    scene = bpy.context.scene
    assemble.set_units(scene, part.scene)
    images = assemble.build_images(load_core(), part, keep=True)
    item = assemble.place(scene, part, images)
    camera.place(scene, view)
    bpy.context.view_layer.update()
    studio.build(scene, *assemble.ball(item), scene.camera)
    render.set_common(scene)
    render.set_size(scene, options.width, options.height)
    return scene, item, images


def keep_blend(workplace):
    """Save the .blend, its images inside, without our temporary materials."""
    import bpy

    for made in [m for m in bpy.data.materials if m.users == 0]:
        bpy.data.materials.remove(made)
    path = workplace / "part.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True)
    if not path.is_file():
        raise RuntimeError("Blender did not save part.blend")


def run(options):
    """Make everything and return the written files."""
    addon("picture.render")  # imports bpy, which sets signal handlers of its own
    signals = outputs.Signals()
    started = time.perf_counter()
    workplace = outputs.make_workplace(options.output)
    try:
        if options.frames:
            return addon("frames").run(load_core(), options, signals, workplace)
        part, view = make_part(options, signals, workplace)
        faces, vertices = len(part.mesh.faces), len(part.mesh.vertices)
        made = time.perf_counter()
        print(f"sardf: {vertices} vertices, {faces} faces, baked in {made - started:.1f} s")
        scene, item, images = build_scene(part, view, options)
        if options.command == "render":
            names, looks = addon("picture.render").LOOKS, addon("picture.looks")
            looks.render_all(
                scene, [(item, images["base_color"])], options.look, options.samples,
                lambda look: workplace / names[look], signals.check,
            )  # fmt: skip
            print(f"sardf: rendered in {time.perf_counter() - made:.1f} s")
        if options.command == "bake" or options.keep_blend:
            keep_blend(workplace)
        else:
            shutil.rmtree(workplace / TEXTURES)
        signals.check()
        (workplace / "camera.json").write_text(json.dumps(view, indent=1) + "\n")
        return outputs.publish(workplace, options.output)
    except OSError as error:
        raise Stop(FAILED, f"{options.output}: cannot be written: {error}") from error
    finally:
        shutil.rmtree(workplace, ignore_errors=True)


def export(options):
    """Write the scene file or the scene for POV-Ray and return the written file."""
    import bpy

    sardf, sources, output = load_core(), addon("sources"), Path(options.output).resolve()
    is_part = not options.scene or options.scene.lower().endswith(".blend")
    try:
        if is_part and options.format == "json":
            depsgraph = bpy.context.evaluated_depsgraph_get
            part = sources.part_of(options)  # opens the file, so it comes first
            for warning in addon("parts.part_export").write(part, output, depsgraph()):
                print(f"sardf: {warning}")
            return [output]
        path, scene = sources.find(options)
        made = sardf.load(path) if scene is None else sardf.Scene.from_json(json.dumps(scene))
        (made.save if options.format == "json" else made.povray)(str(output))
    except (sardf.Error, addon("parts.part_error").PartError) as error:
        raise Stop(WRONG_INPUT, str(error)) from error
    except OSError as error:
        raise Stop(FAILED, f"{output}: cannot be written: {error}") from error
    return [output]


def reference(options):
    """Render a .blend file's parts in POV-Ray and in Cycles and return the written files."""
    import bpy

    sardf, sources = load_core(), addon("sources")
    compare, work = addon("reference.compare"), addon("reference.work")
    signals = outputs.Signals()
    sources.register()
    if options.scene:
        if not options.scene.lower().endswith(".blend"):
            raise Stop(WRONG_INPUT, f"{options.scene}: expected a .blend file")
        sources.open_file(options.scene)
    settings = bpy.context.scene.sardf
    settings.resolution, settings.sections = options.resolution, options.section
    settings = bpy.context.scene.sardf_reference
    settings.compare, settings.keep_cycles = True, False
    settings.samples, settings.light_samples = options.samples, options.light_samples
    workplace = outputs.make_workplace(options.output)
    try:
        order = compare.order_of(bpy.context, tuple(options.look), options.size)
        made = work.make(sardf, order, progress=lambda share: not signals.name)
        compare.place_baked(bpy.context, order, made)
        for text in order.stage.warnings:
            print(f"sardf: {text}")
        for look in order.looks:
            print(f"sardf: {compare.store(bpy.context, order, made, look)}")
            compare.write(workplace, look, bpy.context.scene)
        return outputs.publish(workplace, options.output)
    except (compare.Unready, sardf.Error) as error:
        raise Stop(WRONG_INPUT, str(error)) from error
    except OSError as error:
        raise Stop(FAILED, f"{options.output}: cannot be written: {error}") from error
    except sardf.Cancelled:
        signals.check()
        raise
    finally:
        shutil.rmtree(workplace, ignore_errors=True)


def main(words, command="render"):
    """Run with a list of command-line words; returns the exit code."""
    program = f"blender -c sardf {command}" if __package__ else "headless.py"
    try:
        options = arguments.parse(words, command, program)
        options.command, options.as_command = command, bool(__package__)
        if importlib.util.find_spec("bpy") is None:
            raise Stop(FAILED, "run this in Blender, or with a Python that has the bpy module")
        for path in {"export": export, "reference": reference}.get(command, run)(options):
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
