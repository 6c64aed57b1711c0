"""Sections side by side, with the colour scales that they share."""

import numpy as np

from sardf._words import fail
from sardf.plot import parts
from sardf.plot.look import Look
from sardf.plot.numbers import brief
from sardf.plot.quantities import material_colors
from sardf.plot.scales import scale_of
from sardf.plot.sections import Section
from sardf.plot.vector_figure import add_vector_bar, draw_vectors, vector_handles

WIDEST = 14.0  # inches


def draw_sections(section: Section, look: Look | None = None, **choices):
    """A matplotlib Figure with one panel for each quantity of the section.

    Panels of the same kind share one colour scale. look, or choices as for Look(), say how.
    Raises Error where nothing can be drawn.
    """
    look = look or Look(**choices)
    with parts.settings():
        rows, columns = _grid(section.panels, look.columns)
        title = _title(section) if look.title is None else look.title
        figure = parts.new_figure(look.size or _size(section, rows, columns), title)
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for axes in grid.flat[len(section.panels) :]:
            axes.remove()
        axes = list(grid.flat[: len(section.panels)])
        scales = fill_panels(figure, axes, section, look)
        _label(axes, columns, section)
        if look.blank and len(axes) == 1:  # it shows nothing of the quantity
            axes[0].set_title("")
        parts.add_legend(figure, section_handles(section, look, scales))
        return figure


def fill_panels(figure, axes, section: Section, look: Look) -> list:
    """Draws each panel into its axes; the scales of the colour bars."""
    _check_something_shown(section)
    groups: dict[tuple, list[int]] = {}
    for index, panel in enumerate(section.panels):
        key = (index,) if look.separate_scales else panel.quantity.scale
        groups.setdefault(key, []).append(index)
    scales = []
    for members in groups.values():
        panels = [section.panels[i] for i in members]
        if panels[0].quantity.kind == "colors":
            for i in members if not look.blank else ():
                parts.draw_colors(axes[i], section, section.panels[i], look.stripes)
        elif not look.blank:
            scale = scale_of(panels, look)
            for i in members:
                parts.draw_values(axes[i], section, section.panels[i], scale, look.label_lines)
            bar = figure.colorbar(
                scale.mappable, ax=[axes[i] for i in members], label=panels[0].quantity.label
                if look.separate_scales else scale.label,
                ticks=scale.ticks(), format=lambda value, _: brief(value), extend=scale.extend,
                spacing="proportional", aspect=28, pad=0.02,
            )  # fmt: skip
            bar.ax.minorticks_off()
            scales.append(scale)
    with_vectors = vectors_of(section)
    if with_vectors:  # beside the same axes as the last bar: the layout cannot nest them otherwise
        add_vector_bar(figure, [axes[i] for i in members], with_vectors)
    for ax, panel in zip(axes, section.panels, strict=True):
        if panel.vectors:
            draw_vectors(ax, section, panel, look)
        parts.draw_outlines(ax, section, panel, look.outline)
        ax.set_aspect("equal")
        ax.set_xlim(section.across[0], section.across[-1])
        ax.set_ylim(section.up[0], section.up[-1])
    if look.scale_bar:
        parts.add_scale_bar(axes[0], np.ptp(section.across), section.scene.units)
    return scales


def vectors_of(section: Section) -> list:
    """The vectors of all panels that have some."""
    return [panel.vectors for panel in section.panels if panel.vectors]


def section_handles(section: Section, look: Look, scales) -> list:
    """The entries of a section's legend."""
    handles = []
    if not look.blank and any(panel.quantity.kind == "colors" for panel in section.panels):
        scene = section.scene
        handles += parts.material_handles(scene.materials, material_colors(scene))
    handles += parts.outline_handles(section.panels[0].outlines, look.outline)
    if vectors_of(section):
        handles += vector_handles(vectors_of(section), look)
    return handles + parts.line_handles(scales, section.scene.units)


def _check_something_shown(section: Section) -> None:
    """Where some panels have something to show, those that have not stay empty."""
    shown = any(np.isfinite(panel.shown).any() for panel in section.panels)
    if not shown and any(np.isfinite(panel.values).any() for panel in section.panels):
        part = " or ".join(sorted({panel.only for panel in section.panels}))
        fail(f"there is nothing to draw: in this window, nothing of the plane {section.plane.name} "
             f"lies {part} the solid")  # fmt: skip


def _grid(panels, columns: int | None) -> tuple[int, int]:
    """Rows and columns: a row for each quantity where there are several blends."""
    count = len(panels)
    blends = len({id(panel.quantity.scene) for panel in panels})
    if columns is None:
        columns = blends if 1 < blends < count else -(-count // -(-count // 4))
    columns = min(columns, count)
    return -(-count // columns), columns


def _size(section: Section, rows: int, columns: int) -> tuple[float, float]:
    """A size in inches that the panels fill, their bars and labels beside them."""
    aspect = np.ptp(section.up) / np.ptp(section.across)
    width = min({1: 5.5, 2: 4.4}.get(columns, 3.6), (WIDEST - 1.5) / columns)
    width = min(width, 5.5 / aspect)
    width = max(width, 1.6)
    bar = 0.9 if vectors_of(section) else 0
    return columns * (width + 0.15) + 1.7 + bar, rows * (width * aspect + 0.35) + 1.05


def _title(section: Section) -> str:
    return ", ".join(filter(None, (section.scene.title, section.plane.name)))


def _label(axes, columns: int, section: Section) -> None:
    units = section.scene.units
    for index, (ax, panel) in enumerate(zip(axes, section.panels, strict=True)):
        ax.set_title(panel.quantity.name)
        if index + columns >= len(axes):
            ax.set_xlabel(f"{section.plane.labels[0]} ({units})")
            ax.tick_params(labelbottom=True)
        if index % columns == 0:
            ax.set_ylabel(f"{section.plane.labels[1]} ({units})")
