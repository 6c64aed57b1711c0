"""Parts of figures: a panel's colours, lines and outlines, scale bars, legends, the frame."""

import contextlib
import textwrap

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar

from sardf.plot.colors import APART, DASHES, encoded
from sardf.plot.numbers import brief
from sardf.plot.scales import DARKER, Scale

# Independent of the reader's own matplotlib settings; text stays text, identifiers stay the same.
SETTINGS = {
    "font.size": 9,
    "axes.titlesize": 9.5,
    "axes.labelsize": 9,
    "figure.titlesize": 11,
    "legend.fontsize": 8.5,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "svg.hashsalt": "sardf",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}


@contextlib.contextmanager
def settings():
    """The settings under which every figure is made and saved."""
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(SETTINGS)
        yield


def new_figure(size, title: str) -> Figure:
    figure = Figure(figsize=size, layout="compressed")
    figure.get_layout_engine().set(w_pad=0.06, h_pad=0.06)
    if title:
        figure.suptitle(textwrap.fill(title, int(11 * size[0])))
    return figure


def region(axes, section, solid, only: str):
    """The path, in data coordinates, of what is shown: None for everything."""
    if only == "everywhere":
        return None
    finite = solid[np.isfinite(solid)]
    low, high = (finite.min(), finite.max()) if finite.size else (0, 0)
    levels = [0, max(high, 0) + 1] if only == "inside" else [min(low, 0) - 1, 0]
    filled = axes.contourf(section.across, section.up, solid, levels=levels)
    path = filled.get_paths()[0]
    filled.remove()
    return path


def draw_values(axes, section, panel, scale: Scale, label_lines: bool) -> None:
    """Filled bands or smooth colours, and contour lines."""
    grid = section.across, section.up
    clip = region(axes, section, panel.solid, panel.only)
    values = scale.snapped(panel.values)
    if scale.edges is None:
        filled = _image(axes, section, values, cmap=scale.cmap, norm=scale.norm)
    else:
        filled = axes.contourf(
            *grid, values, levels=scale.edges, cmap=scale.cmap, norm=scale.norm,
            extend=scale.extend,
        )  # fmt: skip
    drawn = [filled]
    low, high = np.nanmin(values), np.nanmax(values)
    levels = scale.lines[(scale.lines >= low) & (scale.lines < high)]
    if len(levels):
        lines = axes.contour(
            *grid, values, levels=levels, colors="black", linewidths=0.5, alpha=0.65,
            linestyles="solid",
        )  # fmt: skip
        drawn.append(lines)
        if label_lines:
            for label in axes.clabel(lines, fmt=brief, fontsize=7):
                label.set_visible(_is_shown(section, panel, *label.get_position()))
    for artist in drawn:
        if clip is not None:
            artist.set_clip_path(clip, axes.transData)


def _is_shown(section, panel, across, up) -> bool:
    column = np.abs(section.across - across).argmin()
    return bool(np.isfinite(panel.shown[np.abs(section.up - up).argmin(), column]))


def draw_colors(axes, section, panel, stripes: int) -> None:
    """Mixed base colours, every second stripe of the first fraction darkened."""
    colors = encoded(np.nan_to_num(panel.values))
    drawn = [_image(axes, section, colors)]
    if stripes:
        light, dark = (0, 0, 0, 0), (0, 0, 0, 1 - DARKER)
        drawn.append(
            axes.contourf(
                section.across, section.up, np.clip(panel.stripes, 0, 1),
                levels=np.linspace(0, 1, stripes + 1),
                colors=[dark if band % 2 else light for band in range(stripes)],
            )
        )  # fmt: skip
    clip = region(axes, section, panel.solid, panel.only)
    for artist in drawn:
        if clip is not None:
            artist.set_clip_path(clip, axes.transData)


def _image(axes, section, values, **colors):
    half_across = (section.across[1] - section.across[0]) / 2
    half_up = (section.up[1] - section.up[0]) / 2
    extent = (
        section.across[0] - half_across, section.across[-1] + half_across,
        section.up[0] - half_up, section.up[-1] + half_up,
    )  # fmt: skip
    return axes.imshow(values, origin="lower", extent=extent, interpolation="bilinear", **colors)


def draw_outlines(axes, section, panel, outline: bool) -> None:
    """The zero levels of the solid, in black, and of the named fields."""
    curves = [(panel.solid, "black", "solid", 1.6)] if outline else []
    for index, field in enumerate(panel.outlines.values()):
        color, dashes = _outline_style(index)
        curves.append((field, color, dashes, 1.8))
    for field, color, dashes, width in curves:
        if np.nanmin(field) < 0 <= np.nanmax(field):
            curve = axes.contour(
                section.across, section.up, field, levels=[0], colors=[color], linewidths=width,
                linestyles=[dashes],
            )  # fmt: skip
            if color != "black":  # apart from what it crosses
                curve.set_path_effects([withStroke(linewidth=width + 1.4, foreground="white")])


def _outline_style(index: int):
    """Colour and dashes of the outline of a named field: where it runs along the solid's, black
    shows through."""
    return APART[index % len(APART)], DASHES[1 + index % (len(DASHES) - 1)]


def outline_handles(names, outline: bool) -> list:
    handles = [Line2D([], [], color="black", lw=1.6, label="outline of the solid")]
    for index, name in enumerate(names):
        color, dashes = _outline_style(index)
        handles.append(Line2D([], [], color=color, ls=dashes, lw=1.8, label=f"outline of {name}"))
    return handles if outline else handles[1:]


def line_handles(scales, units: str) -> list:
    """What the contour lines mean, where one sentence can say it."""
    with_lines = [scale for scale in scales if len(scale.lines)]
    if not with_lines:
        return []
    text = "contour lines"
    steps = {tuple(np.unique(np.diff(scale.lines).round(9))) for scale in with_lines}
    if len(with_lines) == 1 and len(steps) == 1 and len(next(iter(steps))) == 1:
        unit = f" {units}" if with_lines[0].label.endswith(f"({units})") else ""
        text = f"contour lines every {brief(next(iter(steps))[0])}{unit}"
    return [Line2D([], [], color="black", lw=0.5, alpha=0.65, label=text)]


def material_handles(names, colors) -> list:
    return [
        Patch(facecolor=encoded(color), edgecolor="black", linewidth=0.5, label=name)
        for name, color in zip(names, colors, strict=True)
    ]


def add_legend(figure, handles) -> None:
    if handles:
        figure.legend(
            handles=handles, loc="outside lower center", ncols=min(len(handles), 4), frameon=False
        )


def add_scale_bar(axes, width: float, units: str) -> None:
    """A bar of 1, 2 or 5 times a power of ten, about a fifth of the window's width."""
    power = 10.0 ** np.floor(np.log10(width / 5))
    length = max(f * power for f in (1, 2, 5) if f * power <= width / 5 * 1.0001)
    bar = AnchoredSizeBar(
        axes.transData, length, f"{brief(length)} {units}", "lower right", pad=0.35, sep=3,
        borderpad=0.5, size_vertical=0, frameon=True, fill_bar=False, color="black",
    )  # fmt: skip
    bar.patch.set(alpha=0.8, linewidth=0)
    bar.set_zorder(6)
    axes.add_artist(bar)
