# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs one of the part_* checks with the add-on of a checkout: ... -- ADDON_FOLDER RESULT.json CHECK
[ARGUMENT ...]

CHECK is a module beside this file; its main(*arguments) returns what is written as the result.
"""

import importlib
import importlib.util
import json
import sys
from pathlib import Path

import bpy


def load_addon(folder):
    spec = importlib.util.spec_from_file_location(
        "sardf_blender", Path(folder) / "__init__.py", submodule_search_locations=[folder]
    )
    sys.modules["sardf_blender"] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules["sardf_blender"])
    sys.modules["sardf_blender"].register()


def run(folder, result_file, check, *arguments):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    load_addon(folder)
    sys.path.insert(0, str(Path(__file__).resolve().parent))
    result = importlib.import_module(check).main(*arguments)
    Path(result_file).write_text(json.dumps(result))


run(*sys.argv[sys.argv.index("--") + 1 :])
