# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts modelled from Blender objects. In the order of the data:

part_properties   what the .blend keeps of parts, primitives, materials and features
words             what the core says about its words, for tooltips
primitives wireframes part_wireframes    the unit shapes: as fields under a matrix, and as edges
                  that follow animated properties
transforms part_frame    an object's matrix in the scene file's words, relative to its part
curves mesh_files part_fields    each kind of object as a field
part_materials part_features part_sections part_join part_scene    the lists as one scene
part_now          each part read once after a change, for all who ask
scene_text part_text    scene files as data, texts of fields; how an imported one keeps its words
import_numbers import_shapes import_fractions part_import part_export    from and to files
part_bake part_pieces    a part's scene baked, in animations too, and the pieces of its sections
part_preview      which parts the preview shows
part_objects part_lists part_presets part_operators part_section_objects reporting part_status
part_panel part_section_panel    the user interface
"""
