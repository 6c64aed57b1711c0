# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of headless.py and the ways in which a run ends."""

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


def looks(text):
    known = ("shaded", "flat", "normals")
    names = text.split(",")
    for name in names:
        if name not in known:
            raise argparse.ArgumentTypeError(f"'{name}' is none of {', '.join(known)}")
    return [name for name in known if name in names]


def parse(arguments):
    """The options, checked. Raises Stop."""
    parser = Parser(prog="headless.py", description="Render a scene file without a window.")
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
    parser.add_argument("--tangent", default="", metavar="NAME",
                        help="vector attribute along which metal is brushed; default: "
                        "grain_direction, where the scene has it")  # fmt: skip
    parser.add_argument("--section", action=flag, default=True, help="cut the part open")
    parser.add_argument("--look", type=looks, default=["shaded"], metavar="LOOK[,LOOK]",
                        help="shaded, flat, normals (shaded)")  # fmt: skip
    parser.add_argument("--keep-blend", action=flag, default=True,
                        help="write part.blend and textures")  # fmt: skip
    return parser.parse_args(arguments)
