# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blender scene rendered in POV-Ray from the exact fields, and compared with Cycles. In the
order of the data:

lights       a light object -> the core's description, and what of it is not carried over
stage        camera, lights, world and parts of a scene -> the core's stage
work         parts without a bake -> arrays, stage -> POV-Ray's pictures; in a thread, no bpy
cycles       baked objects rendered in a scene of their own
pictures     pictures as images: kept, shown, read back
compare      all of the above without a window; what the operator does step by step
reference_properties reference_operators reference_panel    settings, results, buttons
"""
