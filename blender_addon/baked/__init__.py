# SPDX-License-Identifier: GPL-3.0-or-later
"""From a scene to a baked object. In the order of the data:

store        where textures are written, so that they appear whole or not at all (no bpy)
channels     channels and attributes as arrays, and their files (no bpy)
job          scene -> mesh, textures and fractions (no bpy; runs in a worker thread)
clock        time left, and how times and sizes are said (no bpy)
measure      channels and cost before a bake (no bpy; in a thread of its own)
unwrap       texture coordinates by Blender's Smart UV Project
mesh_data    arrays -> mesh with UVs, custom normals, an attribute for each material and for each of
             the scene's attributes; and a mesh with UVs -> arrays
images       files -> float images with the right colour space, packed or not
groups exact material    images -> one Principled material of nodes in frames, with a shader in OSL
             where it is wanted; and the plain materials of the comparison looks
assemble     all of the above for one part
"""
