# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel "Reference" lets one choose, and the numbers of the last comparison."""

import bpy

LOOKS = (
    ("flat", "Flat", "The base colours alone, without light"),
    ("shaded", "Shaded", "Matte surfaces of the base colours under the scene's lights"),
)


class SardfReference(bpy.types.PropertyGroup):
    look: bpy.props.EnumProperty(
        name="Look", description="What both programs render", items=LOOKS, default="flat"
    )
    compare: bpy.props.BoolProperty(
        name="Compare with Cycles",
        description="Render the baked objects in Cycles, too, and show the difference. What is not "
        "baked yet is baked",
        default=True,
    )
    keep_cycles: bpy.props.BoolProperty(
        name="Keep Cycles' Picture",
        description="Compare with the image 'sardf cycles' of the last comparison, where it has "
        "this look and size, instead of rendering it again",
        default=False,
    )
    samples: bpy.props.IntProperty(
        name="Cycles Samples",
        description="Samples of each pixel of the shaded look in Cycles",
        default=64,
        min=1,
        max=65536,
        soft_max=1024,
    )
    light_samples: bpy.props.IntProperty(
        name="Light Samples",
        description="Samples in POV-Ray along each side of an area light, and of soft shadows",
        default=4,
        min=1,
        max=16,
    )
    compared: bpy.props.StringProperty(
        name="Compared", description="The look of the last comparison; empty before the first"
    )
    intersection_over_union: bpy.props.FloatProperty(
        name="Mask IoU",
        description="Pixels in both outlines over pixels in either",
        precision=5,
        min=0.0,
        max=1.0,
    )
    median: bpy.props.FloatProperty(
        name="Median",
        description="What half of the compared pixels differ by at most, in /255, linear",
        min=0.0,
    )
    quantile_99: bpy.props.FloatProperty(
        name="99 %",
        description="What 99 % of the compared pixels differ by at most, in /255, linear",
        min=0.0,
    )
    compared_pixels: bpy.props.IntProperty(
        name="Pixels",
        description="Compared pixels: those away from outlines and steep changes of colour",
        min=0,
    )
    warnings: bpy.props.StringProperty(
        name="Not Carried Over",
        description="What of the scene the last reference does not show, one in a line",
    )


def register():
    bpy.utils.register_class(SardfReference)
    bpy.types.Scene.sardf_reference = bpy.props.PointerProperty(type=SardfReference)


def unregister():
    del bpy.types.Scene.sardf_reference
    bpy.utils.unregister_class(SardfReference)
