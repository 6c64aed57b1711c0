# SPDX-License-Identifier: GPL-3.0-or-later
"""What has no tooltip; run by part_run.py."""

import bpy

KINDS = ("PropertyGroup", "Operator", "AddonPreferences")


def ours():
    """The add-on's registered classes with properties or a button of their own."""
    known = [cls for kind in KINDS for cls in getattr(bpy.types, kind).__subclasses__()]
    return [cls for cls in known if "sardf_blender" in cls.__module__ and cls.is_registered]


def main():
    properties, missing = {}, []
    for cls in ours():
        rna = cls.bl_rna
        if issubclass(cls, bpy.types.Operator):
            rna = getattr(bpy.ops.sardf, cls.bl_idname.removeprefix("sardf.")).get_rna_type()
            missing += [] if rna.description else [cls.bl_idname]
        for name in {word for base in cls.__mro__ for word in getattr(base, "__annotations__", ())}:
            if name in rna.properties and not rna.properties[name].is_hidden:
                properties[f"{cls.__name__}.{name}"] = rna.properties[name].description
    missing += [name for name, text in properties.items() if not text]
    return {"properties": properties, "missing": sorted(missing)}
