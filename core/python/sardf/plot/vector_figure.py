"""Arrows and streamlines over a section, coloured by how far they point out of its plane."""

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from sardf._words import fail
from sardf.plot import parts
from sardf.plot.colors import APART
from sardf.plot.look import SCALED, Look
from sardf.plot.numbers import brief
from sardf.plot.vectors import FLAT, Vectors

# Blue away from the viewer, black in the plane, red towards; a white edge keeps them apart from
# what is behind.
COLORS = LinearSegmentedColormap.from_list("towards the viewer", [APART[0], "black", APART[1]])
LIMITS = Normalize(-1, 1)
WIDTH = 0.09  # of the step between arrows
DOT = 2.2  # widths: the size of the dot in place of a shorter arrow
LONGEST = 0.92  # of the step
STEPS = 0.4  # of a cell: the longest step of a streamline, so that it looks round
CELLS = 30  # of matplotlib's streamlines along a side at the density 1


def draw_vectors(axes, section, panel, look: Look) -> None:
    """Draws the panel's vectors into its axes."""
    vectors = panel.vectors
    if vectors.kind == "arrows":
        _draw_arrows(axes, vectors, look)
        return
    clip = parts.region(axes, section, panel.solid, vectors.only)
    for artist in _draw_streamlines(axes, vectors):
        if clip is not None:
            artist.set_clip_path(clip, axes.transData)


def _draw_arrows(axes, vectors: Vectors, look: Look) -> None:
    directions, length = vectors.directions, vectors.length
    drawn = vectors.shown & (length > 0)
    relative = np.ones(drawn.sum())
    if look.arrow_lengths == SCALED:
        relative = length[drawn] / length[drawn].max()
    right, up, towards = (directions[drawn] * (LONGEST * vectors.step * relative)[:, None]).T
    share = directions[drawn][:, 2]
    places = vectors.plane.coordinates(vectors.points[drawn])
    arrows = axes.quiver(
        places[:, 0], places[:, 1], right, up, share, cmap=COLORS, norm=LIMITS, pivot="mid",
        angles="xy", units="xy", scale_units="xy", scale=1, width=WIDTH * vectors.step,
        headwidth=3.6, headlength=4, headaxislength=3.6, minlength=DOT, zorder=3,
    )  # fmt: skip
    arrows.set_path_effects([withStroke(linewidth=1.4, foreground="white")])


def _draw_streamlines(axes, vectors: Vectors) -> list:
    """The lines' artists: drawn wherever a cell of the grid touches what is shown, to be cut off
    where that ends."""
    directions = np.where(_grown(vectors.shown)[..., None], vectors.directions, np.nan)
    right, up, share = (np.ma.masked_invalid(directions[..., i]) for i in range(3))
    cells = [max(np.ptp(s) / vectors.step, 2) + 0.5 for s in (vectors.across, vectors.up)]
    before = set(axes.patches)
    lines = axes.streamplot(
        vectors.across, vectors.up, right, up, density=np.array(cells) / CELLS, color=share,
        cmap=COLORS, norm=LIMITS, linewidth=1.1, arrowsize=0.9, minlength=1 / max(cells),
        integration_max_step_scale=STEPS, zorder=3,
    ).lines  # fmt: skip
    if not lines.get_segments():
        fail(f"no streamline of {vectors.name} is longer than the distance between two of them; "
             "a larger arrow count makes it shorter")  # fmt: skip
    behind = LineCollection(lines.get_segments(), colors="white", linewidths=2.6, zorder=2.9)
    axes.add_collection(behind)
    return [behind, lines, *(patch for patch in axes.patches if patch not in before)]


def _grown(shown: np.ndarray) -> np.ndarray:
    """The points that are shown, and all their neighbours."""
    rows, columns = shown.shape
    wide = np.pad(shown, 1)
    shifts = [(i, j) for i in range(3) for j in range(3)]
    return np.any([wide[i : i + rows, j : j + columns] for i, j in shifts], axis=0)


def add_vector_bar(figure, axes, drawn: list[Vectors]) -> None:
    """A bar beside the axes that explains the colours, where some vectors leave the plane."""
    out_of_plane = max(
        np.abs(vectors.directions[vectors.shown & (vectors.length > 0), 2]).max()
        for vectors in drawn
    )
    if out_of_plane > FLAT:
        figure.colorbar(
            ScalarMappable(LIMITS, COLORS), ax=axes,
            label=f"{drawn[0].name}: share towards the viewer", ticks=[-1, -0.5, 0, 0.5, 1],
            format=lambda value, _: brief(value), aspect=28, pad=0.02,
        ).ax.minorticks_off()  # fmt: skip


def vector_handles(drawn: list[Vectors], look: Look) -> list:
    """The entry of the vectors in a legend."""
    vectors = drawn[0]
    text = f"streamlines of {vectors.name}"
    if vectors.kind == "arrows":
        text = f"direction of {vectors.name}"
        if look.arrow_lengths == SCALED:
            longest = max(np.nanmax(v.length[v.shown]) for v in drawn)
            text = f"{vectors.label}, longest {brief(longest)}"
    return [Line2D([], [], color="black", lw=1.2, marker=">", markersize=4, label=text)]
