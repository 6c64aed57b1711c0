# SPDX-License-Identifier: GPL-3.0-or-later
"""What a user does with the add-on, one step a process; run as: ... -- STEP RESULT.json FILE...

install ZIP          install and enable it, and save the preferences
use SCENE FOLDER     bake and render the scene file; write FOLDER/part.blend and FOLDER/part.png
reopen SCENE FOLDER  open that part.blend: are image, mesh and settings as they were, does it bake
RESULT.json gets what the step found.
"""

import hashlib
import importlib
import json
import re
import sys
import time
from pathlib import Path

import bpy
import numpy as np

EXTENSION, ADDON = "bl_ext.user_default.sardf_blender", "sardf_blender"
POINTS = np.array([[-8.0, 0, 0], [8.0, 0, 0]])  # of the scene's two features, exponent 2
COLORS = np.array([[0xC0, 0x30, 0x20], [0x8A, 0x8F, 0x98]]) / 255  # sRGB


def module():
    return EXTENSION if bpy.app.version >= (4, 2) else ADDON


def enabled():
    """Whether the add-on is enabled: by the preferences that `install` saved, or, where Blender is
    a module, which starts with factory settings, by hand."""
    if module() not in bpy.context.preferences.addons and not bpy.app.binary_path:
        bpy.ops.preferences.addon_enable(module=module())
    return module() in bpy.context.preferences.addons


def install(zip_file):
    if module() == EXTENSION:
        bpy.ops.extensions.package_install_files(
            filepath=zip_file, repo="user_default", enable_on_install=True, overwrite=True
        )
    else:
        bpy.ops.preferences.addon_install(overwrite=True, filepath=zip_file)
        bpy.ops.preferences.addon_enable(module=ADDON)
    bpy.ops.wm.save_userpref()
    return {"enabled": enabled()}


def mapped(pattern):
    """Paths of the shared libraries in this process whose names match."""
    lines = Path("/proc/self/maps").read_text().splitlines()
    paths = {line.split(maxsplit=5)[5] for line in lines if len(line.split(maxsplit=5)) == 6}
    return sorted(path for path in paths if re.search(pattern, Path(path).name))


def state():
    """Digests of what a bake made."""
    item = next(o for o in bpy.data.objects if o.get("sardf_source"))
    digests = {}
    for image in [i for i in bpy.data.images if i.get("sardf_source")]:
        values = np.empty(len(image.pixels), dtype=np.float32)
        image.pixels.foreach_get(values)
        digests[image.name] = hashlib.sha256(values.tobytes()).hexdigest()
    places = np.empty(3 * len(item.data.vertices), dtype=np.float32)
    item.data.vertices.foreach_get("co", places)
    digests[f"mesh {item.name}"] = hashlib.sha256(places.tobytes()).hexdigest()
    return digests


def color_error():
    """How far the texture at each corner of the mesh is from the scene's formula, linear light."""
    item = next(o for o in bpy.data.objects if o.get("sardf_source"))
    data = item.data
    uv = np.empty(2 * len(data.loops), dtype=np.float32)
    data.uv_layers[0].data.foreach_get("uv", uv)
    places = np.empty(3 * len(data.vertices), dtype=np.float32)
    data.vertices.foreach_get("co", places)
    corner = np.empty(len(data.loops), dtype=np.int32)
    data.loops.foreach_get("vertex_index", corner)
    point = places.reshape(-1, 3)[corner].astype(float)
    image = next(i for i in bpy.data.images if i.name.endswith("base_color"))
    width, height = image.size
    pixels = np.empty(len(image.pixels), dtype=np.float32)
    image.pixels.foreach_get(pixels)
    column, row = (uv.reshape(-1, 2) * (width, height)).astype(int).clip(0, width - 1).T
    found = pixels.reshape(height, width, -1)[row, column, :3]
    weight = np.stack([1 / ((point - at) ** 2).sum(axis=1) for at in POINTS], axis=-1)
    linear = np.where(COLORS <= 0.04045, COLORS / 12.92, ((COLORS + 0.055) / 1.055) ** 2.4)
    expected = weight / weight.sum(axis=1, keepdims=True) @ linear
    return float(np.abs(found - expected).max())


def use(scene_file, folder):
    result = {"enabled": enabled()}
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    settings = scene.sardf
    settings.filepath, settings.resolution, settings.size = scene_file, 48, "512"
    settings.samples = 4
    begun = time.monotonic()
    bpy.ops.sardf.bake()
    result["bake seconds"] = time.monotonic() - begun
    result["color error"] = color_error()
    scene.render.resolution_x, scene.render.resolution_y = 160, 120
    scene.render.resolution_percentage = 100
    begun = time.monotonic()
    bpy.ops.sardf.render()
    result["render seconds"] = time.monotonic() - begun
    picture = Path(folder, "part.png")
    bpy.data.images["Render Result"].save_render(str(picture))
    result["picture"] = picture.stat().st_size
    bpy.ops.wm.save_as_mainfile(filepath=str(Path(folder, "part.blend")))
    core = sys.modules["sardf"]
    result |= {"core": core.__file__, "state": state(), "tbb": mapped(r"tbb.*\.so")}
    result["openimageio of sardf"] = "sardf._image" in sys.modules
    return result


def reopen(scene_file, folder):
    result = {"enabled": enabled()}
    bpy.ops.wm.open_mainfile(filepath=str(Path(folder, "part.blend")))
    result["state"] = state()
    settings = bpy.context.scene.sardf
    result["settings"] = [settings.filepath == scene_file, settings.resolution, settings.size]
    bpy.ops.sardf.bake()
    result["baked again"] = state()
    return result


def about():
    sardf = importlib.import_module(f"{module()}.core") if enabled() else None
    tag = sardf.python_tag() if sardf else ""
    return {"version": bpy.app.version_string, "python": sys.version.split()[0], "tag": tag}


def main(step, result_file, *files):
    found = {"install": install, "use": use, "reopen": reopen}[step](*files)
    Path(result_file).write_text(json.dumps(about() | found))


main(*sys.argv[sys.argv.index("--") + 1 :])
