# SPDX-License-Identifier: GPL-3.0-or-later
"""sardf for Blender: bake solids of graded materials from scene files.

The package holds no mathematics: the compiled module sardf makes mesh, textures, fractions and
camera as arrays, and the modules here turn them into Blender data. In the order of the data:

core         find and import the compiled module for this Python
job          scene file -> mesh, textures and fractions, as arrays (no bpy; runs in a worker thread)
mesh_data    arrays -> mesh with UVs, custom normals, an attribute for each material and for each of
             the scene's attributes
images       arrays -> float images with the right colour space, packed
material     images -> one Principled material, and the plain materials of the comparison looks
camera       the core's camera dictionary -> camera object
studio       soft lights and a neutral world around the object
render       Cycles settings of each look
assemble     all of the above for one part; used by the operators and by headless.py alike
headless commands    runs without a window: as a script, and as `blender -c sardf`
arguments sources outputs    their options, what they read, and how files get their names
properties operators panel    the user interface for scene files, and the bake

A part is modelled from objects (the modules part_*). In the order of its data:

part_properties   what the .blend keeps of parts, primitives, materials and features
words             what the core says about its words, for tooltips
primitives wireframes    the unit shapes: as fields under a matrix, and as edges
transforms part_frame    an object's matrix in the scene file's words, relative to its part
curves mesh_files part_fields    each kind of object as a field
part_materials part_features part_join part_scene    the lists and entries as one scene
scene_text        scene files as data, and how an imported one keeps its words
import_numbers import_shapes import_fractions part_import part_export    from and to files
part_bake         a part's scene through job and assemble, in animations too
part_objects part_lists part_presets part_operators part_status part_panel    the user interface

preview and preview_*    parts shown in the viewport while they are made: samples from the core in a
                         worker thread (preview_volume, no bpy), one shader, legend, probe;
                         part_preview says which parts there are
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
    "properties",
    "part_properties",
    "part_objects",
    "part_status",
    "operators",
    "part_lists",
    "part_operators",
    "panel",
    "part_panel",
    "commands",
    "preview_settings",
    "preview_panel",
    "preview",
    "part_preview",
)


def register():
    for name in MODULES:
        importlib.import_module(f".{name}", __package__).register()


def unregister():
    for name in reversed(MODULES):
        importlib.import_module(f".{name}", __package__).unregister()
