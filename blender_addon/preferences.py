# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences."""

import bpy


class SardfPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    povray: bpy.props.StringProperty(
        name="POV-Ray",
        description="The program that renders references; if empty, the environment variable "
        "POVRAY, or povray where programs are looked for",
        subtype="FILE_PATH",
    )

    def draw(self, _context):
        self.layout.prop(self, "povray")


def povray():
    """The path of POV-Ray that the user stated, or ""."""
    addon = bpy.context.preferences.addons.get(__package__)
    stated = getattr(addon.preferences, "povray", "") if addon else ""
    return bpy.path.abspath(stated)


def register():
    bpy.utils.register_class(SardfPreferences)


def unregister():
    bpy.utils.unregister_class(SardfPreferences)
