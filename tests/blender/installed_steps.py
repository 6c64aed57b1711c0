# SPDX-License-Identifier: GPL-3.0-or-later
"""What the installed add-on says and does; run as: ... -- RESULT.json STEP ARGUMENT...

refused ZIP SCENE        install a zip whose module is for another Python, and bake: what is said
commands ZIP WORDS_JSON  install, and run `blender -c sardf` with each list of words
"""

import contextlib
import importlib
import io
import json
import sys
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from installing import MODULE, install


def refused(zip_file, scene_file):
    try:
        install(zip_file)
    except RuntimeError as error:  # some Blenders do not even install it, and say why
        return {"by Blender": str(error)}
    if not hasattr(bpy.context.scene, "sardf"):
        return {"by Blender": "not enabled"}
    settings = bpy.context.scene.sardf
    settings.filepath = scene_file
    properties = importlib.import_module(f"{MODULE}.properties")
    try:
        bpy.ops.sardf.bake()
        said = ""
    except RuntimeError as error:
        said = str(error)
    return {"by the panel": properties.summary(settings).error, "by the operator": said}


def commands(zip_file, words_json):
    install(zip_file)
    module = importlib.import_module(f"{MODULE}.commands")
    runs = []
    for words in json.loads(words_json):
        output, errors = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
            code = module.run(words)
        runs.append([code, output.getvalue(), errors.getvalue()])
    return {"registered": len(module._registered), "enabled still": enabled(), "runs": runs}


def enabled():
    return MODULE in bpy.context.preferences.addons


def main(result_file, step, *arguments):
    result = {"refused": refused, "commands": commands}[step](*arguments)
    Path(result_file).write_text(json.dumps(result))


main(*sys.argv[sys.argv.index("--") + 1 :])
