"""Iso-surfaces side by side, shaded."""

import numpy as np
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

from sardf.plot import parts
from sardf.plot.colors import encoded
from sardf.plot.look import Look
from sardf.plot.numbers import brief
from sardf.plot.quantities import Quantity, material_colors
from sardf.plot.scales import scale_of
from sardf.plot.surfaces import Surface, picture, surface_name, view_of

PANEL = 4.8  # inches
AMBIENT = 0.35


def draw_surfaces(surfaces: list[Surface], view=None, look: Look | None = None, **choices):
    """A matplotlib Figure with one shaded surface in each panel, seen from infinity.

    view: direction (3,) from the object towards the camera; None for the scene's.
    """
    look = look or Look(**choices)
    with parts.settings():
        scene = surfaces[0].scene
        rows, columns = _grid(len(surfaces), look.columns)
        figure = _figure(scene, rows, columns, look)
        towards = view_of(scene, view)
        axes = [
            figure.add_subplot(rows, columns, index + 1, projection="3d")
            for index in range(len(surfaces))
        ]
        for members in _groups(surfaces, look.separate_scales):
            scale = _scale([surfaces[i] for i in members], look)
            for i in members:
                _draw(axes[i], surfaces[i], towards, scale)
            if scale:
                figure.colorbar(
                    scale.mappable, ax=[axes[i] for i in members], label=scale.label,
                    ticks=scale.ticks(), format=lambda value, _: brief(value), shrink=0.6,
                    extend=scale.extend, pad=0.14,
                ).ax.minorticks_off()  # fmt: skip
        if any(surface.values is None for surface in surfaces):
            parts.add_legend(
                figure, parts.material_handles(scene.materials, material_colors(scene))
            )
        return figure


def draw_pictures(
    chosen: list[Quantity], level=0.0, view=None, look=None, dpi=150, progress=None, **choices
):
    """A matplotlib Figure with POV-Ray's picture of each field's surface, `dpi` pixels per inch."""
    look = look or Look(**choices)
    with parts.settings():
        scene = chosen[0].scene
        rows, columns = _grid(len(chosen), look.columns)
        figure = _figure(scene, rows, columns, look)
        axes = figure.subplots(rows, columns, squeeze=False)
        width = round(PANEL * dpi)
        for ax in axes.flat:
            ax.set_axis_off()
        for ax, quantity in zip(axes.flat, chosen, strict=False):
            ax.imshow(picture(quantity, level, view, width, width * 3 // 4, progress))
            ax.set_title(surface_name(quantity, level))
        parts.add_legend(figure, parts.material_handles(scene.materials, material_colors(scene)))
        return figure


class _Coloured:
    """A surface's values in the shape that scales are made of."""

    def __init__(self, surface: Surface):
        self.quantity, self.shown = surface.quantity, surface.values


def _scale(surfaces, look: Look):
    if surfaces[0].values is None:
        return None
    return scale_of([_Coloured(surface) for surface in surfaces], look)


def _groups(surfaces, separate: bool) -> list[list[int]]:
    groups: dict[tuple, list[int]] = {}
    for index, surface in enumerate(surfaces):
        groups.setdefault((index,) if separate else surface.quantity.scale, []).append(index)
    return list(groups.values())


def _draw(ax, surface: Surface, towards, scale) -> None:
    corners = surface.vertices[surface.faces]
    lengths = np.linalg.norm(surface.normals, axis=1, keepdims=True)
    normals = surface.normals / np.where(lengths > 0, lengths, 1)  # corners' may cancel
    seen = normals @ towards > -0.1
    light = _light(towards)
    shade = AMBIENT + (1 - AMBIENT) * np.maximum(normals[seen] @ light, 0)
    if scale is None:
        colors = encoded(surface.colors[surface.faces[seen]].mean(axis=1) * shade[:, None])
    else:
        values = scale.snapped(surface.values[surface.faces[seen]].mean(axis=1))
        colors = scale.cmap(scale.norm(values))[:, :3] * shade[:, None] ** 0.6
    ax.add_collection3d(
        Poly3DCollection(
            corners[seen], facecolors=colors, edgecolors=colors, linewidths=0.5, rasterized=True
        )
    )
    low, high = surface.vertices.min(axis=0), surface.vertices.max(axis=0)
    middle, half = (low + high) / 2, np.maximum((high - low) / 2, 1e-3 * np.ptp([low, high]))
    ax.set(**{f"{a}lim": (m - h, m + h) for a, m, h in zip("xyz", middle, half, strict=True)})
    ax.set_box_aspect(half, zoom=0.9)  # room for labels
    ax.set_proj_type("ortho")
    azimuth = np.degrees(np.arctan2(towards[1], towards[0]))
    ax.view_init(elev=np.degrees(np.arcsin(np.clip(towards[2], -1, 1))), azim=azimuth)
    units = surface.scene.units
    ax.set(xlabel=f"x ({units})", ylabel=f"y ({units})", zlabel=f"z ({units})", title=surface.name)
    for axis, share in zip("xyz", half / half.max(), strict=True):
        ax.locator_params(axis, nbins=max(2, round(6 * share)))
    for axis in (ax.xaxis, ax.yaxis, ax.zaxis):
        axis.set_pane_color((0.97, 0.97, 0.97, 1))


def _light(towards) -> np.ndarray:
    """Over the viewer's left shoulder."""
    right = np.cross((0, 0, 1), towards) if abs(towards[2]) < 0.999 else np.array([1.0, 0, 0])
    right /= np.linalg.norm(right)
    light = towards + 0.6 * np.cross(towards, right) - 0.4 * right
    return light / np.linalg.norm(light)


def _grid(count: int, columns: int | None) -> tuple[int, int]:
    columns = min(columns or 3, count)
    return -(-count // columns), columns


def _figure(scene, rows: int, columns: int, look: Look):
    size = look.size or (columns * PANEL + 0.6, rows * PANEL + 0.8)
    return parts.new_figure(size, scene.title if look.title is None else look.title)
