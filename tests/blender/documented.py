# SPDX-License-Identifier: GPL-3.0-or-later
"""The examples of docs/blender.md, in the folder where they leave their files."""

import os
import runpy

import bpy
from sardf_blender import commands


def main(what, folder, *arguments):
    os.chdir(folder)
    return {"script": script, "command": command}[what](*arguments)


def script(path):
    """What the script made, as it stands in its last frame."""
    names = runpy.run_path(path)
    scene, settings = names["scene"], names["settings"]
    baked = settings.baked
    return {
        "frame": scene.frame_current,
        "corners": [list(vertex.co) for vertex in baked.data.vertices],
        "images": sorted(image.name for image in bpy.data.images if image.size[0]),
        "pieces": [item.name for item in names["part"].children if " piece " in item.name],
        "roughness": settings.materials["lining"].roughness,
        "outline": scene.sardf_reference.intersection_over_union,
        "median": scene.sardf_reference.median,
    }


def command(*words):
    """The exit code of `blender -c sardf WORDS`."""
    return commands.run(list(words))
