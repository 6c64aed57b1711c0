# SPDX-License-Identifier: GPL-3.0-or-later
"""From POV-Ray's pictures to images, numbers and a comparison with Cycles."""

import json

from .. import core, preferences
from ..baked import assemble
from ..parts import part_bake
from . import cycles, pictures, stage, work

NUMBERS = ("intersection_over_union", "median", "quantile_99", "compared_pixels")


class Unready(Exception):
    """Why nothing can be rendered or compared, in one sentence."""


def order_of(context, looks=None, texels=0):
    """The work.Order of a context's scene and settings; `texels` along a texture's side of what is
    baked, 0: as the panel says. Raises Unready."""
    sardf = core.load()
    settings = context.scene.sardf_reference
    try:
        return work.Order(
            stage.of_scene(context, texels),
            looks or (settings.look,),
            settings.compare,
            light_samples=settings.light_samples,
            program=preferences.povray(),
        )
    except (stage.StageError, stage.PartError, sardf.Error) as error:
        raise Unready(str(error)) from error


def place_baked(context, order, made):
    """Put what was baked meanwhile under its parts. Raises PartError and StoreError."""
    sardf = core.load()
    for index, part in made.baked.items():
        parent = part_bake.find(order.stage.parts[index].key)
        built = assemble.build_images(sardf, part)
        order.stage.parts[index].item = part_bake.place(context.scene, parent, part, built).name
    context.view_layer.update()


def store(context, order, made, look):
    """Keep POV-Ray's picture of a look; with "compare" also Cycles' and the difference. Returns
    one line that tells the numbers. Raises Unready."""
    settings = context.scene.sardf_reference
    said = [*order.stage.warnings, *made.sentences]
    settings.warnings = "\n".join(said)
    settings.compared = ""
    reference = pictures.keep(
        "reference", pictures.from_exr(made.pictures[look], "reference"), look
    )
    if not order.bake:
        pictures.show(context, "reference")
        return f"{look}: rendered in POV-Ray"
    candidate = _candidate(context, order, look)
    sardf = core.load()
    try:
        numbers = sardf.compare_pictures(
            pictures.array(reference), pictures.array(candidate), pictures.FACTOR
        )
    except sardf.Error as error:  # an empty picture: the camera sees nothing
        raise Unready(f"the {look} pictures cannot be compared: {error}") from error
    pictures.difference(sardf, numbers.pop("difference"), look)
    settings.compared = look
    for name in NUMBERS:
        setattr(settings, name, numbers[name])
    pictures.show(context, "difference")
    return line_of(look, numbers)


def write(folder, look, scene):
    """The last pictures of a look, and the numbers, as files."""
    for kind in pictures.NAMES:
        content = pictures.find(kind).packed_file.data
        (folder / f"{kind}_{look}.exr").write_bytes(content)
    settings = scene.sardf_reference
    numbers = {name: getattr(settings, name) for name in NUMBERS}
    numbers["not_carried_over"] = settings.warnings.splitlines()
    (folder / f"numbers_{look}.json").write_text(json.dumps(numbers, indent=1) + "\n")


def line_of(look, numbers):
    return (
        f"{look}: mask IoU {numbers['intersection_over_union']:.5f}, difference median "
        f"{numbers['median']:.2f}/255, 99 % {numbers['quantile_99']:.2f}/255, "
        f"{numbers['compared_pixels']} pixels"
    )


def _candidate(context, order, look):
    """Cycles' picture: the last one where it is to be kept, else a new one. Raises Unready."""
    settings = context.scene.sardf_reference
    size = (order.stage.width, order.stage.height)
    last = pictures.find("cycles")
    wanted = settings.keep_cycles and last is not None
    if wanted and last[pictures.MARK] == look and tuple(last.size) == size:
        return last
    names = [part.item for part in order.stage.parts]
    try:
        with pictures.exr_file("cycles") as path:
            cycles.picture(context, names, look, settings.samples, size, path)
            content = path.read_bytes()
    except cycles.NoPicture as error:
        raise Unready(str(error)) from error
    return pictures.keep("cycles", pictures.from_exr(content, "cycles"), look)
