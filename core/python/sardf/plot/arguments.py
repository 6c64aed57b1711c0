"""The words of the command line."""

import argparse
import re

from sardf.plot.look import ARROW_LENGTHS
from sardf.plot.sections import ONLY

EXAMPLES = """\
examples:
  python -m sardf.plot scenes/two_ellipsoids.json --section y=0 -o fig.png
  python -m sardf.plot scenes/two_ellipsoids.json --section y=0 --only inside \\
      --blend sardf=0.5 min_max r_function -o compared.pdf -o compared.csv
  python -m sardf.plot scenes/cad_pins.json --section x=2 --materials --stripes 10 -o stripes.svg
  python -m sardf.plot scenes/cad_pins.json --segment "-5,2,0" "5,2,0" --section z=0 \\
      --fraction polymer copper --outline insert blend_region --blank -o graphs.png
  python -m sardf.plot part.json --section z=0 --materials --arrows grain -o grain.svg
  python -m sardf.plot scenes/cad_pins_cut.json --isosurface --view "1,-2,1" -o surface.png

exit codes: 0 done, 1 failed, 2 wrong input or usage
"""


def parse(words: list[str]) -> argparse.Namespace:
    """The arguments; SystemExit with the code 2 and a message for wrong usage."""
    parser = make_parser()
    options = parser.parse_args([_kept_apart(word) for word in words])
    plane = options.section is not None or options.plane is not None
    if not (plane or options.segment or options.isosurface):
        parser.error("choose what to draw: --section, --plane, --segment or --isosurface")
    if options.isosurface and (plane or options.segment):
        parser.error("--isosurface is drawn alone, without --section, --plane and --segment")
    if not plane and (options.arrows or options.streamlines):
        parser.error("--arrows and --streamlines are for --section or --plane")
    if not options.isosurface and options.through != "core":
        parser.error("--through is for --isosurface")
    return options


def _kept_apart(word: str) -> str:
    """A leading minus of numbers made no option's: argparse knows -1 but not -1,0,1."""
    return " " + word if re.match(r"-\.?\d", word) else word


def make_parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="sardf.plot", epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Figures of a scene: sections, graphs along a segment, surfaces. Lengths are "
        "in scene units.",
    )  # fmt: skip
    parser.add_argument("scene", help="scene file; - for standard input")
    parser.add_argument("-o", "--output", action="append", required=True, metavar="FILE",
                        help="FILE.png, .svg, .pdf, or .csv for the numbers (- writes CSV to "
                        "standard output); may be repeated")  # fmt: skip
    _add_places(parser.add_argument_group("where"))
    _add_quantities(parser.add_argument_group("what; several are drawn side by side"))
    _add_section_look(parser.add_argument_group("how sections are drawn"))
    _add_vectors(parser.add_argument_group("vector attributes, drawn over sections"))
    _add_surfaces(parser.add_argument_group("surfaces"))
    _add_figure(parser.add_argument_group("the figure"))
    return parser


def _add_places(group) -> None:
    which = group.add_mutually_exclusive_group()
    which.add_argument("--section", metavar="AXIS=VALUE", help="a plane, as y=0")
    which.add_argument("--plane", nargs=2, metavar=("POINT", "NORMAL"),
                       help='any plane: "px,py,pz" "nx,ny,nz"; the normal points to the '
                       "viewer")  # fmt: skip
    group.add_argument(
        "--window",
        metavar="L,R,B,T",
        help="left, right, bottom, top in the plane; default: the whole solid",
    )
    group.add_argument(
        "--segment",
        nargs=2,
        metavar=("START", "END"),
        help='graphs along "x,y,z" "x,y,z"; with --section or --plane that is drawn above them',
    )
    group.add_argument("--isosurface", action="store_true", help="the surface in three dimensions")
    group.add_argument(
        "--resolution",
        type=int,
        metavar="N",
        help="samples along the longer side of a section (400), cells along the "
        "longest side of a surface (128)",
    )
    group.add_argument("--samples", type=int, default=1001, metavar="N",
                       help="samples along a segment (%(default)s)")  # fmt: skip


def _add_quantities(group) -> None:
    group.add_argument(
        "--field",
        nargs="+",
        default=[],
        metavar="NAME",
        help="named fields, 'solid' (the default), or formulas over them: \"=bore - x/2\"",
    )
    group.add_argument(
        "--fraction",
        nargs="+",
        default=[],
        metavar="MATERIAL",
        help="volume fractions of materials",
    )
    group.add_argument("--attribute", nargs="+", default=[], metavar="NAME", help="attributes")
    group.add_argument(
        "--materials", action="store_true", help="the materials' colours, mixed by the fractions"
    )
    show = group.add_mutually_exclusive_group()
    show.add_argument(
        "--gradient",
        dest="show",
        action="store_const",
        const="gradient",
        default="value",
        help="of fields the length of the gradient: 1 for distances",
    )
    show.add_argument(
        "--error",
        dest="show",
        action="store_const",
        const="error",
        help="of fields the error of their blends against min and max",
    )
    group.add_argument(
        "--blend",
        nargs="+",
        default=[],
        metavar="NAME[=NUMBER]",
        help="the same with every boolean joined by min_max, r_function, sardf=R, "
        "sardf_c1=R, smooth=k; 'scene' for the scene as it is",
    )
    group.add_argument("--only", choices=ONLY,
                       help="the part to show; default: everywhere for fields, inside for the "
                       "rest")  # fmt: skip


def _add_section_look(group) -> None:
    group.add_argument(
        "--bands",
        metavar="N|STEP",
        help="filled bands: about N, or of width STEP, which has a decimal point "
        "(1.0); none: smooth colours",
    )
    group.add_argument(
        "--lines",
        metavar="STEP|V1,V2,...",
        help="contour lines; default: between the bands; none: no lines",
    )
    group.add_argument("--label-lines", action="store_true", help="write values on the lines")
    group.add_argument(
        "--stripes",
        type=int,
        default=0,
        metavar="N",
        help="N bands, every second darkened (an odd N leaves both ends light); with --materials "
        "they follow the first fraction",
    )
    group.add_argument(
        "--no-outline",
        dest="outline",
        action="store_false",
        help="without the outline of the solid",
    )
    group.add_argument(
        "--outline",
        dest="outlines",
        nargs="+",
        default=[],
        metavar="NAME",
        help="outlines of further fields",
    )
    group.add_argument("--blank", action="store_true", help="outlines alone, no colours, no lines")
    group.add_argument("--no-scale-bar", dest="scale_bar", action="store_false",
                       help="without the bar of a round length")  # fmt: skip


def _add_vectors(group) -> None:
    which = group.add_mutually_exclusive_group()
    which.add_argument(
        "--arrows",
        metavar="NAME",
        help="arrows along the attribute, coloured by the share that points out of the plane; "
        "without a choice of what to draw they stand alone. A CSV file has one row for each",
    )
    which.add_argument("--streamlines", metavar="NAME", help="lines along the attribute, likewise")
    group.add_argument(
        "--arrow-count",
        type=int,
        default=24,
        metavar="N",
        help="arrows along the longer side of the section; streamlines keep the distance that "
        "these would have (%(default)s)",
    )
    group.add_argument("--arrow-lengths", choices=ARROW_LENGTHS, default=ARROW_LENGTHS[0],
                       help="equal in space, or scaled by the vectors' lengths "
                       "(%(default)s)")  # fmt: skip


def _add_surfaces(group) -> None:
    group.add_argument(
        "--through",
        choices=("core", "povray"),
        default="core",
        help="who draws the surface (%(default)s)",
    )
    group.add_argument(
        "--level",
        default=0.0,
        metavar="D",
        help="value of the field on the surface: positive is inside",
    )
    group.add_argument("--view", metavar="X,Y,Z",
                       help="direction towards the camera; default: the scene's")  # fmt: skip


def _add_figure(group) -> None:
    group.add_argument(
        "--separate-scales",
        action="store_true",
        help="each panel has its own colour scale, each curve its own graph",
    )
    group.add_argument("--limits", metavar="LOW,HIGH", help="limits of the colours")
    group.add_argument("--colors", metavar="MAP", help="a matplotlib colour map")
    group.add_argument("--columns", type=int, metavar="N", help="panels side by side")
    group.add_argument("--title", metavar="TEXT", help="default: the scene's title and the plane")
    group.add_argument("--size", metavar="W,H", help="size of the figure in inches")
    group.add_argument("--dpi", type=int, default=150, metavar="N",
                       help="pixels per inch of .png (%(default)s)")  # fmt: skip
