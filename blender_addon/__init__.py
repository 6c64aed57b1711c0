# SPDX-License-Identifier: GPL-3.0-or-later
"""sardf for Blender: bake solids of graded materials from scene files.

The package holds no mathematics: the compiled module sardf makes mesh, textures, fractions and
camera as arrays, and the modules here turn them into Blender data. In the order of the data:

core         find and import the compiled module for this Python
baked        a scene file's or a part's scene -> object with textures and fractions
picture      camera, lights and render settings
headless commands    runs without a window: as a script, and as `blender -c sardf`
arguments sources outputs    their options, what they read, and how files get their names
properties operators panel    the user interface for scene files
bake_settings bake_plan bake_info bake_operator bake_panel    the bake of scene files and parts
piece_operator    the bake of the pieces that sections leave
window progress    what panels and operators, and long work, share
preferences  where POV-Ray is
parts        parts modelled from Blender objects
preview      parts shown in the viewport while they are made
reference    the scene rendered in POV-Ray, and compared with Cycles
"""

import importlib

bl_info = {
    "name": "sardf",
    "description": "Solids of graded materials from scene files: mesh, bake, render",
    "author": "sardf authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D Viewport > Sidebar > sardf",
    "category": "Object",
}


MODULES = (  # in the order in which Blender must know them
    "preferences",
    "bake_settings",
    "properties",
    "parts.part_properties",
    "parts.part_objects",
    "parts.part_wireframes",
    "parts.part_now",
    "parts.part_status",
    "bake_info",
    "bake_operator",
    "operators",
    "piece_operator",
    "parts.part_lists",
    "parts.part_operators",
    "parts.part_section_objects",
    "panel",
    "parts.part_panel",
    "parts.part_section_panel",
    "bake_panel",
    "commands",
    "preview.preview_settings",
    "preview.preview_panel",
    "preview.preview",
    "parts.part_preview",
    "reference.reference_properties",
    "reference.reference_operators",
    "reference.reference_panel",
)


def register():
    for name in MODULES:
        importlib.import_module(f".{name}", __package__).register()


def unregister():
    for name in reversed(MODULES):
        importlib.import_module(f".{name}", __package__).unregister()
