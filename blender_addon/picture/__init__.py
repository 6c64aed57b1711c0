# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture of a baked object needs besides it.

camera       the core's camera dictionary -> camera object
studio       soft lights and a neutral world around the object
render       Cycles settings of each look
"""
