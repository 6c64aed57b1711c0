# SPDX-License-Identifier: GPL-3.0-or-later
"""What one chooses of the preview, kept in the .blend."""

import bpy

from . import preview, preview_volume
from .preview_volume import COLOR, FRACTION

QUALITIES = ("64", "96", "128", "192", "256")


def _shown_names(_settings, _context, text):
    names = [COLOR]
    for part in preview.CURRENT.parts.values():
        if part.scene is not None:
            names += [FRACTION + name for name in part.scene.materials]
            names += preview_volume.numbers_of(part.scene)
    return [name for name in dict.fromkeys(names) if text.lower() in name.lower()]


class SardfPreviewSettings(bpy.types.PropertyGroup):
    enabled: bpy.props.BoolProperty(
        name="Preview",
        description="Show the parts in the 3-D viewport while they are made",
        update=preview.settings_changed,
    )
    quality: bpy.props.EnumProperty(
        name="Quality",
        description="Samples along a part's longest side once nothing changes any more",
        items=[(n, n, f"{n} samples along the longest side") for n in QUALITIES],
        default="128",
        update=preview.settings_changed,
    )
    show: bpy.props.StringProperty(
        name="Show",
        description=(
            "What the surface shows: the materials' colours, the fraction of one material, or an "
            "attribute"
        ),
        default=COLOR,
        search=_shown_names,
        update=preview.settings_changed,
    )
    legend: bpy.props.BoolProperty(
        name="Legend",
        description="Show the materials' colours, the colour bar and a scale bar in the viewport",
        default=True,
        update=preview.settings_changed,
    )
    stripes: bpy.props.BoolProperty(
        name="Lines",
        description=(
            "Draw lines of equal distance from the surface on the cut, and the colour bar in bands"
        ),
        update=preview.settings_changed,
    )
    spacing: bpy.props.FloatProperty(
        name="Distance",
        description="Distance between two lines, in the part's units; 0 is a fiftieth of its size",
        default=0.0,
        min=0.0,
        update=preview.settings_changed,
    )


def register():
    bpy.utils.register_class(SardfPreviewSettings)
    bpy.types.Scene.sardf_preview = bpy.props.PointerProperty(type=SardfPreviewSettings)


def unregister():
    del bpy.types.Scene.sardf_preview
    bpy.utils.unregister_class(SardfPreviewSettings)
