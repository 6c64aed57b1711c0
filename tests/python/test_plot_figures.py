"""Figures: colours, lines, labels and scales, read back from the figure or from its pixels."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import sardf
from matplotlib.colors import to_rgb
from matplotlib.image import imread
from plot_scenes import BALL, ball_distance, csv_of, points_of
from sardf import plot
from sardf.plot.__main__ import main

ROOT = Path(__file__).resolve().parents[2]
DPI = 100


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
    return sardf.load(str(ROOT / "scenes/two_ellipsoids.json"))


def rendered(figure, tmp_path):
    """The figure as pixels, and a function that gives the colour at a place of an axes."""
    path = tmp_path / "figure.png"
    plot.save(figure, path, DPI)
    pixels = imread(path)[..., :3]

    def at(axes, across, up):
        column, row = axes.transData.transform((across, up)) * DPI / figure.dpi
        return pixels[len(pixels) - 1 - int(row), int(column)]

    return at


def panels_of(figure):
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def bars_of(figure):
    return [axes for axes in figure.axes if axes.get_label() == "<colorbar>"]


def legend_of(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def test_panels_share_one_scale_unless_asked(ellipsoids):
    blends = ["sardf=0.5", "min_max", "r_function"]
    cut = plot.section(ellipsoids, "y=0", blends=blends, only="inside", resolution=60)
    shared, apart = plot.draw_sections(cut), plot.draw_sections(cut, separate_scales=True)
    for figure, bars in ((shared, 1), (apart, 3)):
        panels = panels_of(figure)
        assert [axes.get_title() for axes in panels] == [f"solid, {blend}" for blend in blends]
        assert len(bars_of(figure)) == bars
    limits = [[axes.collections[0].get_clim() for axes in panels_of(f)] for f in (shared, apart)]
    assert len(set(limits[0])) == 1
    assert len(set(limits[1])) > 1
    assert limits[0][0][0] == 0
    assert limits[0][0][1] >= cut.values["solid, r_function"][~np.isnan(cut.panels[2].shown)].max()


def test_rows_are_quantities_and_columns_blends(ellipsoids):
    cut = plot.section(
        ellipsoids, "y=0", fields=["lying", "both"], fractions=["ochre"],
        blends=["scene", "min_max"], resolution=30,
    )  # fmt: skip
    figure = plot.draw_sections(cut)
    places = [axes.get_subplotspec().rowspan.start for axes in panels_of(figure)]
    assert places == [0, 0, 1, 1, 2, 2]
    assert [bar.get_ylabel() for bar in bars_of(figure)] == ["distance (mm)", "volume fraction"]


def test_only_distances_have_the_unit_of_length():
    fields = {"ball": {"sphere": {"radius": 2}}, "heat": "=exp(-x^2)"}
    text = json.dumps({"sardf": 1, "units": "cm", "fields": fields, "solid": "ball"})
    scene = sardf.Scene.from_json(text)
    values = plot.quantities(scene, ["solid", "ball", "heat", "=x*y"])
    assert [quantity.label for quantity in values] == [
        "distance (cm)", "distance (cm)", "heat", "=x*y",
    ]  # fmt: skip
    errors = plot.quantities(scene, ["ball", "heat"], show="error")
    assert [quantity.label for quantity in errors] == [
        "error against min/max (cm)",
        "error against min/max",
    ]
    cut = plot.section(scene, "z=0", fields=["heat", "ball"], resolution=20)
    figure = plot.draw_sections(cut, separate_scales=True, lines=0.5)
    assert [bar.get_ylabel() for bar in bars_of(figure)] == ["heat", "distance (cm)"]
    along = plot.segment(scene, (0, 0, 0), (1, 0, 0), fields=["heat", "ball"])
    graphs = plot.draw_segment(along, separate_scales=True).axes
    assert [axes.get_ylabel() for axes in graphs] == ["heat", "ball\ndistance (cm)"]


def test_contour_lines_and_bands_stand_where_asked(ball):
    cut = plot.section(ball, "z=0", resolution=200)
    figure = plot.draw_sections(cut, bands=0.25, lines=[-1, 0.5], outline=False)
    filled, lines = panels_of(figure)[0].collections
    assert np.diff(filled.levels) == pytest.approx(0.25)
    assert lines.levels.tolist() == [-1, 0.5]
    for path, radius in zip(lines.get_paths(), (3, 1.5), strict=True):
        assert np.linalg.norm(path.vertices - (1, 0), axis=1) == pytest.approx(radius, abs=2e-3)
    every = plot.draw_sections(cut, lines=0.5)
    assert "contour lines every 0.5 cm" in legend_of(every)


def test_colors_of_a_signed_field_are_centred_at_zero(ball, tmp_path):
    cut = plot.section(ball, "z=0", window=(-4, 6, -3, 3), resolution=100)
    figure = plot.draw_sections(cut, bands="none", lines="none", outline=False, scale_bar=False)
    at = rendered(figure, tmp_path)
    (axes,) = panels_of(figure)
    center, surface, outside = at(axes, 1, 0), at(axes, 3, 0), at(axes, -3.8, 0)
    assert center[0] > center[2] + 0.2
    assert outside[2] > outside[0] + 0.2
    assert np.ptp(surface) < 0.06
    assert surface.min() > 0.9
    assert np.ptp([at(axes, -3.9, 0), at(axes, -3.2, 0)], axis=0).max() > 0.1


def test_length_of_the_gradient_is_white_at_one(ball, tmp_path):
    cut = plot.section(ball, "z=0", fields=["slope"], show="gradient", resolution=200)
    figure = plot.draw_sections(cut, outline=False, scale_bar=False)
    at = rendered(figure, tmp_path)
    (axes,) = panels_of(figure)
    steep, one, flat = (at(axes, x, 0.3) for x in (2, 0.5, 0.05))
    assert one.min() > 0.93
    assert steep[0] > steep[2] + 0.2
    assert flat[2] > flat[1] + 0.2


def test_scale_of_a_fraction_is_from_0_to_1_with_few_ticks(ball):
    figure = plot.draw_sections(plot.section(ball, "z=0", fractions=["red"], resolution=20))
    (bar,) = bars_of(figure)
    assert bar.get_ylim() == (0, 1)
    assert bar.get_yticks() == pytest.approx([0, 0.2, 0.4, 0.6, 0.8, 1])


def test_stripes_of_a_field_are_darker(ball, tmp_path):
    cut = plot.section(ball, "z=0", fractions=["red"], resolution=60)
    colors = []
    for look in ({"bands": 0.25}, {"stripes": 4}):  # 0.3 lies in the second of four
        figure = plot.draw_sections(cut, lines="none", **look)
        colors.append(rendered(figure, tmp_path)(panels_of(figure)[0], 1.3, 0.4))
    assert colors[1] == pytest.approx(0.72 * colors[0], abs=2 / 255)


def test_labels_of_lines_stand_where_something_is_shown(ball):
    cut = plot.section(ball, "z=0", only="inside", resolution=100)
    (axes,) = panels_of(plot.draw_sections(cut, lines=[-0.3, 0.5, 1], label_lines=True))
    shown = {text.get_text() for text in axes.texts if text.get_visible()}
    assert shown == {"0.5", "1"}


def test_mixed_colours_stripes_and_mask(ball, tmp_path):
    """0.3 #c00000 + 0.7 #0000ff in linear light; sRGB's curve as IEC 61966-2-1 prints it."""
    red = 0.3 * ((0xC0 / 255 + 0.055) / 1.055) ** 2.4
    expected = [1.055 * c ** (1 / 2.4) - 0.055 if c else 0 for c in (red, 0, 0.7)]
    cut = plot.section(ball, "z=0", materials=True, resolution=60)
    plain = plot.draw_sections(cut)
    at = rendered(plain, tmp_path)
    (axes,) = panels_of(plain)
    assert at(axes, 1.3, 0.4) == pytest.approx(expected, abs=2 / 255)
    assert at(axes, 1 + 1.6, 1.6).tolist() == [1, 1, 1]
    assert legend_of(plain)[:2] == ["red", "blue"]
    striped = plot.draw_sections(cut, stripes=4)  # 0.3 lies in the second of four
    at = rendered(striped, tmp_path)
    darker = at(panels_of(striped)[0], 1.3, 0.4)
    assert darker == pytest.approx(0.72 * np.array(expected), abs=3 / 255)


def test_outline_is_drawn_unless_not_wanted(ball, tmp_path):
    cut = plot.section(ball, "z=0", only="outside", outlines=["brick"], resolution=100)
    for outline in (True, False):
        figure = plot.draw_sections(cut, outline=outline, scale_bar=False, blank=True)
        at = rendered(figure, tmp_path)
        (axes,) = panels_of(figure)
        surface = min(at(axes, 3 + d, 0.05).max() for d in np.linspace(-0.04, 0.04, 9))
        assert (surface < 0.3) == outline
        edge = np.linspace(-0.4, 0.4, 60)  # longer than a dash and a gap
        brick = [at(axes, -1 + d, up) for d in np.linspace(-0.04, 0.04, 9) for up in edge]
        assert min(np.abs(color - to_rgb("#0072B2")).max() for color in brick) < 0.1
        assert ("outline of the solid" in legend_of(figure)) == outline
        assert axes.get_title() == ""  # nothing of the solid's field is shown
        assert "outline of brick" in legend_of(figure)
        assert not bars_of(figure)


def test_labels_name_axes_units_and_the_scale(ball):
    figure = plot.draw_sections(plot.section(ball, "y=0", attributes=["heat"], resolution=30))
    (axes,) = panels_of(figure)
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (cm)", "z (cm)")
    assert bars_of(figure)[0].get_ylabel() == "heat (°C)"
    (bar,) = axes.artists
    assert bar.txt_label.get_text() == "0.5 cm"
    assert bar.size_bar.get_children()[0].get_width() == 0.5
    wide = plot.draw_sections(plot.section(ball, "y=0", window=(0, 10, 0, 5), resolution=20))
    assert panels_of(wide)[0].artists[0].txt_label.get_text() == "2 cm"
    oblique = plot.section(ball, ((0, 0, 0), (1, 1, 0)), resolution=10)
    (axes,) = panels_of(plot.draw_sections(oblique))
    assert axes.get_xlabel() == "along (−0.707, 0.707, 0) (cm)"
    assert figure.get_suptitle() == "ball, y = 0"


def test_every_look_can_be_drawn_without_a_warning(ellipsoids, tmp_path):
    cut = plot.section(ellipsoids, "y=0", fields=["both", "=1/(x-5)"], resolution=40)
    looks = [
        {"limits": (-1, 1), "colors": "viridis"},
        {"limits": "-1,1", "stripes": 5},
        {"label_lines": True, "lines": 0.5, "limits": (-3, 3)},
        {"bands": 3, "columns": 1, "size": (3, 4), "title": "", "limits": (-3, 3)},
    ]
    for look in looks:
        plot.save(plot.draw_sections(cut, **look), tmp_path / "figure.png", 50)
        assert imread(tmp_path / "figure.png").std() > 0.01


# Graphs along a segment


def test_graphs_with_the_section_above(ball):
    chosen = plot.quantities(ball, ["ball", "brick"], ["red", "blue"])
    line = plot.segment(ball, "-3,0.5,0", "5,0.5,0", chosen, samples=81)
    cut = plot.section(ball, "z=0", chosen[:1], outlines=["brick"], resolution=40)
    figure = plot.draw_segment(line, cut, blank=True)
    above, fields, fractions = panels_of(figure)
    drawn = [artist for artist in above.lines if artist.get_color() == "black"]
    assert [artist.get_xydata().tolist() for artist in drawn] == [[[-3, 0.5], [5, 0.5]]]
    expected = ball_distance(np.column_stack([line.points[:, 0], np.full(81, 0.5), np.zeros(81)]))
    np.testing.assert_allclose(fields.lines[0].get_ydata(), expected, atol=1e-12)
    np.testing.assert_allclose(fields.lines[0].get_xdata(), np.linspace(-3, 5, 81))
    assert [text.get_text() for text in fractions.get_legend().get_texts()] == ["red", "blue"]
    assert fractions.get_xlabel() == "x (cm)"
    assert fields.get_xlim() == above.get_xlim() == (cut.across[0], cut.across[-1])
    assert len(panels_of(plot.draw_segment(line, separate_scales=True))) == 4


def test_oblique_segment_is_drawn_over_its_distance(ball):
    line = plot.segment(ball, (0, 0, 0), (1, 2, 2), samples=5)
    (axes,) = panels_of(plot.draw_segment(line))
    assert axes.get_xlabel() == "distance from (0, 0, 0) (cm)"
    shaded = np.concatenate([path.vertices for path in axes.collections[0].get_paths()])
    inside = line.distance[ball_distance(line.points) >= 0]
    assert (shaded[:, 0].min(), shaded[:, 0].max()) == (inside.min(), inside.max())
    assert axes.lines[0].get_xdata().tolist() == pytest.approx([0, 0.75, 1.5, 2.25, 3])


# Surfaces


def test_surface_of_another_level(ball_file, tmp_path):
    """The level 0.5 of a ball of radius 2 is a ball of radius 1.5."""
    out, picture = tmp_path / "surface.csv", tmp_path / "surface.png"
    words = ["--isosurface", "--level", "0.5", "--resolution", "24", "--view", "1,-2,1"]
    assert main([ball_file, *words, "-o", str(out), "-o", str(picture)]) == 0
    columns = csv_of(out)
    radius = np.linalg.norm(points_of(columns) - (1, 0, 0), axis=1)
    assert list(columns) == ["x", "y", "z", "red", "blue"]
    assert radius == pytest.approx(1.5, abs=2e-3)
    assert columns["red"] == pytest.approx(0.3)
    pixels = imread(picture)[..., :3]
    assert ((pixels[..., 2] - pixels[..., 1]) > 0.3).mean() > 0.05


def test_surfaces_of_fields_and_coloured_by_attributes(ball):
    brick, heat = plot.surfaces(ball, fields=["brick"], attributes=["heat"], resolution=16)
    assert np.abs(brick.vertices).max(axis=1) == pytest.approx(1, abs=1e-6)
    assert brick.values is None
    assert heat.values == pytest.approx(20 + heat.vertices[:, 0])
    figure = plot.draw_surfaces([brick, heat])
    assert [axes.get_title() for axes in panels_of(figure)] == ["brick", "heat"]
    assert [bar.get_ylabel() for bar in bars_of(figure)] == ["heat (°C)"]


def test_faces_whose_corners_normals_cancel_are_drawn(ball):
    (surface,) = plot.surfaces(ball, resolution=8)
    surface.normals[::2] = 0
    assert panels_of(plot.draw_surfaces([surface]))[0].collections


@pytest.mark.parametrize("side", [1, -1])
def test_surface_is_seen_from_the_given_side(ball, side, tmp_path):
    """The heat 20 + x is highest at the pole towards +x: yellow there, dark blue at the other."""
    made = plot.surfaces(ball, attributes=["heat"], resolution=24)
    figure = plot.draw_surfaces(made, view=(side, 0, 0))
    plot.save(figure, tmp_path / "figure.png", DPI)
    pixels = imread(tmp_path / "figure.png")[..., :3]
    (axes,) = panels_of(figure)
    place = axes.get_position()
    row = round((1 - (place.y0 + place.y1) / 2) * len(pixels))
    color = pixels[row, round((place.x0 + place.x1) / 2 * pixels.shape[1])]
    assert (color[0] > color[2] + 0.3) == (side > 0)
    assert (color[2] > color[0]) == (side < 0)


@pytest.mark.skipif(not shutil.which("povray"), reason="needs POV-Ray")
def test_surface_through_povray(ball):
    """The ball fills the picture's middle and none of its corners; a smaller one fills less."""
    sizes = []
    for level in (0, 1.5):
        (quantity,) = plot.quantities(ball)
        view = (0, -1, 0.2)
        shown = plot.picture(quantity, level, view, 64, 48)
        blue = shown[..., 2] - shown[..., 1] > 0.25
        sizes.append(blue.mean())
        assert shown.shape == (48, 64, 3)
        assert blue[24, 32]
        assert not blue[[0, 0, -1, -1], [0, -1, 0, -1]].any()
    assert sizes[0] > 0.1
