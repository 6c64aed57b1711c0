# SPDX-License-Identifier: GPL-3.0-or-later
"""An animation without a window: in each frame the part of a .blend file is baked anew, as its
keyframes and drivers have it, and rendered.

Camera and lights are those of the file's first frame, whichever frames are wanted, so that a frame
that is rendered alone is that of the animation.
"""

import json
from dataclasses import dataclass
from pathlib import Path

import bpy
from mathutils import Matrix, Vector

from . import outputs, sources
from .arguments import WRONG_INPUT, Stop
from .baked import assemble, job, store
from .parts import part_pieces, part_scene
from .parts.part_error import PartError
from .picture import camera, looks, render, studio


@dataclass
class Frame:
    """What the part is in a frame: `shown`, [(scene, how far it is moved in the part's frame)], and
    the part's `matrix` in the world."""

    number: int
    shown: list
    matrix: Matrix


def run(sardf, options, signals, workplace):
    """Render the frames that the options name; returns the written files. Raises Stop."""
    frames = read(options)
    reference, wanted = frames[0], frames[1:]
    written = []
    try:
        whole = sardf.Scene.from_json(json.dumps(reference.shown[0][0]))
        given = camera.read(options.camera) if options.camera else None
        view = given or whole.camera(width=options.width, height=options.height)
        scene = build_scene(whole, view, options)
        (workplace / "camera.json").write_text(json.dumps(view, indent=1) + "\n")
        for frame in wanted:
            signals.check()
            matrix = reference.matrix.inverted_safe() @ frame.matrix
            baked = bake(sardf, scene, frame, matrix, options, signals)
            looks.render_all(
                scene, [each[:2] for each in baked], options.look, options.samples,
                lambda look, frame=frame: workplace / name_of(look, frame.number), signals.check,
            )  # fmt: skip
            remove(baked)
            written += outputs.publish(workplace, options.output)
            print(f"sardf: frame {frame.number}: {len(baked)} objects", flush=True)
    except (sardf.Error, camera.CameraError) as error:
        raise Stop(WRONG_INPUT, str(error)) from error
    except sardf.Cancelled:
        signals.check()
        raise
    return written


def name_of(look, number):
    """part_0001.png and so on."""
    stem, _, ending = render.LOOKS[look].rpartition(".")
    return f"{stem}_{number:04d}.{ending}"


def read(options):
    """The Frame of the file's first frame, then those that are wanted. Raises Stop."""
    part = sources.part_of(options)
    scene = bpy.context.scene
    first, last = options.frames
    said = set()
    return [
        _read_frame(scene, part, number, options.pieces, said)
        for number in (scene.frame_start, *range(first, last + 1))
    ]


def _read_frame(scene, part, number, in_pieces, said):
    scene.frame_set(number)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    try:
        reading = part_scene.read(part, depsgraph)
        shown = [(reading.scene, Vector())]
        if in_pieces:
            pieces = part_pieces.pieces_of(part, reading)
            shown = [(each.scene, part_pieces.shift_of(each, depsgraph)) for each in pieces]
    except PartError as error:
        raise Stop(WRONG_INPUT, f"frame {number}: {error}") from error
    for warning in reading.warnings:
        if warning not in said:
            print(f"sardf: frame {number}: {warning}")
            said.add(warning)
    return Frame(number, shown, part.evaluated_get(depsgraph).matrix_world.copy())


def build_scene(whole, view, options):
    """An empty Blender session with units, camera and lights for a sardf.Scene."""
    sources.start_empty(options.as_command)
    scene = bpy.context.scene
    assemble.set_units(scene, whole)
    camera.place(scene, view)
    bpy.context.view_layer.update()
    low, high = map(Vector, whole.bounds)
    studio.build(scene, (low + high) / 2, (high - low).length / 2, scene.camera)
    render.set_common(scene)
    render.set_size(scene, options.width, options.height)
    return scene


def bake(sardf, scene, frame, matrix, options, signals):
    """[(object, base colour's image, all images)] of what there is in a frame."""
    made = []
    channels = job.CHANNELS if "shaded" in options.look else ("base_color",)
    channels += (job.NORMAL_MAP,) if options.normal_map else ()
    for number, (shown, shift) in enumerate(frame.shown):
        request = job.Request(
            f"frame {frame.number}, {number}", options.resolution, options.size, options.section,
            channels, options.tangent, shown,
            store=store.Store(Path(bpy.app.tempdir) / "sardf frame", replace=True),
        )  # fmt: skip
        try:
            arrays = job.make_part(sardf, request, progress=lambda share: not signals.name)
        except job.NothingLeft as error:
            print(f"sardf: frame {frame.number}: {error}")
            continue
        images = assemble.build_images(sardf, arrays)
        item = assemble.place(scene, arrays, images, assemble.NEW)
        item.matrix_world = matrix @ Matrix.Translation(shift)
        made.append((item, images["base_color"], images))
    return made


def remove(baked):
    """What was made for a frame: nothing of it may tell in the next one."""
    for item, _, images in baked:
        bpy.data.meshes.remove(item.data)  # and the object with it
        for image in images.values():
            bpy.data.images.remove(image)
    for material in [each for each in bpy.data.materials if each.users == 0]:
        bpy.data.materials.remove(material)
