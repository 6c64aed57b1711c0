"""Arrows and streamlines of vector attributes, against the formulas that they are drawn from."""

import json

import numpy as np
import pytest
import sardf
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb
from matplotlib.image import imread
from matplotlib.quiver import Quiver
from plot_scenes import BALL, ball_distance, csv_of, points_of
from sardf import plot
from sardf.plot.__main__ import main

ATTRIBUTES = BALL["attributes"] | {
    "plane_grain": {"value": ["=-y", "=x"], "unit": "mm"},
    "upright": {"value": [0, 0, 3]},
    "leaning": {"value": [3, 0, 4]},
    "pole": {"value": ["=1/(x - 1)", 1, 0]},
    "nothing": {"value": [0, 0, 0]},
    "four": {"value": [1, 2, 3, 4]},
    "stress": {"value": {"components": {"xx": 1, "xy": "=y", "yy": "=x"}}},
}
WINDOW = "-2,4,-2.5,2.5"


@pytest.fixture(scope="module")
def ball_file(tmp_path_factory):
    path = tmp_path_factory.mktemp("vectors") / "ball.json"
    path.write_text(json.dumps(BALL | {"attributes": ATTRIBUTES}))
    return str(path)


@pytest.fixture(scope="module")
def ball(ball_file):
    return sardf.load(ball_file)


def axes_of(figure):
    (axes,) = (axes for axes in figure.axes if axes.get_label() != "<colorbar>")
    return axes


def labels_of_bars(figure):
    return [axes.get_ylabel() for axes in figure.axes if axes.get_label() == "<colorbar>"]


def legend_of(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def arrows_of(figure):
    (arrows,) = (c for c in axes_of(figure).collections if isinstance(c, Quiver))
    return arrows


def test_arrows_as_csv(ball_file, tmp_path):
    """In y = 0.5, seen along y: -y to the right, 0 upwards, and x away from the viewer."""
    out = tmp_path / "arrows.csv"
    words = ["--section", "y=0.5", "--arrows", "grain", "--window", WINDOW, "--arrow-count", "12"]
    assert main([ball_file, *words, "-o", str(out)]) == 0
    columns = csv_of(out)
    parts = ("x", "y", "z", "right", "up", "towards")
    assert list(columns) == [*"xyz", *(f"grain_{part}" for part in parts)]
    middles = [(-1.75 + 0.5 * i, 0.5, -2.25 + 0.5 * j) for j in range(10) for i in range(12)]
    wanted = np.array([p for p in middles if ball_distance(p) >= 0])
    x, y = wanted[:, 0], wanted[:, 1]
    np.testing.assert_allclose(points_of(columns), wanted, rtol=0, atol=1e-12)
    expected = [-y, x, 0 * x, -y / np.hypot(x, y), 0 * x, -x / np.hypot(x, y)]
    for part, values in zip(parts, expected, strict=True):
        np.testing.assert_allclose(columns[f"grain_{part}"], values, rtol=0, atol=1e-12)


def test_arrows_in_an_oblique_plane(ball):
    """The frame of the plane gives back each vector."""
    cut = plot.section(ball, ((1, 0, 0), (1, -2, 2)), arrows="grain", resolution=20)
    header, rows = cut.table()
    columns = dict(zip(header, rows.T, strict=True))
    frame = [cut.plane.right, cut.plane.up, cut.plane.normal]
    parts = [columns[f"grain_{part}"] for part in ("right", "up", "towards")]
    seen = np.transpose(parts) @ np.array(frame)
    vectors = np.transpose([-columns["y"], columns["x"], np.zeros(len(rows))])
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    np.testing.assert_allclose(seen, vectors / length, rtol=0, atol=1e-12)
    assert len(rows) > 100
    assert ball_distance(points_of(columns)).min() >= 0


def test_equal_arrows_are_projections_of_one_length(ball):
    cut = plot.section(ball, "y=0", window=WINDOW, arrows="leaning", arrow_count=6, resolution=20)
    figure = plot.draw_sections(cut, blank=True)
    arrows = arrows_of(figure)
    assert np.asarray(arrows.V / arrows.U) == pytest.approx(4 / 3)
    assert np.hypot(arrows.U, arrows.V).max() == pytest.approx(0.92 * 1.0)  # one cell is 1 wide
    from_above = plot.section(ball, "z=0", window=WINDOW, arrows="leaning", arrow_count=6)
    arrows = arrows_of(plot.draw_sections(from_above, blank=True))
    drawn = np.transpose([arrows.U, arrows.V, arrows.get_array()])
    np.testing.assert_allclose(drawn, [(0.92 * 3 / 5, 0, 4 / 5)] * len(drawn), atol=1e-12)


def test_scaled_arrows_are_as_long_as_the_vectors(ball):
    cut = plot.section(ball, "z=0", window=WINDOW, arrows="plane_grain", arrow_count=12)
    figure = plot.draw_sections(cut, blank=True, arrow_lengths="scaled")
    arrows = arrows_of(figure)
    x, y = arrows.get_offsets().T
    factor = 0.92 * 0.5 / np.hypot(x, y).max()
    np.testing.assert_allclose(arrows.U, -y * factor, rtol=0, atol=1e-12)
    np.testing.assert_allclose(arrows.V, x * factor, rtol=0, atol=1e-12)
    longest = np.hypot(x, y).max()
    assert f"plane_grain (mm), longest {longest:.4g}" in legend_of(figure)
    assert labels_of_bars(figure) == []  # all of them lie in the plane


def test_colours_tell_the_share_out_of_the_plane(ball, tmp_path):
    colors = []
    for at in ("z=0", ((0, 0, 0), (1e-3, 0, -1)), "y=0"):  # towards, away, in the plane
        cut = plot.section(ball, at, window=WINDOW, arrows="upright", arrow_count=6)
        figure = plot.draw_sections(cut, blank=True, scale_bar=False, outline=False)
        plot.save(figure, tmp_path / "figure.png", 100)
        pixels = imread(tmp_path / "figure.png")[..., :3]
        place = axes_of(figure).transData.transform((0.5, 0)) * 100 / figure.dpi
        colors.append(pixels[len(pixels) - 1 - int(place[1]), int(place[0])])
        bars = [] if at == "y=0" else ["upright: share towards the viewer"]
        assert labels_of_bars(figure) == bars
    assert colors[0] == pytest.approx(to_rgb("#D55E00"), abs=0.02)
    assert colors[1] == pytest.approx(to_rgb("#0072B2"), abs=0.02)
    assert colors[2] == pytest.approx((0, 0, 0), abs=0.02)


def test_streamlines_follow_the_vectors_and_end_at_the_part(ball, tmp_path):
    """Of (-y, x) they are circles around the origin, walked counter-clockwise."""
    cut = plot.section(ball, "z=0", window=WINDOW, streamlines="grain", resolution=200)
    figure = plot.draw_sections(cut, blank=True, scale_bar=False, outline=False)
    axes = axes_of(figure)
    (lines,) = (
        c for c in axes.collections if isinstance(c, LineCollection) and c.get_zorder() == 3
    )
    starts, ends = np.array([s for s in lines.get_segments() if len(s) == 2]).transpose(1, 0, 2)
    steps = ends - starts
    turned = np.transpose([-starts[:, 1], starts[:, 0]])
    lengths = np.linalg.norm(steps, axis=1), np.linalg.norm(turned, axis=1)
    clear = (lengths[0] > 1e-3) & (lengths[1] > 0.3)
    assert clear.sum() > 300
    along = (steps * turned).sum(axis=1)[clear] / (lengths[0] * lengths[1])[clear]
    assert along.min() > np.cos(np.radians(8))  # a chord turns by half of its arc
    assert np.abs(np.linalg.norm(ends, axis=1) - lengths[1]).max() < 0.02
    plot.save(figure, tmp_path / "figure.png", 100)
    pixels = imread(tmp_path / "figure.png")[..., :3].min(axis=-1)
    left, bottom, width, height = (v * 100 / figure.dpi for v in axes.bbox.bounds)
    up, across = np.mgrid[3 : height - 3, 3 : width - 3]
    shown = pixels[(len(pixels) - 1 - bottom - up).astype(int), (left + across).astype(int)]
    distance = ball_distance(
        np.stack([-2 + 6 * across / width, -2.5 + 5 * up / height, 0 * up], axis=-1)
    )
    assert (shown[distance < -0.03] == 1).all()
    near = (distance > 0) & (distance < 0.5)
    assert 0.05 < (shown[near] < 0.5).mean() < 0.5


def test_vectors_over_the_materials_colours(ball, tmp_path):
    plain, with_arrows = (
        plot.section(ball, "z=0", materials=True, resolution=100, arrows=name)
        for name in (None, "grain")
    )
    pictures = []
    for cut in (plain, with_arrows):
        figure = plot.draw_sections(cut, size=(6, 5))
        plot.save(figure, tmp_path / "figure.png", 80)
        pictures.append(imread(tmp_path / "figure.png")[..., :3])
        assert legend_of(figure)[:2] == ["red", "blue"]
        assert axes_of(figure).get_title() == "materials"
    changed = np.abs(pictures[0] - pictures[1]).max(axis=-1) > 0.1
    assert 0.02 < changed.mean() < 0.3
    assert legend_of(figure)[-1] == "direction of grain"


def test_panels_of_blends_have_their_own_vectors(ball_file, tmp_path, capsys):
    words = ["--section", "z=0", "--materials", "--blend", "scene", "min_max", "--arrows", "grain"]
    picture, table = str(tmp_path / "figure.svg"), str(tmp_path / "table.csv")
    assert main([ball_file, *words, "--resolution", "40", "-o", picture]) == 0
    assert main([ball_file, *words, "-o", table]) == 2
    assert "the vectors of 2 blends do not fit into one CSV file" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["grain", "plane_grain", "pole", "leaning"])
@pytest.mark.parametrize("kind", ["arrows", "streamlines"])
def test_each_kind_is_drawn_alone_and_reproducibly(ball_file, tmp_path, kind, name):
    """Where an attribute is 1/0 there is no arrow, and nothing warns."""
    words = [ball_file, "--section", "z=0", f"--{kind}", name, "--arrow-count", "12"]
    written = []
    for index in range(2):
        path = tmp_path / f"{index}.svg"
        assert main([*words, "-o", str(path)]) == 0
        written.append(path.read_bytes())
    assert written[0] == written[1]
    assert len(written[0]) > 20_000


def test_a_section_above_graphs_has_vectors(ball_file, tmp_path):
    words = ["--segment", "-0.5,0,0", "2,0,0", "--section", "z=0", "--attribute", "heat"]
    sizes = []
    for extra in ([], ["--streamlines", "grain"]):
        path = tmp_path / "graphs.svg"
        assert main([ball_file, *words, *extra, "--resolution", "40", "-o", str(path)]) == 0
        sizes.append(len(path.read_bytes()))
    assert sizes[1] > sizes[0] + 10_000


# What is typed | what the answer contains.
WRONG_INPUT = """
--section z=0 --arrows grian | there is no attribute 'grian'; accepted are heat, grain
--section z=0 --arrows grian | did you mean 'grain'?
--section z=0 --streamlines heat | the attribute 'heat' is a number
--section z=0 --arrows stress | the attribute 'stress' is made of the components xx, xy, yy
--section z=0 --arrows four | the attribute 'four' is a vector of 4 components
--section z=7 --arrows grain | in this window, none of its arrows lies inside the solid
--section z=0 --window=5,6,5,6 --streamlines grain | none of its streamlines lies inside the solid
--section z=0 --arrows nothing | where it is shown, it is 0 or not finite
--section z=0 --streamlines upright | it is perpendicular to it; arrows can show that
--section z=0 --arrows grain --arrow-count 0 | the arrow count is 0; 1 to 400
--section z=0 --streamlines leaning --arrow-count 1 --window=-60,60,-60,60 | a larger arrow count
"""


@pytest.mark.parametrize("case", WRONG_INPUT.strip().splitlines())
def test_wrong_input_gets_one_clear_sentence(ball_file, tmp_path, case, capsys):
    words, said = case.split(" | ")
    assert main([ball_file, *words.split(), "-o", str(tmp_path / "figure.png")]) == 2
    message = capsys.readouterr().err
    assert message.startswith("sardf.plot: ")
    assert said in message
    assert message.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "words", ["--isosurface --arrows grain", "--section z=0 --arrows grain --streamlines grain"]
)
def test_wrong_usage(ball_file, words, capsys):
    with pytest.raises(SystemExit) as ended:
        main([ball_file, "-o", "figure.png", *words.split()])
    assert ended.value.code == 2
    assert "sardf.plot: error:" in capsys.readouterr().err


def test_both_kinds_from_python_are_refused(ball):
    with pytest.raises(sardf.Error, match="one at a time"):
        plot.section(ball, "z=0", arrows="grain", streamlines="grain")
