# SPDX-License-Identifier: GPL-3.0-or-later
"""The legend over the viewport: what the colours mean, and how large things are."""

import blf
import gpu
from bpy_extras.view3d_utils import location_3d_to_region_2d
from gpu_extras.batch import batch_for_shader
from mathutils import Vector

from . import preview_shader

LEFT, BOTTOM = 70, 24  # pixels from the region's corner: the toolbar is to the left
LINE, SWATCH, BAR, TEXT = 20, 13, 160, 11
INK = (0.92, 0.92, 0.92, 1.0)
MOST = 12  # materials that are listed
SHADERS = (("SMOOTH_COLOR", 3), ("2D_SMOOTH_COLOR", 2))  # Blender 4.0 and later, and before


class Sheet:
    """Rectangles and texts of one drawing, in pixels of the region."""

    def __init__(self, scale):
        self.scale = scale
        self._points, self._colors, self._texts = [], [], []

    def rectangle(self, x, y, width, height, color):
        x0, y0, x1, y1 = x, y, x + width, y + height
        self._points += [(x0, y0), (x1, y0), (x1, y1), (x0, y0), (x1, y1), (x0, y1)]
        self._colors += [color] * 6

    def text(self, x, y, words, color=INK):
        self._texts.append((x, y, words, color))

    def draw(self):
        if self._points:
            shader, dimensions = smooth_shader()
            points = [(*point, 0.0)[:dimensions] for point in self._points]
            batch = batch_for_shader(shader, "TRIS", {"pos": points, "color": self._colors})
            gpu.state.blend_set("ALPHA")
            shader.bind()
            batch.draw(shader)
            gpu.state.blend_set("NONE")
        set_size(TEXT * self.scale)
        blf.enable(0, blf.SHADOW)
        blf.shadow(0, 3, 0.0, 0.0, 0.0, 0.8)
        for x, y, words, color in self._texts:
            blf.color(0, *color)
            blf.position(0, x, y, 0)
            blf.draw(0, words)
        blf.disable(0, blf.SHADOW)


def smooth_shader():
    """(Blender's own shader of coloured triangles, how many coordinates its points have)."""
    for name, dimensions in SHADERS:
        try:
            return gpu.shader.from_builtin(name), dimensions
        except (ValueError, SystemError):
            continue
    raise RuntimeError("Blender has no shader SMOOTH_COLOR")


def width(words, scale):
    """How wide a text is drawn, in pixels."""
    set_size(TEXT * scale)
    return blf.dimensions(0, words)[0]


def set_size(points):
    try:
        blf.size(0, points)
    except TypeError:  # until Blender 3.6 it wants dots per inch
        blf.size(0, int(points), 72)


def srgb(color):
    """A linear colour as the screen has it."""
    return tuple(
        12.92 * c if c <= 0.0031308 else 1.055 * min(max(c, 0.0), 1.0) ** (1 / 2.4) - 0.055
        for c in color
    )


def draw(context, settings, preview):
    """Legend, scale bar, and what is wrong with the parts."""
    scale = context.preferences.system.ui_scale
    sheet = Sheet(scale)
    parts = [part for part in preview.parts.values() if part.scene is not None]
    y = BOTTOM * scale
    if settings.legend and parts:
        y = _add_scale_bar(sheet, context, parts[0], y)
        number = next((part for part in parts if part.range), None)
        if number is not None:
            y = _add_color_bar(sheet, settings, number, y)
        else:
            y = _add_swatches(sheet, parts, y)
    for message in messages(preview):
        sheet.text(LEFT * scale, y, message, (1.0, 0.45, 0.35, 1.0))
        y += LINE * scale
    sheet.draw()


def messages(preview):
    """What is wrong, or else what there is to say, one line each."""
    found = [preview.error] if preview.error else []
    for part in preview.parts.values():
        found += (part.error or part.note).splitlines()[:3]
    return found


def is_wrong(preview):
    """Whether anything is wrong, so that what is seen is not what there is."""
    return bool(preview.error) or any(part.error for part in preview.parts.values())


def _add_swatches(sheet, parts, y):
    colors = {}
    for part in parts:
        colors |= part.scene.material_colors
    s = sheet.scale
    names = list(colors)
    if len(names) > MOST:
        sheet.text(LEFT * s, y, f"and {len(names) - MOST} more")
        y += LINE * s
    for name in reversed(names[:MOST]):
        sheet.rectangle(LEFT * s, y - 2 * s, SWATCH * s, SWATCH * s, (*srgb(colors[name]), 1.0))
        sheet.text((LEFT + SWATCH + 8) * s, y, name)
        y += LINE * s
    return y


def _add_color_bar(sheet, settings, part, y):
    s = sheet.scale
    low, high = part.range
    steps = preview_shader.BANDS if settings.stripes else 64
    width = BAR * s / steps
    for i in range(steps):
        color = (*preview_shader.map_color((i + 0.5) / steps), 1.0)
        sheet.rectangle(LEFT * s + i * width, y + 14 * s, width, SWATCH * s, color)
    sheet.text(LEFT * s, y, f"{low:.4g}")
    sheet.text((LEFT + BAR) * s, y, f"{high:.4g}")
    sheet.text(LEFT * s, y + 32 * s, settings.show)
    return y + 54 * s


def _add_scale_bar(sheet, context, part, y):
    pixels = pixels_per_unit(context, part)
    if not pixels:
        return y
    s = sheet.scale
    length = nice_length(BAR * s / pixels)
    width = length * pixels
    sheet.rectangle(LEFT * s, y, width, 2 * s, INK)
    for end in (LEFT * s, LEFT * s + width - 2 * s):
        sheet.rectangle(end, y - 4 * s, 2 * s, 10 * s, INK)
    sheet.text(LEFT * s + width + 8 * s, y - 4 * s, f"{length:g} {part.scene.units}")
    return y + LINE * s


def pixels_per_unit(context, part):
    """How long one of the part's units looks in the middle of the part, across the view; or 0."""
    lo, hi = part.scene.bounds
    center = part.matrix @ Vector([(a + b) / 2 for a, b in zip(lo, hi, strict=True)])
    view = context.region_data
    across = view.view_rotation @ Vector((part.matrix.median_scale, 0, 0))
    ends = [location_3d_to_region_2d(context.region, view, p) for p in (center, center + across)]
    length = 0.0 if None in ends else (ends[1] - ends[0]).length
    return length if 1e-6 < length < 1e6 else 0.0


def nice_length(most):
    """The largest of 1, 2 and 5 times a power of ten that is not more."""
    power = 1.0
    while power > most:
        power /= 10
    while 10 * power <= most:
        power *= 10
    return next(m * power for m in (5, 2, 1) if m * power <= most)
