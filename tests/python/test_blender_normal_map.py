"""Normal maps of coarse meshes in Blender 3.4.1 and bpy 5.0.1: by Blender's tangents, in Cycles."""

import numpy as np
import pytest
from blender_runs import HEADLESS, SCRIPTS, VERSIONS, run_script, write_scene

# Waves that a mesh of 5 cells knows nothing of.
BALL = {
    "sardf": 1,
    "title": "ball",
    "fields": {"ball": "=1 - sqrt(x^2 + y^2 + z^2) + 0.004*sin(25*x)"},
    "solid": "ball",
    "materials": {"clay": {"color": "#a0522d"}},
}
COARSE = ("--resolution", 5, "--size", 512, "--width", 16, "--height", 12, "--samples", 1)


def normalized(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def degrees_between(a, b):
    return np.degrees(np.arccos(np.clip((normalized(a) * normalized(b)).sum(axis=-1), -1, 1)))


def normals_of_ball(points):
    """-grad f, at the points of the surface in their directions from the middle: the waves are low
    enough for the radius to be 1."""
    directions = normalized(points)
    waves = np.zeros_like(directions)
    waves[..., 0] = 0.1 * np.cos(25 * directions[..., 0])
    return normalized(directions - waves)


@pytest.fixture(scope="module", params=VERSIONS)
def seen(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp(f"normals-{request.param}")
    run = {"user_folder": folder / "user"}
    words = (write_scene(folder, BALL), "-o", folder / "out", "--normal-map", *COARSE)
    done = run_script(request.param, HEADLESS, *words, **run)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (folder / "out/textures/normal.exr").is_file()
    script, blend, result = SCRIPTS / "normal_map.py", folder / "out/part.blend", folder / "n.npz"
    done = run_script(request.param, script, blend, result, **run)
    assert result.is_file(), done.stdout + done.stderr
    with np.load(result) as arrays:
        return dict(arrays)


def test_map_and_blenders_tangents_give_the_solids_normals(seen):
    """Blender's mesh.calc_tangents is MikkTSpace itself; the formula is that of a normal map."""
    assert str(seen["colorspace"]) == "Non-Color"
    assert len(seen["at"]) > 100
    error = degrees_between(seen["decoded"], normals_of_ball(seen["at"]))
    assert np.median(error) < 0.2
    assert np.percentile(error, 95) < 1


def test_cycles_shades_the_coarse_mesh_like_the_solid(seen):
    assert str(seen["linked"]) == "Normal"
    hit = np.linalg.norm(seen["positions"], axis=-1) > 0.5
    hit &= np.abs(seen["positions"]).max(axis=-1) < 1.5  # what is not on the part is black
    assert hit.sum() > 1500
    exact = normals_of_ball(seen["positions"][hit])
    bent = degrees_between(seen["normals"][hit], exact)
    smooth = degrees_between(seen["smooth"][hit], exact)
    print(f"normals off by {bent.mean():.3f}, without the map {smooth.mean():.3f} degrees")
    assert bent.mean() < 0.5
    assert bent.mean() < 0.2 * smooth.mean()
