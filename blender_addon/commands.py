# SPDX-License-Identifier: GPL-3.0-or-later
"""`blender -c sardf bake|render|export|reference`, in Blender 4.2 and later, with us enabled.

    blender -c sardf render scenes/lined_bore.json -o OUT
    blender part.blend -c sardf export -o part.json        (the part of the opened file)

The work is that of headless.py, whose options and exit codes these are.
"""

import bpy

NAME = "sardf"
USAGE = """usage: blender [FILE.blend] -c sardf bake|render|export|reference [SCENE] -o OUT ...

  bake       a folder with part.blend and its textures
  render     the same, and pictures
  export     a scene file (.json), or a scene for POV-Ray (.pov)
  reference  a .blend's parts in POV-Ray, by its camera and lights, and the difference to Cycles

SCENE is a scene file or a .blend with a part; without it, the opened file's part is taken.
blender -c sardf bake --help tells the options.
"""
_registered = []  # the handle of the command, where Blender has commands


def run(words):
    """Run with the words after `-c sardf`; returns the exit code."""
    from . import arguments, headless

    if not words or words[0] in ("-h", "--help"):
        print(USAGE)
        return arguments.DONE if words else arguments.WRONG_INPUT
    return headless.main(list(words[1:]), command=words[0])


def register():
    if hasattr(bpy.utils, "register_cli_command"):  # since Blender 4.2
        _registered.append(bpy.utils.register_cli_command(NAME, run))


def unregister():
    while _registered:
        bpy.utils.unregister_cli_command(_registered.pop())
