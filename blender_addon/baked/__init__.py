# SPDX-License-Identifier: GPL-3.0-or-later
"""From a scene to a baked object. In the order of the data:

store        where textures are written, so that they appear whole or not at all (no bpy)
channels     channels and attributes as arrays, and their files (no bpy)
job channels    scene -> mesh, textures and fractions, as arrays (no bpy; runs in a worker thread)
store        where textures are written, so that they appear whole or not at all (no bpy)
measure clock    what a bake will cost, and how long it goes on (no bpy)
unwrap       texture coordinates by Blender's Smart UV Project
mesh_data    arrays -> mesh with UVs, custom normals, an attribute for each material and for each of
             the scene's attributes
images       written textures -> images with the right colour space, packed or not
groups       nodes of a material in framed groups
exact        the materials computed where a ray hits, by a shader in the Open Shading Language
material     images -> one Principled material, and the plain materials of the comparison looks
assemble     all of the above for one part
"""
