"""python -m sardf.accuracy scene.json --blend sardf=0.5 -o table.json"""

import argparse
import json
import re
import sys

import sardf
from sardf import _command
from sardf._words import blend_from, choose, fail
from sardf.accuracy import measure, measure_section
from sardf.accuracy._map import write_map

PICTURES = ("png", "svg", "pdf")


def parser():
    made = argparse.ArgumentParser(
        prog="python -m sardf.accuracy",
        description="How far a scene's solid, or one of its fields, is from the true distance.",
    )
    made.add_argument("scene", help="scene file")
    made.add_argument("--field", metavar="NAME", help="a solid of the scene instead of its own")
    made.add_argument(
        "--blend", metavar="NAME=R", help="join all booleans by this blend, such as sardf=0.5"
    )
    made.add_argument(
        "--resolution", type=int, default=128, metavar="N",
        help="cells of the reference mesh along the longest side (128)",
    )  # fmt: skip
    made.add_argument("--samples", type=int, metavar="N", help="points along the longest side")
    made.add_argument(
        "--bounds", type=float, nargs=6, metavar="B",
        help="lowest and highest corner of the points; default: around the solid",
    )  # fmt: skip
    made.add_argument("--section", metavar="AXIS=VALUE", help="points on a plane, such as y=0")
    made.add_argument(
        "-o",
        "--output",
        metavar="FILE",
        help="table as .json, every point as .csv, or a section's map as .png, .svg or .pdf",
    )
    return made


def chosen(options):
    """The scene with the chosen blend, or the scene of the chosen field."""
    scene = sardf.load(options.scene)
    if options.blend:
        scene = scene.with_blend(blend_from(options.blend))
    if options.field is None:
        return scene
    field = choose("field", options.field, scene.fields)
    return sardf.Scene(solid=field, units=scene.units, title=options.field)


def section_of(text):
    found = re.fullmatch(r"([xyz])=([-+0-9.eE]+)", text)
    try:
        return found[1], float(found[2])
    except (TypeError, ValueError):
        fail(f"--section {text}: an axis, = and a number are accepted, as in y=0")


def run(options):
    ending = (options.output or ".json").rpartition(".")[2]
    if ending not in ("json", "csv", *PICTURES):
        fail(f"{options.output}: .json, .csv, .png, .svg and .pdf can be written")
    if ending in PICTURES and not options.section:
        fail(f"{options.output}: a map needs a plane, such as --section y=0")
    given = {"resolution": options.resolution}
    if options.bounds:
        given["bounds"] = (options.bounds[:3], options.bounds[3:])
    if options.samples:
        given["samples"] = options.samples
    scene = chosen(options)
    if options.section:
        axis, at = section_of(options.section)
        measured = measure_section(scene, axis, at, **given)
    else:
        measured = measure(scene, **given)
    print(measured.text(), end="")
    if ending in PICTURES:
        write_map(options.output, scene, measured)
    elif options.output:
        table = json.dumps(measured.summary(), indent=2) + "\n"
        _command.write_text(options.output, table if ending == "json" else measured.csv())


def main(arguments=None):
    return _command.run("sardf.accuracy", run, parser().parse_args(arguments))


if __name__ == "__main__":
    sys.exit(main())
