# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs one of the part_* checks with the add-on of a checkout:
... -- ADDON_FOLDER RESULT.json CHECK [ARGUMENT ...]

CHECK is a module beside this file; its main(*arguments) returns what is written as the result.
"""

import importlib
import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
import addon_folder


def run(folder, result_file, check, *arguments):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon_folder.load(folder)
    result = importlib.import_module(check).main(*arguments)
    Path(result_file).write_text(json.dumps(result))


run(*sys.argv[sys.argv.index("--") + 1 :])
