"""Graphs along a segment, with the section it runs through above them."""

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from sardf._words import fail
from sardf.plot import parts
from sardf.plot.colors import APART, DASHES
from sardf.plot.look import Look
from sardf.plot.numbers import triple
from sardf.plot.section_figure import fill_panels, section_handles
from sardf.plot.sections import Section
from sardf.plot.segments import Segment

WIDTH = 7.0  # inches
GRAPH = 2.2  # height of one graph in inches


def draw_segment(segment: Segment, section: Section | None = None, look=None, **choices):
    """A matplotlib Figure: a graph for each kind of quantity along the segment.

    section: drawn above the graphs, its first panel, with the segment as a black line.
    look, or choices as for Look(): separate_scales gives each quantity its own graph.
    Raises Error where the segment does not lie in the section's plane.
    """
    look = look or Look(**choices)
    groups = _groups(segment, look.separate_scales)
    if section:
        _check_lies_in(segment, section)
    with parts.settings():
        top = [_height(section)] if section else []
        heights = top + [GRAPH] * len(groups)
        title = _title(segment) if look.title is None else look.title
        figure = parts.new_figure(look.size or _size(heights), title)
        figure.set_layout_engine("constrained", h_pad=0.06, w_pad=0.06)
        axes = figure.subplots(len(heights), 1, height_ratios=heights, squeeze=False)[:, 0]
        handles = []
        if section:
            handles = _draw_above(figure, axes[0], segment, section, look)
        position, label = _position(segment)
        for ax, members in zip(axes[len(top) :], groups, strict=True):
            _draw_graph(ax, position, segment, members)
            aligned = section is not None and section.plane.labels[0] == label
            ends = section.across if aligned else position
            ax.set_xlim(ends[0], ends[-1])
        axes[-1].set_xlabel(f"{label} ({segment.scene.units})")
        handles.append(Patch(facecolor="0.9", label="inside the solid"))
        parts.add_legend(figure, handles)
        return figure


def _groups(segment: Segment, separate: bool) -> list[list[int]]:
    groups: dict[tuple, list[int]] = {}
    for index, quantity in enumerate(segment.chosen):
        groups.setdefault((index,) if separate else quantity.scale, []).append(index)
    return list(groups.values())


def _position(segment: Segment) -> tuple[np.ndarray, str]:
    """What the graphs are drawn over: a coordinate where the segment runs along its axis."""
    if segment.axis is None:
        return segment.distance, f"distance from {triple(segment.start)}"
    return segment.points[:, segment.axis], "xyz"[segment.axis]


def _draw_graph(ax, position, segment: Segment, members) -> None:
    inside = segment.chosen[members[0]].scene.solid(segment.points) >= 0
    ax.fill_between(
        position, 0, 1, where=inside, transform=ax.get_xaxis_transform(), color="0.9", lw=0
    )
    for index in members:
        name = segment.chosen[index].name
        place = index if len(members) > 1 else 0
        ax.plot(
            position, segment.values[name], label=name, lw=1.6, color=APART[place % len(APART)],
            ls=DASHES[place % len(DASHES)],
        )  # fmt: skip
    kind = segment.chosen[members[0]].kind
    if kind == "fraction":
        ax.set_ylim(-0.05, 1.05)
    elif kind in ("field", "error"):
        ax.axhline(0, color="black", lw=0.6)
    labels = {segment.chosen[index].label for index in members}
    label = labels.pop() if len(labels) == 1 else kind
    ax.grid(color="0.8", lw=0.4)
    if len(members) > 1:
        ax.set_ylabel(label)
        ax.legend(
            loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.2, frameon=False,
            ncols=min(len(members), 4), handlelength=3,
        )  # fmt: skip
    else:
        own = name if name.startswith(label) else f"{name}\n{label}"
        ax.set_ylabel(label if kind == "attribute" else own)


def _draw_above(figure, ax, segment: Segment, section: Section, look: Look) -> list:
    first = Section(
        section.scene, section.plane, section.across, section.up, section.points,
        section.panels[:1],
    )  # fmt: skip
    scales = fill_panels(figure, [ax], first, look)
    ends = section.plane.coordinates([segment.start, segment.end])
    if not look.blank:
        ax.plot(ends[:, 0], ends[:, 1], color="white", lw=3.2, zorder=4)
    ax.plot(ends[:, 0], ends[:, 1], color="black", lw=1.8, zorder=5)
    if not look.blank:
        ax.set_title(first.panels[0].quantity.name)
    units = section.scene.units
    ax.set_xlabel(f"{section.plane.labels[0]} ({units})")
    ax.set_ylabel(f"{section.plane.labels[1]} ({units})")
    line = Line2D([], [], color="black", lw=1.8, label="the segment")
    return [*section_handles(first, look, scales), line]


def _check_lies_in(segment: Segment, section: Section) -> None:
    heights = section.plane.coordinates([segment.start, segment.end])[:, 2]
    if np.abs(heights).max() > 1e-6 * segment.distance[-1]:
        fail(f"the segment from {triple(segment.start)} to {triple(segment.end)} does not lie in "
             f"the plane {section.plane.name}")  # fmt: skip


def _height(section: Section) -> float:
    """Inches that let the section be as wide as the graphs."""
    aspect = np.ptp(section.up) / np.ptp(section.across)
    return min(max((WIDTH - 0.9) * aspect, 1.5), 7.0)


def _size(heights) -> tuple[float, float]:
    return WIDTH, sum(heights) + 0.75 * len(heights) + 0.9


def _title(segment: Segment) -> str:
    ends = f"from {triple(segment.start)} to {triple(segment.end)}"
    return ", ".join(filter(None, (segment.scene.title, ends)))
