# SPDX-License-Identifier: GPL-3.0-or-later
"""From a scene to a baked object. In the order of the data:

job          scene -> mesh, textures and fractions, as arrays (no bpy; runs in a worker thread)
mesh_data    arrays -> mesh with UVs, custom normals, an attribute for each material and for each of
             the scene's attributes
images       arrays -> float images with the right colour space, packed
material     images -> one Principled material, and the plain materials of the comparison looks
assemble     all of the above for one part
"""
