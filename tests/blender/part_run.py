# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs a zip of the add-on and runs one of the checks beside this file with it:
... -- ZIP RESULT.json CHECK [ARGUMENT ...]

CHECK is a module beside this file; its main(*arguments) returns what is written as the result.
"""

import importlib
import json
import pkgutil
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from installing import MODULE, install

NAME = "sardf_blender"


def known_by_its_name():
    """The checks import sardf_blender, which is what the older Blenders call the add-on: give its
    modules that name, too, where it is an extension."""
    addon = importlib.import_module(MODULE)
    for found in pkgutil.walk_packages(addon.__path__, f"{MODULE}."):
        if not found.name.startswith(f"{MODULE}.vendor"):
            importlib.import_module(found.name)
    for name in [name for name in sys.modules if name == MODULE or name.startswith(f"{MODULE}.")]:
        sys.modules[NAME + name.removeprefix(MODULE)] = sys.modules[name]


def run(zip_file, result_file, check, *arguments):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    install(zip_file)
    known_by_its_name()
    result = importlib.import_module(check).main(*arguments)
    Path(result_file).write_text(json.dumps(result))


run(*sys.argv[sys.argv.index("--") + 1 :])
