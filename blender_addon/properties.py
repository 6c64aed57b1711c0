# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel lets one choose, kept in the .blend, and what it tells about the scene file."""

from dataclasses import dataclass

import bpy

from . import bake_settings, core
from .baked import job


@dataclass
class Summary:
    """What the panel shows of a scene file; never stored in the .blend."""

    lines: tuple = ()
    error: str = ""


_summaries = {}  # absolute path -> Summary


def summary(settings):
    """The Summary of the chosen file, or None until it was read in this session."""
    return _summaries.get(absolute_path(settings))


def absolute_path(settings):
    return bpy.path.abspath(settings.filepath)


def read_summary(settings):
    """Load the chosen file and remember what it holds, or what is wrong with it."""
    path = absolute_path(settings)
    try:
        sardf = core.load()
    except core.MissingCore as error:
        _summaries[path] = Summary(error=str(error))
        return _summaries[path]
    try:
        scene = sardf.load(path)
    except sardf.Error as error:
        _summaries[path] = Summary(error=str(error))
    else:
        count = len(scene.materials)
        attributes = ", ".join(scene.attributes)
        _summaries[path] = Summary(
            lines=(
                scene.title or "untitled",
                f"{count} material{'' if count == 1 else 's'}: {', '.join(scene.materials)}",
                f"unit: {scene.units}; sections: {scene.section_count}",
                *([f"attributes: {attributes}"] if attributes else []),
            )
        )
    return _summaries[path]


def request(settings):
    """The job.Request that the settings ask for."""
    return job.Request(
        path=absolute_path(settings),
        resolution=settings.resolution,
        size=int(settings.size),
        sections=settings.sections,
        tangent=settings.tangent_attribute,
    )


def _filepath_changed(settings, _context):
    if settings.filepath:
        read_summary(settings)


class SardfSettings(bake_settings.BakeSettings, bpy.types.PropertyGroup):
    filepath: bpy.props.StringProperty(
        name="Scene File",
        description="The sardf scene file to mesh, bake and render",
        subtype="FILE_PATH",
        options=bake_settings.MAY_BE_RELATIVE,
        update=_filepath_changed,
    )
    sections: bpy.props.BoolProperty(
        name="Cut Open",
        description="Remove what the sections remove",
        default=True,
    )
    tangent_attribute: bpy.props.StringProperty(
        name="Brushed Along",
        description=(
            "The vector attribute of the scene file along which metal is brushed; if empty, "
            "grain_direction where the file has it"
        ),
    )
    set_units: bpy.props.BoolProperty(
        name="File's Unit",
        description="Set the Blender scene's unit to the unit of the scene file",
        default=True,
    )
    studio: bpy.props.BoolProperty(
        name="Studio",
        description="Render with our own camera, lights and world instead of the scene's",
        default=True,
    )
    samples: bpy.props.IntProperty(
        name="Samples",
        description="Cycles samples of each pixel",
        default=64,
        min=1,
        max=65536,
        soft_max=1024,
    )


def register():
    bpy.utils.register_class(SardfSettings)
    bpy.types.Scene.sardf = bpy.props.PointerProperty(type=SardfSettings)


def unregister():
    del bpy.types.Scene.sardf
    bpy.utils.unregister_class(SardfSettings)
