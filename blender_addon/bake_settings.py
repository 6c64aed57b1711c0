# SPDX-License-Identifier: GPL-3.0-or-later
"""How a bake is made: channels, UV map and destination, as the panel keeps them in the .blend."""

import bpy

from .baked import job

ATLAS, EXISTING, SMART = "ATLAS", "EXISTING", "SMART"
PACKED, FOLDER = "PACKED", "FOLDER"
# What a path needs so that Blender takes "//" without a warning; earlier ones do not know the word.
MAY_BE_RELATIVE = {"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (5, 0, 0) else set()
SIZES = ("256", "512", "1024", "2048", "4096", "8192")


def names_of(text):
    """The names in a list such as "base_color, normal"; each once."""
    return list(dict.fromkeys(filter(None, (name.strip() for name in text.split(",")))))


def text_of(names):
    return ", ".join(names)


def _is_mesh(_settings, item):
    return item.type == "MESH"


class BakeSettings:
    """Properties of SardfSettings, which inherits them."""

    resolution: bpy.props.IntProperty(
        name="Cells",
        description="Cells of the mesh along the part's longest side",
        default=128,
        min=4,
        max=4096,
        soft_max=512,
    )
    size: bpy.props.EnumProperty(
        name="Textures",
        description="Texels along a side of each baked texture",
        items=[(size, f"{size} px", f"{size} x {size} texels") for size in SIZES],
        default="2048",
    )
    channels: bpy.props.StringProperty(
        name="Channels",
        description="What is baked, as a list of names: those of the panel's buttons",
        default=text_of(job.CHANNELS),
    )
    uv_source: bpy.props.EnumProperty(
        name="UV Map",
        description="Where texture coordinates come from",
        items=[
            (ATLAS, "Own Atlas", "A new mesh, cut at its creases and laid flat without overlaps"),
            (
                EXISTING,
                "Existing",
                "The mesh and UV map of an object as they are: what was baked "
                "before, edited since, or another object of the part's shape",
            ),
            (SMART, "Smart UV Project", "A new mesh, laid flat by Blender's Smart UV Project"),
        ],
        default=ATLAS,
    )
    uv_object: bpy.props.PointerProperty(
        name="Object",
        description="The mesh whose UV map is baked on; empty: what was baked before",
        type=bpy.types.Object,
        poll=_is_mesh,
    )
    exact_shading: bpy.props.BoolProperty(
        name="Exact (OSL)",
        description=(
            "Also compute the materials exactly where a ray hits, by a shader in the Open Shading "
            "Language; a switch in the material goes back to the textures. Cycles on the CPU only"
        ),
        default=False,
    )
    destination: bpy.props.EnumProperty(
        name="Textures To",
        description="Where the baked textures are kept",
        items=[
            (PACKED, "This File", "Packed into the .blend"),
            (FOLDER, "Folder", "As OpenEXR files in a folder"),
        ],
        default=PACKED,
    )
    folder: bpy.props.StringProperty(
        name="Folder",
        description="Where the textures are written, as NAME_channel.exr",
        subtype="DIR_PATH",
        options=MAY_BE_RELATIVE,
        default="//textures",
    )
    replace_files: bpy.props.BoolProperty(
        name="Replace Files",
        description="Write over textures of the same names in the folder",
        default=False,
    )


class SARDF_OT_bake_channel(bpy.types.Operator):
    bl_idname = "sardf.bake_channel"
    bl_label = "Bake Channel"
    bl_options = {"UNDO", "INTERNAL"}

    channel: bpy.props.StringProperty(name="Channel", description="Its name in the scene")
    tip: bpy.props.StringProperty(name="Tip", description="What its values are")

    @classmethod
    def description(cls, _context, properties):
        return f"Bake {properties.channel}: {properties.tip}"

    def execute(self, context):
        settings = context.scene.sardf
        names = names_of(settings.channels)
        if self.channel in names:
            names.remove(self.channel)
        else:
            names.append(self.channel)
        settings.channels = text_of(names)
        return {"FINISHED"}


def register():
    bpy.utils.register_class(SARDF_OT_bake_channel)


def unregister():
    bpy.utils.unregister_class(SARDF_OT_bake_channel)
