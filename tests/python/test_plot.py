"""Plots: their numbers against formulas and landmarks done elsewhere; files and errors."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sardf
from plot_scenes import BALL, ball_distance, csv_of, points_of
from sardf import plot
from sardf.plot.__main__ import main

ROOT = Path(__file__).resolve().parents[2]
ELLIPSOIDS = str(ROOT / "scenes/two_ellipsoids.json")
PINS = str(ROOT / "scenes/cad_pins.json")


@pytest.fixture(scope="module")
def ball_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("plot") / "ball.json"
    path.write_text(json.dumps(BALL))
    return str(path)


@pytest.fixture(scope="module")
def ball(ball_file):
    return sardf.load(ball_file)


@pytest.fixture(scope="module")
def ellipsoids():
    return sardf.load(ELLIPSOIDS)


@pytest.fixture(scope="module")
def plate():
    """The CAD part of Fayolle et al. 2004, section 6.1, by its trees; sizes as in the landmarks."""
    box = sardf.box(size=(10, 6, 20))
    hole, inner, outer = (sardf.cylinder(center=(1.5, 0, 0), radius=r) for r in (1, 1.5, 2.5))
    with sardf.blend(sardf=0.5):
        part = box - hole
        pure = [part - outer, (box & inner) - hole]
    rule = [{"at": pure[0], "material": "first"}, {"at": pure[1], "material": "second"}]
    return sardf.Scene(
        solid=part,
        materials={"first": {"color": "#0000ff"}, "second": {"color": "#ff0000"}},
        fractions={"blend_between": {"of": rule}},
    )


def brick_distance(points):
    q = np.abs(points) - 1
    return -(np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(axis=-1), 0))


# Numbers


def test_section_as_csv(ball_file, tmp_path):
    out = tmp_path / "numbers.csv"
    words = "--section y=0.5 --field ball brick =ball-brick --window -3,3,-2,2 --resolution 31"
    assert main([ball_file, *words.split(), "-o", str(out)]) == 0
    columns = csv_of(out)
    points = points_of(columns)
    assert list(columns) == ["x", "y", "z", "ball", "brick", "=ball-brick"]
    assert np.unique(points[:, 0]).tolist() == np.linspace(-3, 3, 31).tolist()
    assert np.unique(points[:, 2]) == pytest.approx(np.linspace(-2, 2, 21))
    assert set(points[:, 1]) == {0.5}
    near = {"rtol": 0, "atol": 1e-14}
    np.testing.assert_allclose(columns["ball"], ball_distance(points), **near)
    np.testing.assert_allclose(columns["brick"], brick_distance(points), **near)
    difference = ball_distance(points) - brick_distance(points)
    np.testing.assert_allclose(columns["=ball-brick"], difference, **near)


def test_landmarks_of_the_union_of_ellipsoids(tmp_path):
    """Distances by an independent program (landmarks 12 and 13), at p = (5,0,-1) and (8,0,-3)."""
    out = tmp_path / "numbers.csv"
    blends = ["sardf=0.5", "min_max", "r_function"]
    words = ["--section", "y=0", "--window", "5,8,-3,-1", "--resolution", "4", "--blend", *blends]
    assert main([ELLIPSOIDS, *words, "--field", "lying", "solid", "-o", str(out)]) == 0
    columns = csv_of(out)
    points = points_of(columns)
    expected = {
        (5, 0, -1): (1, 1.1346020, 1, 3.3731763),
        (8, 0, -3): (-1.34998588, -1.08998972, -1.15135757, -0.72705877),
    }
    for place, (lying, *solids) in expected.items():
        (row,) = np.flatnonzero((points == place).all(axis=1))
        for blend, solid in zip(blends, solids, strict=True):
            assert columns[f"lying, {blend}"][row] == pytest.approx(lying, abs=1e-7)
            assert columns[f"solid, {blend}"][row] == pytest.approx(solid, abs=1e-6)


def test_blends_agree_with_the_golden_section(ellipsoids):
    golden = ROOT / "tests/golden/fig_sardf_14_15_section.csv"
    table = np.genfromtxt(golden, delimiter=",", skip_header=1, names=True)
    points = np.transpose([table[axis] for axis in "xyz"])
    blends = {"sardf=0.5": "sardf", "min_max": "max", "r_function": "rfun"}
    values = plot.quantities(ellipsoids, blends=list(blends))
    errors = plot.quantities(ellipsoids, ["both"], blends=["sardf=0.5"], show="error")
    assert len(points) > 100
    for quantity, column in zip(values, blends.values(), strict=True):
        np.testing.assert_allclose(quantity.values(points), table[column], rtol=0, atol=1e-9)
    error = table["sardf"] - table["max"]
    np.testing.assert_allclose(errors[0].values(points), error, rtol=0, atol=1e-9)
    assert np.ptp(error) > 0.1


def test_gradient_is_one_for_a_distance_and_the_derivative_of_a_formula(ball):
    points = np.random.default_rng(1).uniform(-3, 3, (200, 3))
    ball_slope, formula_slope = plot.quantities(ball, ["ball", "=slope + y"], show="gradient")
    np.testing.assert_allclose(ball_slope.values(points), 1, rtol=0, atol=1e-12)
    expected = np.sqrt(4 * points[:, 0] ** 2 + 1)
    np.testing.assert_allclose(formula_slope.values(points), expected, rtol=0, atol=1e-12)


def test_graph_of_the_plate(plate, tmp_path):
    """Fig. 20 along y = 0.4: landmark 21, the plateaus, the hole, and weights that sum to 1."""
    plate.save(str(tmp_path / "plate.json"))
    words = ["--segment", "-5,0.4,0", "5,0.4,0", "--fraction", "first", "second", "--field"]
    out = tmp_path / "graph.csv"
    assert main([str(tmp_path / "plate.json"), *words, "solid", "-o", str(out)]) == 0
    columns = csv_of(out)
    assert list(columns) == ["s", "x", "y", "z", "solid", "first", "second"]
    row = int(np.abs(columns["x"] - 3.5).argmin())
    assert columns["s"][row] == pytest.approx(8.5)
    assert columns["first"][row] == pytest.approx(0.53960780544, abs=1e-9)
    assert columns["solid"][row] == pytest.approx(1.03815024012, abs=1e-9)
    in_hole = np.abs(columns["x"] - 1.5) < np.sqrt(1 - 0.4**2) - 1e-9
    np.testing.assert_array_equal(np.isnan(columns["first"]), in_hole)
    np.testing.assert_allclose((columns["first"] + columns["second"])[~in_hole], 1, atol=1e-12)
    assert set(columns["first"][columns["x"] < -1]) == {1.0}


def test_landmark_of_the_pins():
    """Landmark 22, with the scene's y and z exchanged: m1 = 3/7 at (2.9, 2, -0.3)."""
    (polymer,) = plot.quantities(sardf.load(PINS), fractions=["polymer"])
    assert polymer.values((2.9, 2, -0.3)) == pytest.approx(3 / 7, abs=1e-9)


@pytest.mark.parametrize("only", ["inside", "outside"])
def test_only_hides_the_rest(ball, only):
    cut = plot.section(ball, "z=0", only=only, resolution=40)
    shown, distance = np.isfinite(cut.values["solid"]), ball_distance(cut.points)
    clear = np.abs(distance) > 1e-9
    np.testing.assert_array_equal(shown[clear], (distance > 0)[clear] == (only == "inside"))


def test_fractions_and_attributes_are_shown_inside_by_default(ball):
    cut = plot.section(
        ball, "z=0", fractions=["red"], attributes=["heat", "grain"], materials=True, resolution=30
    )
    inside = ball_distance(cut.points) >= 0
    assert list(cut.values) == ["red", "heat", "grain_x", "grain_y", "grain_z", "materials"]
    assert all(np.isfinite(v[inside]).all() for v in cut.values.values())
    assert all(np.isnan(v[~inside]).all() for v in cut.values.values())
    assert cut.values["heat"][inside] == pytest.approx(20 + cut.points[inside][:, 0])
    assert cut.values["grain_x"][inside] == pytest.approx(-cut.points[inside][:, 1])
    header, rows = cut.table()
    assert header[-3:] == ["materials_r", "materials_g", "materials_b"]
    assert rows.shape == (inside.size, 3 + 5 + 3)


# Planes and windows


def test_any_plane(ball):
    normal = np.array([1, -2, 2]) / 3
    cut = plot.section(ball, ((0.5, 1, 0), (3, -6, 6)), resolution=33)
    assert np.abs((cut.points - (0.5, 1, 0)) @ normal).max() < 1e-12
    frame = np.array([cut.plane.right, cut.plane.up, normal])
    np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(frame) == pytest.approx(1)
    assert cut.plane.up[2] > 0
    np.testing.assert_allclose(cut.values["solid"], ball_distance(cut.points), atol=1e-12)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_normal_along_an_axis_is_that_section(axis):
    normal = np.zeros(3)
    normal[axis] = -3
    through = plot.plane(((0.1, 0.2, 0.3), normal))
    section = plot.plane(f"{'xyz'[axis]}={(0.1, 0.2, 0.3)[axis]}")
    points = np.random.default_rng(2).uniform(-1, 1, (5, 3))
    np.testing.assert_array_equal(through.coordinates(points), section.coordinates(points))
    assert through.labels == section.labels
    assert through.name == section.name


@pytest.mark.parametrize("at", ["x=0", "y=0.5", ((1, 0, 0), (1, 1, 1))])
def test_default_window_holds_the_solid(ball, at):
    cut = plot.section(ball, at, resolution=80)
    border = np.ones(cut.points.shape[:2], bool)
    border[1:-1, 1:-1] = False
    assert ball_distance(cut.points)[border].max() < 0
    assert ball_distance(cut.points).max() > 0
    assert np.ptp(cut.across) < 2 * 4 * 1.8


# Files and errors


def test_files_are_complete_reproducible_and_replaced(ball_file, tmp_path):
    words = [ball_file, "--section", "z=0", "--resolution", "40"]
    starts = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF", "csv": b"x,y,z,solid\n"}
    outputs = [word for kind in starts for word in ("-o", str(tmp_path / f"figure.{kind}"))]
    written = []
    for _ in range(2):
        assert main([*words, *outputs]) == 0
        assert sorted(path.name for path in tmp_path.iterdir()) == [
            f"figure.{kind}" for kind in sorted(starts)
        ]
        written.append({k: (tmp_path / f"figure.{k}").read_bytes() for k in starts})
    assert written[0] == written[1]
    assert all(written[0][kind].startswith(start) for kind, start in starts.items())


def test_failure_leaves_the_old_file(ball, tmp_path, monkeypatch, capsys):
    path = tmp_path / "figure.png"
    path.write_text("old")

    def disk_is_full(self, file, **options):
        Path(file).write_text("half")
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("matplotlib.figure.Figure.savefig", disk_is_full)
    figure = plot.draw_sections(plot.section(ball, "z=0", resolution=10))
    with pytest.raises(plot.Failure, match=r"figure.png: cannot be written: No space left"):
        plot.save(figure, path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


# What is typed | what the answer contains.
WRONG_INPUT = """
--section y=0 --field bal | accepted are solid, ball, brick, slope; did you mean 'ball'?
--section y=0 --outline brik | did you mean 'brick'?
--section y=0 --field =bal+1 | did you mean 'ball'?
--section y=0 --fraction blu | there is no material 'blu'
--section y=0 --attribute hea | did you mean 'heat'?
--section y=0 --blend sarf=1 | did you mean 'sardf'?
--section y=0 --blend sardf | 'sardf=NUMBER' is accepted
--section y=0 --blend min_max=1 | 'min_max' is accepted
--section q=0 | x=, y= or z= and a number is accepted
--section y=nan | a finite number is accepted
--plane 0,0,0 0,0,0 | the normal is (0, 0, 0)
--plane 0,0 0,0,1 | 3 finite numbers are accepted
--section y=0 --window 0,1,2,2 | the window is '0,1,2,2'
--section y=30 --only inside | nothing of the plane y = 30 lies inside the solid
--section y=0 --field =0*x/0 | no finite value
--section y=0 --lines 1e-9 | more than 1000 levels
--section y=0 --bands -1 | a positive number or 'none' is accepted
--section y=0 --colors viridi | did you mean 'viridis'?
--section y=0 --gradient --fraction red | the gradient is that of a field
--section y=0 --field ball ball | 'ball' is asked for twice
--section y=0 -o figure.gif | there is no format
--segment 0,0,0 0,0,0 | two different points are accepted
--segment 0,1,0 1,1,0 --section y=0 | does not lie in the plane y = 0
--segment 0,0,0 1,0,0 --materials | mixed colours cannot be plotted as a line
--isosurface --level 9 | solid, level 9 has no surface
--isosurface --view 0,0,0 | a direction towards the camera is accepted
--isosurface --through povray --fraction red | red is none
"""


@pytest.mark.parametrize("case", WRONG_INPUT.strip().splitlines())
def test_wrong_input_gets_one_clear_sentence(ball_file, tmp_path, case, capsys):
    words, said = case.split(" | ")
    output = [] if "-o" in words.split() else ["-o", str(tmp_path / "figure.png")]
    assert main([ball_file, *words.split(), *output]) == 2
    message = capsys.readouterr().err
    assert message.startswith("sardf.plot: ")
    assert said in message
    assert message.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "words", ["", "--section y=0 --plane 0,0,0 0,0,1", "--isosurface --section y=0", "--only in"]
)
def test_wrong_usage(ball_file, words, capsys):
    with pytest.raises(SystemExit) as ended:
        main([ball_file, "-o", "figure.png", *words.split()])
    assert ended.value.code == 2
    assert "sardf.plot: error:" in capsys.readouterr().err


def test_what_cannot_be_written_or_read(ball_file, tmp_path, capsys):
    words = ["--section", "y=0", "--resolution", "10", "-o"]
    (tmp_path / "folder.csv").mkdir()
    assert main([ball_file, *words, str(tmp_path / "folder.csv")]) == 1
    assert "it is a folder" in capsys.readouterr().err
    assert main([ball_file, *words, str(tmp_path / "none/figure.csv")]) == 1
    assert "No such file" in capsys.readouterr().err
    assert main([str(tmp_path / "none.json"), *words, str(tmp_path / "figure.csv")]) == 2
    assert "none.json: cannot read the scene file" in capsys.readouterr().err


def python(*words):
    return subprocess.run(
        [sys.executable, "-W", "error", *words], capture_output=True, text=True, timeout=120
    )


def test_as_a_module(ball_file):
    shown = python("-m", "sardf.plot", "--help")
    assert shown.returncode == 0
    for option in ("--section", "--segment", "--isosurface", "--blend", "--stripes", "exit codes"):
        assert option in shown.stdout
    words = ["--segment", "-1,0,0", "1,0,0", "--samples", "3", "-o", "-"]
    numbers = python("-m", "sardf.plot", ball_file, *words)
    assert numbers.stdout.splitlines() == [
        "s,x,y,z,solid",
        "0.0,-1.0,0.0,0.0,0.0",
        "1.0,0.0,0.0,0.0,1.0",
        "2.0,1.0,0.0,0.0,2.0",
    ]
    wrong = python("-m", "sardf.plot", ball_file, "--section", "y=0", "-o", "figure.gif")
    assert wrong.returncode == 2
    assert "Traceback" not in wrong.stderr


def test_importing_sardf_imports_no_matplotlib():
    done = python("-c", "import sardf, sys; sys.exit('matplotlib' in sys.modules)")
    assert done.returncode == 0, done.stderr
    blocked = "import sys; sys.modules['matplotlib'] = None; import sardf.plot"
    missing = python("-c", blocked)
    assert "plots need matplotlib: pip install 'sardf[plot]'" in missing.stderr
