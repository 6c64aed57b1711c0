# SPDX-License-Identifier: GPL-3.0-or-later
"""Installing the add-on's zip as a user would: in Blender 4.2 and later as an extension."""

import sys
from pathlib import Path

import bpy

IS_EXTENSION = bpy.app.version >= (4, 2)
MODULE = "bl_ext.user_default.sardf_blender" if IS_EXTENSION else "sardf_blender"


def install(zip_file):
    if not IS_EXTENSION:
        bpy.ops.preferences.addon_install(overwrite=True, filepath=zip_file)
        bpy.ops.preferences.addon_enable(module=MODULE)
        return
    # The environment of the bpy module has a sardf of its own; the zip's wheel is what we test.
    python = f"python{sys.version_info.major}.{sys.version_info.minor}"
    local = Path(bpy.utils.user_resource("EXTENSIONS")) / ".local/lib" / python / "site-packages"
    local.mkdir(parents=True, exist_ok=True)  # what is not there when it is added is never searched
    sys.path.insert(0, str(local))
    bpy.ops.extensions.package_install_files(
        filepath=zip_file, repo="user_default", enable_on_install=True, overwrite=True
    )
