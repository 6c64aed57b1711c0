"""Figures of scenes: sections, graphs along segments, surfaces; their numbers as arrays and CSV.

    python -m sardf.plot scenes/two_ellipsoids.json --section y=0 -o fig.png

and the same from Python:

    import sardf
    from sardf import plot
    scene = sardf.load("scenes/two_ellipsoids.json")
    cut = plot.section(scene, "y=0", blends=["sardf=0.5", "min_max", "r_function"])
    cut.values["solid, min_max"]                 # (rows, columns), at cut.points
    plot.save(plot.draw_sections(cut, lines=0.25), "fig.svg")

`section`, `segment` and `surfaces` compute numbers, `draw_...` makes matplotlib Figures of them.
"""

try:
    import matplotlib  # noqa: F401
except ModuleNotFoundError:
    # With this name, python -m prints the sentence instead of a traceback.
    raise ImportError("plots need matplotlib: pip install 'sardf[plot]'", name=__name__) from None

from sardf._command import Failure
from sardf._words import blend_from
from sardf.plot.look import Look
from sardf.plot.output import save, write_csv
from sardf.plot.planes import Plane, plane
from sardf.plot.quantities import Quantity, quantities
from sardf.plot.section_figure import draw_sections
from sardf.plot.sections import Panel, Section, section
from sardf.plot.segment_figure import draw_segment
from sardf.plot.segments import Segment, segment
from sardf.plot.surface_figure import draw_pictures, draw_surfaces
from sardf.plot.surfaces import Surface, picture, surfaces
from sardf.plot.vectors import Vectors

__all__ = [
    "Failure",
    "Look",
    "Panel",
    "Plane",
    "Quantity",
    "Section",
    "Segment",
    "Surface",
    "Vectors",
    "blend_from",
    "draw_pictures",
    "draw_sections",
    "draw_segment",
    "draw_surfaces",
    "picture",
    "plane",
    "quantities",
    "save",
    "section",
    "segment",
    "surfaces",
    "write_csv",
]
