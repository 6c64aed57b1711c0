"""python -m sardf.svg drawing.svg --tolerance 0.01 -o fields.json"""

import argparse
import json
import sys

from sardf import _command
from sardf.svg import read_contours


def parser():
    made = argparse.ArgumentParser(
        prog="python -m sardf.svg",
        description="Closed contours of an SVG drawing as fields for a scene file.",
        epilog="Coordinates are user units as the viewBox counts them, times --scale, y upwards.",
    )
    made.add_argument("drawing", help="SVG file")
    made.add_argument(
        "--tolerance", type=float, required=True, metavar="T",
        help="how far a contour may be from the drawn curve (scene units)",
    )  # fmt: skip
    made.add_argument(
        "--scale", type=float, default=1.0, metavar="S", help="scene units in one user unit (1)"
    )
    made.add_argument("--only", nargs="+", metavar="NAME", help="read these elements only")
    made.add_argument(
        "--implicit", action="store_true", help="write implicit_polygon instead of polygon"
    )
    made.add_argument("-o", "--output", required=True, metavar="FILE", help="JSON file, or - ")
    return made


def text_of(contours, operation):
    """An object {name: {operation: {"vertices": ...}}}, one field on each line."""
    fields = [
        f"  {json.dumps(name)}: " + json.dumps({operation: {"vertices": contour.tolist()}})
        for name, contour in contours.items()
    ]
    return "{\n" + ",\n".join(fields) + "\n}\n"


def convert(options):
    contours = read_contours(options.drawing, options.tolerance, options.scale, options.only)
    operation = "implicit_polygon" if options.implicit else "polygon"
    for name in set(contours) & {"x", "y", "z", "pi"}:
        raise _command.located_error(
            f"a field cannot be named '{name}'; give the element another id", options.drawing
        )
    _command.write_text(options.output, text_of(contours, operation))


def main(arguments=None):
    return _command.run("sardf.svg", convert, parser().parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
