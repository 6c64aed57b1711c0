# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts shown in the viewport while they are made. In the order of the data:

preview_volume     a scene -> samples from the core, as arrays (no bpy)
preview_sampler    the worker thread that makes them, coarse first
preview            which parts there are, what changed, when to draw again
preview_shader preview_draw    one shader marches the samples of every part
preview_stand_in   a coarse mesh where no shader is available
preview_reading preview_probe preview_legend    what is under the cursor; swatches and scale bar
preview_settings preview_panel    the user interface
"""
