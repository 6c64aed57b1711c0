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
properties operators panel    the user interface
preview and preview_*         parts shown in the viewport while they are made: samples from the core
                              in a worker thread (preview_volume, no bpy), one shader, legend, probe
"""

bl_info = {
    "name": "sardf",
    "description": "Solids of graded materials from scene files: mesh, bake, render",
    "author": "sardf authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D Viewport > Sidebar > sardf",
    "category": "Object",
}


def register():
    from . import operators, panel, preview, preview_panel, preview_settings, properties

    properties.register()
    operators.register()
    panel.register()
    preview_settings.register()
    preview_panel.register()
    preview.register()


def unregister():
    from . import operators, panel, preview, preview_panel, preview_settings, properties

    preview.unregister()
    preview_panel.unregister()
    preview_settings.unregister()
    panel.unregister()
    operators.unregister()
    properties.unregister()
