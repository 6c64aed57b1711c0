"""headless.py in Blender 3.4.1 and with bpy 5.0.1: outputs, their values, and exit codes."""

import contextlib
import json
import shutil
import subprocess

import numpy as np
import pytest
from blender_runs import (
    BOX,
    GRADED_SPHERE,
    HEADLESS,
    RED,
    SCRIPTS,
    STEEL,
    VERSIONS,
    expected_colors,
    expected_fractions,
    linear,
    run_script,
    start_script,
    write_scene,
)

WIDTH, HEIGHT = 160, 120
SMALL = ("--resolution", 32, "--size", 256, "--width", WIDTH, "--height", HEIGHT, "--samples", 4)
TEXTURES = ("base_color", "emission", "fractions_1", "metallic", "roughness")
PICTURES = {"part.png", "flat.exr", "normals.exr"}
RADIUS = GRADED_SPHERE["fields"]["ball"]["sphere"]["radius"]


def headless(version, folder, *arguments, **keywords):
    return run_script(version, HEADLESS, *arguments, user_folder=folder / "user", **keywords)


def inspect(version, folder, output):
    """What inspect_blend.py reads from the outputs, as (arrays, facts)."""
    result = folder / "inspected.npz"
    done = run_script(
        version, SCRIPTS / "inspect_blend.py", output, result, user_folder=folder / "user"
    )
    assert result.is_file(), done.stdout + done.stderr
    with np.load(result) as arrays:
        values = dict(arrays)
    return values, json.loads(str(values.pop("facts")))


@pytest.fixture(scope="module", params=VERSIONS)
def sphere(request, tmp_path_factory):
    """The graded sphere with all looks: version, output folder, arrays, facts, camera."""
    folder = tmp_path_factory.mktemp(f"sphere-{request.param}")
    output = folder / "out"
    output.mkdir()
    (output / "notes.txt").write_text("the user's")
    (output / "part.png").write_text("of an earlier run")
    scene = write_scene(folder, GRADED_SPHERE)
    look = ("--look", "flat,normals,shaded")
    done = headless(request.param, folder, scene, "-o", output, *SMALL, *look)
    assert done.returncode == 0, done.stdout + done.stderr
    camera = json.loads((output / "camera.json").read_text())
    return request.param, output, *inspect(request.param, folder, output), camera


def seen_points(camera):
    """Exact points of the sphere behind the centre of each pixel, (H,W,3), NaN beside it."""
    matrix = np.array(camera["matrix_world"])
    columns, rows = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    scale = camera["sensor_width"] / camera["lens"] / WIDTH
    x, y = (columns - WIDTH / 2) * scale, (HEIGHT / 2 - rows) * scale
    rays = np.stack([x, y, -np.ones_like(x)], axis=-1) @ matrix[:3, :3].T
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    origin = matrix[:3, 3]
    along = -(rays @ origin)
    discriminant = along**2 - origin @ origin + RADIUS**2
    with np.errstate(invalid="ignore"):
        distance = along - np.sqrt(discriminant)
    return origin + rays * distance[..., None]


def test_everything_is_written_and_nothing_else_touched(sphere):
    _, output, _, _, _ = sphere
    found = {str(path.relative_to(output)) for path in output.rglob("*") if path.is_file()}
    textures = {f"textures/{name}.exr" for name in TEXTURES}
    assert found == PICTURES | textures | {"part.blend", "camera.json", "notes.txt"}
    assert (output / "notes.txt").read_text() == "the user's"
    assert not list(output.glob(".sardf-*"))


def test_blend_opens_with_units_camera_and_settings(sphere):
    _, _, _, facts, camera = sphere
    assert facts["object"] == "graded sphere"
    assert facts["unit"] == ["CENTIMETERS", pytest.approx(0.01)]
    assert facts["engine"] == "CYCLES"
    assert facts["device"] == "CPU"
    assert facts["denoise"] is False
    assert facts["dither"] == 0
    assert facts["view"] == "Standard"
    assert facts["materials"] == ["graded sphere"]
    for key in ("lens", "sensor_width", "sensor_fit"):
        assert facts["camera"][key] == pytest.approx(camera[key])
    used = np.array(facts["camera"]["matrix_world"])
    assert used == pytest.approx(np.array(camera["matrix_world"]), abs=1e-4)


def test_mesh_has_normals_uv_and_fractions(sphere):
    _, _, arrays, facts, _ = sphere
    vertices = arrays["vertices"].astype(float)
    assert np.abs(np.linalg.norm(vertices, axis=1) - RADIUS).max() < 0.02
    assert facts["custom normals"] is True
    assert set(np.unique(arrays["totals"])) <= {3, 4}
    assert len(arrays["uv"]) == arrays["totals"].sum()
    assert arrays["uv"].min() >= 0
    assert arrays["uv"].max() <= 1
    assert np.ptp(arrays["uv"], axis=0).min() > 0.5
    expected = expected_fractions(vertices)
    for column, material in enumerate(GRADED_SPHERE["materials"]):
        assert facts["attributes"][material] == ["FLOAT", "POINT"]
        assert np.abs(arrays[f"attribute {material}"] - expected[:, column]).max() < 1e-3


def test_images_have_the_right_colour_space_and_survive_reopening(sphere):
    version, _, arrays, facts, _ = sphere
    linear_name = "Linear" if version == "3.4.1" else "Linear Rec.709"
    emission_socket = "Emission" if version == "3.4.1" else "Emission Color"
    wanted = {
        "sardf base_color": ("Base Color", linear_name),
        "sardf roughness": ("Roughness", "Non-Color"),
        "sardf metallic": ("Metallic", "Non-Color"),
        "sardf emission": (emission_socket, linear_name),
        "sardf fractions_1": ("Color", "Non-Color"),  # split into masks
    }
    assert {n: (i["to"], i["colorspace"]) for n, i in facts["images"].items()} == wanted
    for name, image in facts["images"].items():
        assert image["packed"], name
        assert image["float"], name
        assert image["extension"] == "EXTEND"
        assert image["interpolation"] == "Linear"
        channel = name.removeprefix("sardf ")
        packed, file = arrays[f"packed {name}"], arrays[f"file {channel}.exr"]
        assert np.array_equal(packed[..., :3], file[..., :3]), name
    assert len(facts["packed"]) == len(TEXTURES)  # the fractions too


def test_textures_hold_the_baked_values(sphere):
    _, _, arrays, _, _ = sphere
    fractions = arrays["file fractions_1.exr"][..., :2].astype(float)
    assert np.abs(fractions.sum(axis=-1) - 1).max() < 1e-4
    mixed = fractions @ np.stack([linear(RED), linear(STEEL)])
    assert np.abs(arrays["file base_color.exr"][..., :3] - mixed).max() < 1e-3
    for name, values in (("roughness", [0.25, 0.75]), ("metallic", [0, 1])):
        texture = arrays[f"file {name}.exr"][..., 0]
        assert np.abs(texture - fractions @ np.array(values)).max() < 1e-3, name


def test_flat_look_shows_the_base_colour_of_each_pixels_centre(sphere):
    _, _, arrays, _, camera = sphere
    flat = arrays["file flat.exr"]
    points = seen_points(camera)
    inside = ~np.isnan(points[..., 0])
    covered = flat[..., 3] > 0.5
    assert set(np.unique(flat[..., 3])) == {0.0, 1.0}
    assert (inside & covered).sum() / (inside | covered).sum() > 0.995
    both = inside & covered
    error = np.abs(flat[both][:, :3] - expected_colors(points[both])).max(axis=1) * 255
    assert np.median(error) < 0.5
    assert np.percentile(error, 99) < 2


def test_normals_look_shows_the_surfaces_normal(sphere):
    _, _, arrays, _, camera = sphere
    normals = arrays["file normals.exr"]
    points = seen_points(camera)
    both = ~np.isnan(points[..., 0]) & (normals[..., 3] > 0.5)
    error = np.abs(normals[both][:, :3] - (points[both] / RADIUS * 0.5 + 0.5)).max(axis=1) * 255
    assert np.median(error) < 0.5
    assert np.percentile(error, 99) < 4


def test_shaded_look_is_neither_dark_nor_burnt_out(sphere):
    _, _, arrays, _, camera = sphere
    picture = arrays["file part.png"][..., :3]
    on_part = ~np.isnan(seen_points(camera)[..., 0])
    grey = picture.mean(axis=-1)
    assert 0.25 < np.median(grey[on_part]) < 0.85
    assert (grey[on_part] > 0.99).mean() < 0.05
    assert np.percentile(grey[on_part], 99) > 0.55  # the lights, not just the world
    assert np.ptp(grey[on_part]) > 0.2
    backdrop = picture[~on_part]  # its pixels at the outline hold a bit of the part
    assert np.percentile(np.ptp(backdrop, axis=-1), 95) < 0.06


def test_creases_stay_sharp_and_only_pictures_are_written(version, tmp_path):
    """Each pixel of a brick shows one of the three visible faces' normals, not a mixture."""
    scene = write_scene(tmp_path, BOX)
    output = tmp_path / "out"
    for look in ("normals,shaded", "normals"):  # the second run replaces the first one's files
        done = headless(
            version, tmp_path, scene, "-o", output, *SMALL, "--look", look, "--no-keep-blend"
        )
        assert done.returncode == 0, done.stderr
    assert {path.name for path in output.iterdir()} == {"normals.exr", "part.png", "camera.json"}
    shutil.copy(output / "camera.json", tmp_path / "camera.json")
    again = tmp_path / "again"
    done = headless(
        version, tmp_path, scene, "-o", again, *SMALL, "--look", "normals",
        "--camera", tmp_path / "camera.json",
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    arrays, _ = inspect(version, tmp_path, again)
    normals = arrays["file normals.exr"]
    covered = normals[normals[..., 3] > 0.5][:, :3] * 2 - 1
    along_axis = np.abs(covered).max(axis=1) > 1 - 2 / 255
    assert along_axis.mean() > 0.99
    assert len(np.unique(np.round(covered[along_axis]), axis=0)) == 3
    assert json.loads((again / "camera.json").read_text()) == json.loads(
        (output / "camera.json").read_text()
    )


def check_failure(done, code, *words):
    """Exit code, and one line on standard error (Blender's own go to standard output)."""
    lines = [line for line in done.stderr.splitlines() if line.startswith("sardf: ")]
    assert done.returncode == code, done.stdout + done.stderr
    assert len(lines) == 1, done.stderr
    assert "Traceback" not in done.stdout + done.stderr
    for word in words:
        assert word in lines[0]


def test_bad_input_has_exit_code_2_and_leaves_nothing(version, tmp_path):
    broken = tmp_path / "broken.json"
    broken.write_text('{ "sardf": 1,\n  "fields": {\n')
    output = tmp_path / "out"
    missing = tmp_path / "missing.json"
    check_failure(headless(version, tmp_path, missing, "-o", output), 2, str(missing))
    check_failure(headless(version, tmp_path, broken, "-o", output), 2, f"{broken}:")
    assert not list(output.iterdir())


def test_unwritable_output_has_exit_code_1(version, tmp_path):
    scene = write_scene(tmp_path, BOX)
    below_a_file = scene / "out"
    check_failure(
        headless(version, tmp_path, scene, "-o", below_a_file), 1, str(below_a_file), "written"
    )


def test_terminated_run_cleans_up_as_does_the_next_after_a_kill(version, tmp_path):
    output = tmp_path / "out"
    left = output / ".sardf-999999999-x"  # no process has this number
    left.mkdir(parents=True)
    (left / "part.png").touch()
    scene = write_scene(tmp_path, GRADED_SPHERE)
    process = start_script(
        version, HEADLESS, scene, "-o", output, "--resolution", 256, "--size", 4096,
        user_folder=tmp_path / "user",
    )  # fmt: skip
    while left.exists() or not list(output.glob(".sardf-*")):
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(0.02)
            break
    process.terminate()
    standard_output, standard_error = process.communicate(timeout=120)
    assert process.returncode == 1, standard_output + standard_error
    assert "sardf: stopped by SIGTERM" in standard_error
    assert not list(output.iterdir())


USAGE = {
    "no output": ((), "-o"),
    "unknown option": (("-o", "out", "--resolutoin", "3"), "--resolutoin"),
    "no number": (("-o", "out", "--size", "big"), "'big'"),
    "too small": (("-o", "out", "--resolution", "0"), "4 to 4096"),
    "unknown look": (("-o", "out", "--look", "flat,toon"), "'toon'"),
}


@pytest.mark.parametrize("case", USAGE)
def test_wrong_usage_has_exit_code_2(case, tmp_path):
    arguments, word = USAGE[case]
    check_failure(headless("5.0.1", tmp_path, "part.json", *arguments), 2, word)


CAMERAS = {
    "no JSON": ("{", "is not JSON"),
    "a list": ("[]", "expected an object"),
    "negative lens": ('{"lens": -1}', "'lens' must be a positive number"),
    "no matrix": ("{}", "'matrix_world' must be a list of 4 rows"),
    "unknown type": (
        '{"matrix_world": [[1,0,0,0],[0,1,0,0],[0,0,1,9],[0,0,0,1]], "type": "PANO"}',
        "'type' must be one of PERSP, ORTHO, found 'PANO'",
    ),
}


@pytest.mark.parametrize("case", CAMERAS)
def test_wrong_camera_file_has_exit_code_2(case, tmp_path):
    text, message = CAMERAS[case]
    camera = tmp_path / "camera.json"
    camera.write_text(text)
    scene = write_scene(tmp_path, BOX)
    done = headless("5.0.1", tmp_path, scene, "-o", tmp_path / "out", "--camera", camera)
    check_failure(done, 2, str(camera), message)


def test_missing_core_names_both_pythons(tmp_path):
    """Outside a checkout with .venv there is no sardf; and one for another Python is no use."""
    moved = tmp_path / "addon"
    shutil.copytree(HEADLESS.parent, moved, ignore=shutil.ignore_patterns("__pycache__"))
    scene = write_scene(tmp_path, BOX)
    arguments = (scene, "-o", tmp_path / "out")
    user = {"user_folder": tmp_path / "user"}
    done = run_script("3.4.1", moved / "headless.py", *arguments, **user)
    check_failure(done, 1, "'sardf' built for cp311 (this is Python 3.11) was not found")
    package = tmp_path / "other/sardf"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    (package / "_core.cpython-39-x86_64-linux-gnu.so").touch()
    elsewhere = {"SARDF_PYTHON": str(package.parent)}
    done = run_script("3.4.1", moved / "headless.py", *arguments, **user, env=elsewhere)
    check_failure(done, 1, "is built for cp39")
