"""The command `sardf`: what it writes, and one message and exit code for what is wrong."""

import csv
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sardf

ROOT = Path(__file__).resolve().parents[2]
SARDF = Path(sys.executable).with_name("sardf")
BALL = """{"sardf": 1, "title": "ball", "solid": "ball",
 "fields": {"ball": {"sphere": {"radius": 2}}},
 "materials": {"red": {"color": "#c03020", "density": 2}, "blue": {"color": "#2040c0"}},
 "fractions": {"ramp": {"field": "=x", "stops": [
   {"at": -2, "material": "red"}, {"at": 2, "material": "blue"}]}},
 "attributes": {"index": "=1.5 + x / 10"}}
"""


def run(*words, cwd=None, stdin="", environment=None):
    command = [str(SARDF), *(str(word) for word in words)]
    return subprocess.run(
        command,
        cwd=cwd,
        input=stdin,
        capture_output=True,
        text=True,
        timeout=120,
        env={**os.environ, **(environment or {})},
    )


@pytest.fixture
def ball(tmp_path):
    path = tmp_path / "ball.json"
    path.write_text(BALL)
    return path


def test_check_prints_what_the_scene_is(ball):
    done = run("check", ball)
    assert done.returncode == 0, done.stderr
    rows = dict(line.split("  ", 1) for line in done.stdout.splitlines() if line[0] != " ")
    volume = float(rows["volume"].split()[0])
    assert volume == pytest.approx(4 / 3 * np.pi * 8, rel=2e-3)
    red = next(line for line in done.stdout.splitlines() if line.startswith("  red"))
    centimetres, _, grams, _ = red.split()[1:5]
    # By symmetry half of the ball is red; 1000 mm³ are a cm³, of 2 g.
    assert float(centimetres) == pytest.approx(volume / 2000, rel=2e-3)
    assert float(grams) == pytest.approx(volume / 1000, rel=2e-3)
    assert rows["Lipschitz"].strip() == "1"
    assert "exact, exact" in done.stdout


def test_eval_has_a_column_for_everything(ball, tmp_path):
    points = tmp_path / "points.csv"
    points.write_text("x,y,z\n0,0,0\n1,0,0\n-2,0,0\n")
    done = run("eval", ball, "--points", points, "-o", tmp_path / "values.csv")
    assert done.returncode == 0, done.stderr
    with (tmp_path / "values.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["x", "y", "z", "field", "red", "blue", "index"]
    values = np.array([[float(v) for v in row.values()] for row in rows])
    np.testing.assert_allclose(values[:, 3], [2, 1, 0], atol=1e-15)
    np.testing.assert_allclose(values[:, 4:], [[0.5, 0.5, 1.5], [0.25, 0.75, 1.6], [1, 0, 1.3]])


def test_standard_streams(ball, tmp_path):
    done = run("check", "-", stdin=BALL)
    assert done.returncode == 0, done.stderr
    assert "volume" in done.stdout
    done = run("eval", ball, "--points", "-", "-o", "-", stdin="x,y,z\n1,0,0\n")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[1].split(",")[3] == "1"
    done = run("eval", "-", "--points", "-", "-o", "-", stdin=BALL)
    assert done.returncode == 2
    assert "both" in done.stderr


def test_mesh_and_textures_are_written(ball, tmp_path):
    done = run("bake", ball, "-o", tmp_path / "out", "--size", 256, "--resolution", 32)
    assert done.returncode == 0, done.stderr
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert any(name.startswith("base_color") for name in names)
    assert not [name for name in names if name.startswith(".") or "tmp" in name]


# Each with the arguments, what the message must contain, and the exit code.
WRONG = {
    "missing file": (["check", "nowhere.json"], "nowhere.json", 2),
    "a folder": (["check", "."], ".", 2),
    "no command": ([], "subcommand", 2),
    "unknown command": (["bakes", "ball.json"], "did you mean 'bake'", 2),
    "unknown option": (["check", "ball.json", "--sizes", "3"], "--sizes", 2),
    "unknown format": (["mesh", "ball.json", "-o", "ball.stl"], "ball.stl", 2),
    "unknown channel": (["bake", "ball.json", "-o", "out", "--channels", "colour"], "colour", 2),
    "size": (["bake", "ball.json", "-o", "out", "--size", "1"], "--size", 2),
    "resolution": (["mesh", "ball.json", "-o", "ball.ply", "--resolution", "1"], "resolution", 2),
    "memory": (["mesh", "ball.json", "-o", "ball.ply", "--resolution", "900000"], "memory", 1),
    "unwritable": (["mesh", "ball.json", "-o", "/proc/ball.ply"], "/proc", 1),
    "unwritable folder": (["bake", "ball.json", "-o", "/proc/out"], "/proc", 1),
    "no points": (["eval", "ball.json", "--points", "none.csv", "-o", "o.csv"], "none.csv", 2),
    "POV-Ray": (["povray", "ball.json", "-o", "b.pov", "--render", "b.png"], "POV-Ray 3.7", 1),
    "Blender": (
        ["compare", "ball.json", "-o", "out", "--blender", "/no/blender"],
        "/no/blender",
        1,
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_is_wrong_is_said(case, ball, tmp_path):
    arguments, message, code = WRONG[case]
    before = sorted(tmp_path.iterdir())
    environment = {"POVRAY": "/no/povray"} if case == "POV-Ray" else {}
    done = run(*arguments, cwd=tmp_path, environment=environment)
    assert done.returncode == code, done.stderr
    assert message in done.stderr
    assert len(done.stderr.strip().splitlines()) <= 3
    assert not {path for path in tmp_path.rglob("*") if path.is_file()} - set(before)


def test_all_errors_of_a_scene_are_listed(tmp_path):
    path = tmp_path / "wrong.json"
    path.write_text(BALL.replace('"sphere"', '"spher"').replace("#c03020", "#c0302"))
    done = run("check", path)
    assert done.returncode == 2
    assert "spher" in done.stderr
    assert "sphere" in done.stderr
    assert "#c0302" in done.stderr
    assert "/materials/red/color" in done.stderr
    assert done.stdout == ""


@pytest.mark.parametrize("number", ["0", "-1", "1e300", '"=0/0"', '"=sqrt(-1)"'])
def test_absurd_numbers_never_crash(number, tmp_path):
    path = tmp_path / "absurd.json"
    path.write_text(BALL.replace('"radius": 2', f'"radius": {number}'))
    done = run("check", path)
    assert done.returncode in (1, 2), done.stdout
    assert done.stderr.startswith(f"sardf: {path}:2: /fields/ball/sphere/radius: ")
    assert len(done.stderr.splitlines()) == 1


@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGINT, signal.SIGKILL])
def test_nothing_half_written_is_left_when_it_is_ended(end, tmp_path):
    scene = ROOT / "scenes" / "gyroid_sandwich.json"
    out = tmp_path / "out"
    command = [str(SARDF), "bake", str(scene), "-o", str(out), "--resolution", "200"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, stdout=subprocess.PIPE) as process:
        try:
            process.wait(timeout=1.5)
        except subprocess.TimeoutExpired:
            process.send_signal(end)
        process.communicate(timeout=30)
    assert process.returncode != 0
    left = [path.name for path in out.rglob("*") if path.is_file()] if out.exists() else []
    assert [name for name in left if name.endswith((".exr", ".glb", ".ply"))] == []


def test_a_file_of_the_users_survives_a_failure(ball, tmp_path):
    target = tmp_path / "ball.ply"
    target.write_text("mine")
    done = run("mesh", ball, "-o", target, "--resolution", "900000")
    assert done.returncode == 1
    assert target.read_text() == "mine"


def test_a_scene_of_python_is_the_scene_of_the_file(ball):
    scene = sardf.load(str(ball))
    assert list(scene.materials) == ["red", "blue"]
    assert json.loads(scene.to_json())["title"] == "ball"


TREE = """{"sardf": 1, "solid": "part", "fields": {
  "plate": {"polygon": {"vertices": [[0, 0], [0, 4], [4, 4], [4, 0]]}},
  "part": {"extrude": {"field": {"difference": {"of": [
    "plate", {"disc": {"center": [2, 2], "radius": 1}}], "blend": {"sardf": 0.5}}}, "height": 2}}}}
"""


@pytest.fixture
def tree(tmp_path):
    path = tmp_path / "tree.json"
    path.write_text(TREE)
    return path


def test_check_labels_every_node_and_remarks_on_contours(tree):
    lines = run("check", tree).stdout.splitlines()
    rows = [line for line in lines if "error bound" in line and line.startswith("  ")]
    assert [(line.split()[0], len(line) - len(line.lstrip())) for line in rows] == [
        ("plate", 2),
        ("part", 2),
        ("difference", 4),
        ("disc", 6),
    ]
    assert "exact, exact, error bound 0; its contour runs clockwise" in rows[0]
    # One blend of radius 0.5 moves the field by (1 - 1/√2) · 0.5 at most.
    assert rows[2].split()[1:] == ["estimate,", "estimate,", "error", "bound", "0.146447"]


def test_one_switch_changes_the_blend(tree, tmp_path):
    points = tmp_path / "points.csv"
    points.write_text("3.3,2,0\n1.9,0.4,0\n")  # 0.3 from the disc and 0.7 from the edge; 0.6, 0.4

    def fields(*options):
        done = run("eval", tree, "--points", points, *options)
        assert done.returncode == 0, done.stderr
        return [float(line.split(",")[3]) for line in done.stdout.splitlines()[1:]]

    disc = [np.hypot(x - 2, y - 2) - 1 for x, y in ((3.3, 2), (1.9, 0.4))]
    edge = [0.7, 0.4]
    assert fields("--blend", "min_max") == pytest.approx(np.minimum(disc, edge))
    r = [a + b - np.hypot(a, b) for a, b in zip(disc, edge, strict=True)]
    assert fields("--blend", "r_function") == pytest.approx(r)
    assert fields() == fields("--blend", "sardf=0.5")


@pytest.mark.parametrize(
    ("blend", "message"),
    [
        ("sadrf=1", "did you mean 'sardf'?"),
        ("sardf", "'sardf=NUMBER' is accepted"),
        ("sardf=0", "radius is 0"),
        ("sardf=1x", "NAME or NAME=NUMBER is accepted"),
        ("min_max=1", "'min_max' is accepted"),
    ],
)
def test_a_wrong_blend_is_one_message(tree, blend, message):
    done = run("check", tree, "--blend", blend)
    assert done.returncode == 2
    assert message in done.stderr
    assert done.stderr.count("\n") == 1


def test_textures_can_be_mip_mapped(ball, tmp_path):
    options = ("--size", 64, "--resolution", 24, "--format", "tx", "--channels", "base_color")
    done = run("bake", ball, "-o", tmp_path / "out", *options)
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == [
        "base_color.tx",
        "part.glb",
    ]
    report = subprocess.run(
        ["oiiotool", "--info", "-v", tmp_path / "out/base_color.tx"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert "MIP-map levels: 64x64 32x32 16x16 8x8 4x4 2x2 1x1" in report
    assert "tile size: 64 x 64" in report
    assert "float tiff" in report
