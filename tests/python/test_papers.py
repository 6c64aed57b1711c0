"""The pages of the papers are what scripts/make_papers writes; their commands and numbers hold."""

import dataclasses
import json
import math
import re
import shlex
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import sardf
from papers import biswas_page, biswas_tables, sardf_page, sardf_tables
from PIL import Image
from plot_scenes import csv_of, points_of
from repository import ROOT
from sardf.accuracy import __main__ as accuracy
from sardf.plot.__main__ import main as plot

FOLDER = ROOT / "docs/papers"
IMAGES = FOLDER / "images"
# Solving for 31³ splines takes long; that the scene with fewer is the same is a test of its own.
MANY_SPLINES = "docs/papers/scenes/biswas_cube_smooth.json"
FEWER_SPLINES = "scenes/cube_spiral.json"
PAPERS = [sardf_page.PAPER, biswas_page.PAPER]
TEXTS = {paper.name: (FOLDER / f"{paper.name}.md").read_text() for paper in PAPERS}
# The figures of each paper that its page has.
FIGURES = {"sardf": range(1, 31), "biswas": range(1, 16)}
TABLES = {"sardf": ["Table 1"], "biswas": []}
WITHOUT_PICTURE = [("sardf", "Figure 13"), ("sardf", "Table 1")]
SHOWN = r"!\[[^\]]+\]\(images/([^)]+)\)"
TYPOS, READINGS = 19, 15

every_paper = pytest.mark.parametrize("paper", PAPERS, ids=lambda paper: paper.name)


def commands(text: str) -> list[list[str]]:
    """The words of each command on a page."""
    blocks = re.findall(r"^```console\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    lines = "".join(blocks).replace("\\\n", " ").splitlines()
    return [shlex.split(line.removeprefix("$ ")) for line in lines]


def arguments_of(module: str):
    """One pytest parameter for each command that runs the module: its arguments."""
    start = ["python", "-m", module]
    return [
        pytest.param(words[3:], id=words[-1] if "-o" in words else " ".join(words[3:]))
        for text in TEXTS.values()
        for words in commands(text)
        if words[:3] == start
    ]


def section_of(page: str, title: str) -> str:
    """The text under a heading, up to the next of the same depth."""
    depth, text = title.split()[0], TEXTS[page]
    start = text.index(f"{title}\n")
    end = text.find(f"\n{depth} ", start + 1)
    return text[start : end if end > 0 else None]


def rows_of(text: str) -> list[list[str]]:
    """The cells of a Markdown table below its head."""
    rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("|")]
    return rows[2:]


def test_pages_are_what_the_generator_writes():
    made = ROOT / "scripts/make_papers"
    done = subprocess.run([sys.executable, made, "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert {paper.name: paper.generated() for paper in PAPERS} == TEXTS


@every_paper
def test_check_finds_a_changed_page(paper, tmp_path):
    """Without its pictures and with another word on the page."""
    names = {"__name__": "make_papers", "__doc__": "Text."}
    exec(compile((ROOT / "scripts/make_papers").read_text(), "make_papers", "exec"), names)
    (tmp_path / f"{paper.name}.md").write_text(TEXTS[paper.name].replace("Every", "every", 1))
    (tmp_path / "images").mkdir()
    (tmp_path / "images/of_nothing.png").touch()
    names["PAPERS"] = (dataclasses.replace(paper, folder=tmp_path),)
    said = names["out_of_date"]()
    first = paper.drawings()[0].image
    assert {f"{first} is missing", f"{paper.name}.md is out of date"} <= set(said)
    assert "of_nothing.png belongs to no figure" in said


@every_paper
def test_every_figure_of_the_paper_is_there(paper):
    headings = re.findall(r"^### (.*)$", TEXTS[paper.name], re.MULTILINE)
    wanted = [f"Figure {number}" for number in FIGURES[paper.name]]
    assert [heading for heading in headings if heading.startswith("Figure")] == wanted
    assert [heading for heading in headings if heading not in wanted] == TABLES[paper.name]
    for heading in headings:
        text = section_of(paper.name, f"### {heading}").split("\n## ")[0]
        assert "**In the paper:**" in text
        assert "](images/" in text or (paper.name, heading) in WITHOUT_PICTURE


def test_every_picture_exists_and_is_shown():
    shown = [name for text in TEXTS.values() for name in re.findall(SHOWN, text)]
    there = [path.name for path in IMAGES.iterdir()]
    assert sorted(shown) == sorted(there)
    sizes = [(IMAGES / name).stat().st_size for name in there]
    assert max(sizes) <= 200_000
    assert sum(sizes) <= 3_000_000
    for name in there:
        pixels = np.asarray(Image.open(IMAGES / name).convert("L"))
        assert pixels.shape[1] >= 500
        assert pixels.std() > 5


@every_paper
def test_pictures_and_commands_on_the_page_belong_together(paper):
    typed = [w for w in commands(TEXTS[paper.name]) if w[-2:-1] == ["-o"]]
    assert [words[-1] for words in typed] == re.findall(SHOWN, TEXTS[paper.name])
    wanted = [["python", "-m", drawn.module, *drawn.words] for drawn in paper.drawings()]
    assert typed == wanted
    assert all(drawn.image.startswith(f"{paper.name}_") for drawn in paper.drawings())


def at_lower_cost(words, output) -> list[str]:
    """The words with another output, and with options that replace those before them."""
    cells = "24" if "--isosurface" in words else "60"
    fewer = ["--resolution", cells, "--samples", "61", "--dpi", "40"]
    words = [FEWER_SPLINES if word == MANY_SPLINES else word for word in words]
    return [*words[:-1], str(output), *fewer]


def test_the_quick_scene_is_the_one_of_the_page():
    many, fewer = ((ROOT / path).read_text() for path in (MANY_SPLINES, FEWER_SPLINES))
    many, fewer = (text[text.index("{") :] for text in (many, fewer))
    assert '"splines": [31]' in many
    assert many.replace('"splines": [31]', '"splines": [16]') == fewer


@pytest.mark.parametrize("words", arguments_of("sardf.plot"))
def test_commands_for_pictures_run(words, tmp_path, monkeypatch):
    """Numbers as CSV; pictures of surfaces, of which several have no common table."""
    monkeypatch.chdir(ROOT)
    drawn = tmp_path / words[-1]
    output = drawn if "--isosurface" in words else drawn.with_suffix(".csv")
    assert plot(at_lower_cost(words, output)) == 0
    assert output.stat().st_size > 1000


def one_of_each_scene():
    found = {}
    for parameter in arguments_of("sardf.plot"):
        words = parameter.values[0]
        if "--isosurface" not in words:
            found.setdefault((words[0], "--segment" in words), parameter)
    return list(found.values())


@pytest.mark.parametrize("words", one_of_each_scene())
def test_pictures_are_drawn(words, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    drawn = tmp_path / words[-1]
    assert plot(at_lower_cost(words, drawn)) == 0
    assert np.asarray(Image.open(drawn).convert("L")).std() > 5


@pytest.mark.long
@pytest.mark.parametrize("words", arguments_of("sardf.plot"))
def test_pictures_are_what_the_commands_draw(words, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    assert plot([*words[:-1], str(tmp_path / words[-1])]) == 0
    drawn, kept = (
        np.asarray(Image.open(folder / words[-1]).convert("RGB"), float)
        for folder in (tmp_path, IMAGES)
    )
    assert drawn.shape == kept.shape
    assert np.abs(drawn - kept).mean() < 2


def test_commands_for_accuracy_run(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    wanted = arguments_of("sardf.accuracy")
    assert len(wanted) == 5
    for parameter in wanted:
        words = [*parameter.values[0], "--resolution", "24", "--samples", "10"]
        if "-o" in words:
            place = words.index("-o") + 1
            words[place] = str(tmp_path / words[place])
        assert accuracy.main(words) == 0
        assert "outside" in capsys.readouterr().out


@pytest.mark.long
def test_accuracy_on_the_page_is_measured(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    kept = json.loads((FOLDER / "sardf_accuracy.json").read_text())
    for words, found in kept.items():
        assert accuracy.main([*words.split(), "-o", str(tmp_path / "table.json")]) == 0
        again = json.loads((tmp_path / "table.json").read_text())
        for side in ("inside", "outside"):
            for number in ("mean", "max"):
                wanted = pytest.approx(found["measured"][side][number], rel=0.05, abs=1e-6)
                assert again["measured"][side][number] == wanted


def test_what_the_page_says_about_accuracy():
    """Against the paper: max is exact outside, not inside; SARDF is within its bound outside."""
    kept = json.loads((FOLDER / "sardf_accuracy.json").read_text())
    measured = {words: found["measured"] for words, found in kept.items()}
    ellipsoids = {
        blend: measured[f"scenes/two_ellipsoids.json --blend {blend}"]
        for blend in ("sardf=0.5", "min_max")
    }
    bound = 0.5 * (1 - 1 / math.sqrt(2))
    assert ellipsoids["min_max"]["outside"]["max"] < 1e-3
    assert 0.95 * bound < ellipsoids["sardf=0.5"]["outside"]["max"] < bound + 1e-3
    assert 0.3 < ellipsoids["sardf=0.5"]["inside"]["max"] < ellipsoids["min_max"]["inside"]["max"]
    for side in ("inside", "outside"):
        assert measured["scenes/cad_plate.json --blend sardf=0.5"][side]["max"] < 1e-3


@pytest.mark.parametrize("scene", sorted((FOLDER / "scenes").glob("*.json")))
def test_scenes_of_the_pages_load(scene):
    loaded = sardf.Scene.from_json(scene.read_text().replace('"splines": [31]', '"splines": [8]'))
    assert np.isfinite(loaded.solid([[0.1, 0.2, 0.3]])).all()
    assert any(f"(scenes/{Path(scene).name})" in text for text in TEXTS.values())


@pytest.fixture(scope="module")
def corner():
    return sardf.load(str(FOLDER / "scenes/corner.json")).fields


def slopes(field, middle, step=1e-6):
    """Along the diagonal, before and after: there the gradient points along it."""
    values = [field([[middle + i * step, middle + i * step, 0]])[0] for i in (-1, 0, 1)]
    return np.diff(values) / (step * math.sqrt(2))


def test_jumps_on_the_page_are_those_of_the_fields(corner):
    """The exact values from |∇F| = 1/(σ + (σ-1) r'(d)) with σ = √2 on the diagonal."""
    rows = rows_of(section_of("sardf", "## Where `sardf` is not C1"))
    growth = {1: 1.0, -2: -0.5}  # of the radius within the arc; R = 1
    assert len(rows) == 2
    for row, (level, inner) in zip(rows, growth.items(), strict=True):
        middle = level + 1 - math.sqrt(0.5)
        root = math.sqrt(2)
        exact = abs(1 / (root + (root - 1) * inner) - 1 / root)
        for name, printed, wanted in (("corner", row[1], exact), ("corner_c1", row[2], 0)):
            assert corner[name]([[middle, middle, 0]])[0] == pytest.approx(level, abs=1e-12)
            before, after = slopes(corner[name], middle)
            assert abs(after - before) == pytest.approx(wanted, abs=5e-5)
            assert float(printed) == pytest.approx(wanted, abs=5e-7)
    assert [row[1] for row in rows] == ["0.160189", "0.121320"]


def test_directions_are_continuous_across_the_arcs(corner):
    """Off the diagonal, on {F = R}: a point of the circle around (2, 2), R = 1."""
    for angle in (200, 225, 240):
        across = np.array([math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0])
        points = [np.array([2, 2, 0]) + (1 + side * 1e-7) * across for side in (-1, 1)]
        inner, outer = corner["corner"].gradient(points)
        lengths = np.linalg.norm([inner, outer], axis=1)
        assert abs(lengths[0] - lengths[1]) > 0.05
        assert inner / lengths[0] == pytest.approx(outer / lengths[1], abs=1e-6)


def test_zones_and_circles_of_the_corner(corner):
    """Each level's arc lies on its circle: on the diagonal both are 0 at the same point."""
    for number, (level, radius) in enumerate(((0.7, 0.7), (1.6, 1), (-1.4, 0.7), (-2.6, 1)), 1):
        middle = level + radius - radius * math.sqrt(0.5)
        point = [[middle, middle, 0]]
        assert corner[f"level_{number}"](point)[0] == pytest.approx(0, abs=1e-12)
        assert corner[f"circle_{number}"](point)[0] == pytest.approx(0, abs=1e-12)
        zone = "growing_arcs" if number in (1, 3) else "fixed_arcs"
        assert corner[zone](point)[0] > 0
        other = "fixed_arcs" if number in (1, 3) else "growing_arcs"
        assert corner[other](point)[0] < 0


def test_typos_on_the_page():
    rows = rows_of(section_of("sardf", "## Corrected typos"))
    assert len(rows) == len(sardf_tables.TYPOS) == TYPOS
    assert all(len(row) == 4 and all(cell.strip() for cell in row) for row in rows)
    half = {axis: sardf.half_space(normal=axis) for axis in "xy"}
    joined = sardf.union(half["x"], half["y"], blend=sardf.Sardf(1))
    assert joined([[-3, -3, 0]])[0] == pytest.approx(-2.7071, abs=5e-5)
    for b, wanted in ((-12 - 4, [0.46, 7.54]), (-12 + 4, [1.2929, 2.7071])):  # printed, corrected
        roots = np.roots([2, b, 9 + 9 - 6 - 6 + 1])
        assert sorted(roots) == pytest.approx(wanted, abs=5e-3)


def test_readings_on_the_page():
    """Where numbers are given: weights that are not for the features, and Figure 12's influence."""
    rows = rows_of(section_of("biswas", "## Readings and corrections"))
    assert len(rows) == len(biswas_tables.READINGS) == READINGS
    assert all(len(row) == 4 and all(cell.strip() for cell in row) for row in rows)
    assert pytest.approx(1) == 0.3 * 1.28 + 0.7 * 0.88
    curve, ring = sardf.point(at=(0, 0, 0)), sardf.point(at=(1, 0, 0))
    for exponent, wanted in ((1, 1.125), (2, 0.8333), (3, 0.6)):
        features = [
            {"at": curve, "value": 1 - 1.5 * 0.5, "exponent": exponent},
            {"at": ring, "value": 2},
        ]
        attributes = {"P": {"value": {"inverse_distance": {"features": features}}}}
        scene = sardf.Scene(solid=sardf.sphere(radius=9), attributes=attributes)
        assert scene.attributes["P"]([[0.5, 0, 0]])[0] == pytest.approx(wanted, abs=5e-5)


def distance_to_rectangle(points, center, size):
    """In x and z, 0 within it."""
    beyond = np.abs(points[:, [0, 2]] - center) - np.array(size) / 2
    return np.linalg.norm(np.maximum(beyond, 0), axis=1)


def test_figures_of_the_cutter_are_the_papers_formulas(tmp_path, monkeypatch):
    """4.2: P = 0.2 W1 + 1.0 W2 of silicon carbide, with W1 = u2 / (u1 + u2)."""
    monkeypatch.chdir(ROOT)
    shares, distances = (
        next(d for d in biswas_page.PAPER.drawings() if d.image == f"biswas_{name}.png").words
        for name in ("fig01b", "fig03")
    )
    columns = {}
    for words in (shares, distances):
        assert plot(at_lower_cost(words, tmp_path / "numbers.csv")) == 0
        columns |= csv_of(tmp_path / "numbers.csv")
    points = points_of(columns)
    prism = distance_to_rectangle(points, (0.5, 2.5), (1, 0.6))
    block = distance_to_rectangle(points, (4.5, 1), (3, 2))
    for name, wanted in (("prism", prism), ("block", block)):
        found = columns[f"=max(0, -{name})"]
        inside = np.isfinite(found)
        assert inside.sum() > 100
        np.testing.assert_allclose(found[inside], wanted[inside], rtol=0, atol=1e-12)
    shank = np.isfinite(columns["diamond"]) & (points[:, 2] < 2.79)
    expected = (0.2 * block + prism) / (prism + block)
    found = columns["silicon_carbide"]
    np.testing.assert_allclose(found[shank], expected[shank], rtol=0, atol=1e-12)
    assert columns["diamond"][shank] == pytest.approx(1 - expected[shank])
    chip = np.isfinite(columns["diamond"]) & (points[:, 2] > 2.81)
    assert chip.any()
    assert set(columns["diamond"][chip]) == {1.0}
