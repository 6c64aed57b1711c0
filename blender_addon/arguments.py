# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of headless.py and of the commands, and the ways in which a run ends."""

import argparse

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


def looks(text, known=("shaded", "flat", "normals")):
    names = text.split(",")
    for name in names:
        if name not in known:
            raise argparse.ArgumentTypeError(f"'{name}' is none of {', '.join(known)}")
    return [name for name in known if name in names]


def reference_looks(text):
    return looks(text, ("flat", "shaded"))


COMMANDS = {  # what they do, and what -o names
    "render": ("Bake and render without a window.", "folder to write to"),
    "bake": ("Bake without a window.", "folder to write to"),
    "export": ("Write a scene file, or a scene for POV-Ray.", "file.json or file.pov"),
    "reference": (
        "Render a file's parts in POV-Ray and compare with Cycles.",
        "folder to write to",
    ),
}


def parse(arguments, command="render", program="headless.py"):
    """The options of one of COMMANDS, checked. Raises Stop."""
    if command not in COMMANDS:
        raise Stop(WRONG_INPUT, f"there is no command '{command}'; {', '.join(COMMANDS)} are")
    description, output = COMMANDS[command]
    parser = Parser(prog=program, description=description)
    opened = program != "headless.py"  # a command may be about the file that Blender opened
    parser.add_argument("scene", metavar="SCENE", nargs="?" if opened else None,
                        help="scene file, or .blend with a part")  # fmt: skip
    parser.add_argument("-o", "--output", required=True, metavar="OUT", help=output)
    if command == "reference":
        _add_reference(parser)
        return parser.parse_args(arguments)
    parser.add_argument("--part", default="", metavar="NAME",
                        help="of a .blend: the part to take, where it has several")  # fmt: skip
    if command == "export":
        return _checked_export(parser.parse_args(arguments))
    _add_bake(parser)
    parser.set_defaults(frames=None, pieces=False)
    if command == "render":
        _add_render(parser)
    return _checked_frames(parser.parse_args(arguments))


def _checked_frames(options):
    if not options.frames:
        if options.pieces:
            raise Stop(WRONG_INPUT, "--pieces is for --frames")
        return options
    first, last = options.frames
    if first > last:
        raise Stop(WRONG_INPUT, f"--frames {first} {last}: the first comes after the last")
    if options.scene and not options.scene.lower().endswith(".blend"):
        raise Stop(WRONG_INPUT, f"{options.scene}: --frames is for parts in .blend files")
    if options.pieces and not options.section:
        raise Stop(WRONG_INPUT, "--pieces needs the sections that --no-section leaves out")
    return options


def _checked_export(options):
    options.format = options.output.rpartition(".")[2].lower()
    if options.format not in ("json", "pov"):
        raise Stop(WRONG_INPUT, f"{options.output}: expected a name that ends in .json or .pov")
    return options


def _add_reference(parser):
    parser.add_argument("--look", type=reference_looks, default=["flat", "shaded"],
                        metavar="LOOK[,LOOK]", help="flat, shaded (both)")  # fmt: skip
    parser.add_argument("--samples", type=whole(1, 65536), default=64,
                        help="Cycles' samples of each pixel, shaded (%(default)s)")  # fmt: skip
    parser.add_argument("--light-samples", type=whole(1, 16), default=4,
                        help="POV-Ray's along each side of a light (%(default)s)")  # fmt: skip
    _add_sizes(parser)


def _add_bake(parser):
    flag = argparse.BooleanOptionalAction
    _add_sizes(parser)
    parser.add_argument("--width", type=whole(8, 16384), default=640, help="pixels (%(default)s)")
    parser.add_argument("--height", type=whole(8, 16384), default=480, help="pixels (%(default)s)")
    parser.add_argument("--camera", metavar="JSON", help="a camera.json to use, not our framing")
    parser.add_argument("--tangent", default="", metavar="NAME",
                        help="vector attribute along which metal is brushed; default: "
                        "grain_direction, where the scene has it")  # fmt: skip
    parser.add_argument("--normal-map", action=flag, default=False,
                        help="bake the solid's normals for a coarse mesh")  # fmt: skip


def _add_sizes(parser):
    flag = argparse.BooleanOptionalAction
    parser.add_argument("--resolution", type=whole(4, 4096), default=128,
                        help="cells along the longest side (%(default)s)")  # fmt: skip
    parser.add_argument("--size", type=whole(64, 16384), default=2048,
                        help="texels along a texture's side (%(default)s)")  # fmt: skip
    parser.add_argument("--section", action=flag, default=True, help="cut the part open")


def _add_render(parser):
    parser.add_argument("--samples", type=whole(1, 65536), default=64,
                        help="samples of each pixel of the shaded look (%(default)s)")  # fmt: skip
    parser.add_argument("--look", type=looks, default=["shaded"], metavar="LOOK[,LOOK]",
                        help="shaded, flat, normals (shaded)")  # fmt: skip
    parser.add_argument(
        "--frames",
        nargs=2,
        type=whole(-1048574, 1048574),
        metavar=("FIRST", "LAST"),
        help="of a .blend: bake and render the part in each of these frames",
    )
    parser.add_argument(
        "--pieces",
        action="store_true",
        help="with --frames: both sides of all sections, moved by their Spread",
    )
    parser.add_argument("--keep-blend", action=argparse.BooleanOptionalAction, default=True,
                        help="write part.blend and textures")  # fmt: skip
