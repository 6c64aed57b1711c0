"""Contours from SVG drawings: distances from the drawn curves are those of formulas."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest
import sardf
import sardf.svg

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="{}" viewBox="{}">\n'
INKSCAPE = "http://www.inkscape.org/namespaces/inkscape"
SQUARE = '<path id="square" d="M0 0 h2 v2 h-2 z"/>\n'


@pytest.fixture
def draw(tmp_path):
    """Writes a drawing whose elements begin in line 2; returns its path."""

    def write(body, view="0 0 100 100"):
        path = tmp_path / "drawing.svg"
        path.write_text(HEAD.format(INKSCAPE, view) + body + "</svg>\n")
        return path

    return write


def read(path, tolerance=0.01, **options):
    return sardf.svg.read_contours(path, tolerance, **options)


def along(points, count=20):
    """Points on the edges of a closed polyline, the vertices among them."""
    t = np.linspace(0, 1, count, endpoint=False)[None, :, None]
    ends = np.roll(points, -1, axis=0)
    return (points[:, None] * (1 - t) + ends[:, None] * t).reshape(-1, 2)


def distances_to_polyline(points, vertices):
    """From each point to the nearest edge of a closed polyline, all pairs."""
    ends = np.roll(vertices, -1, axis=0)
    direction = ends - vertices
    t = np.einsum("pnk,nk->pn", points[:, None] - vertices, direction)
    t = np.clip(t / (direction**2).sum(axis=1), 0, 1)
    return np.linalg.norm(points[:, None] - vertices - t[..., None] * direction, axis=2).min(axis=1)


def area(points):
    x, y = points.T
    return abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


@pytest.mark.parametrize("tolerance", [1, 0.1, 1e-3, 1e-6])
def test_circle_is_within_the_tolerance_and_not_finer_than_needed(draw, tolerance):
    contour = read(draw('<circle id="c" cx="30" cy="20" r="10"/>'), tolerance)["c"]
    away = np.abs(np.linalg.norm(along(contour) - (30, -20), axis=1) - 10)
    assert away.max() <= tolerance
    needed = math.pi / math.acos(1 - tolerance / 10)
    assert max(needed, 4) <= len(contour) <= 2.1 * needed + 4


def test_elliptical_arcs_under_a_skew(draw):
    """A half ellipse of radii 8 and 3, turned by 30 degrees, then skewed: points of the image."""
    body = '<path id="e" transform="skewX(40)" d="M 6.9282032302755 4 A 8 3 30 0 1'
    path = draw(body + ' -6.9282032302755 -4 L 6.9282032302755 4 Z"/>')
    contour = read(path, 0.001)["e"]
    t = np.linspace(0, np.pi, 4001)
    c, s = math.cos(math.pi / 6), math.sin(math.pi / 6)
    x = 8 * np.cos(t) * c - 3 * np.sin(t) * s
    y = 8 * np.cos(t) * s + 3 * np.sin(t) * c
    curve = np.column_stack([x + math.tan(math.radians(40)) * y, -y])
    assert distances_to_polyline(curve, contour).max() <= 0.001
    closed = np.vstack([curve, curve[0] * 0.5 + curve[-1] * 0.5])
    assert distances_to_polyline(along(contour, 3), closed).max() <= 0.001
    assert len(contour) < 200


def test_radii_too_small_for_their_ends_grow(draw):
    contour = read(draw('<path id="c" d="M 0 0 A 1 1 0 0 1 10 0 A 1 1 0 0 1 0 0 z"/>'))["c"]
    away = np.linalg.norm(contour - (5, 0), axis=1) - 5
    assert np.abs(away).max() < 1e-12


@pytest.mark.parametrize("tolerance", [0.1, 1e-3, 1e-4])
@pytest.mark.parametrize(
    ("data", "control"),
    [
        ("M0 0 C 30 0 10 50 60 20 V -20 H 0 Z", [(0, 0), (30, 0), (10, 50), (60, 20)]),
        ("M0 0 q 40 90 50 0 v -20 h -50 z", [(0, 0), (40, 90), (50, 0)]),
    ],
)
def test_bezier_curves(draw, data, control, tolerance):
    contour = read(draw(f'<path id="b" d="{data}"/>'), tolerance)["b"]
    n = len(control) - 1
    t = np.linspace(0, 1, 3000)[:, None]
    curve = sum(
        math.comb(n, i) * t**i * (1 - t) ** (n - i) * np.array(p) * (1, -1)
        for i, p in enumerate(control)
    )
    worst = distances_to_polyline(curve, contour).max()
    assert worst <= tolerance
    assert worst > tolerance / 8  # halving a chord divides its distance by 4


def test_a_straight_cubic_is_one_edge(draw):
    contour = read(draw('<path id="b" d="M0 0 C 9 0 9.5 0 10 0 L 10 5 z"/>'), 1e-4)["b"]
    assert contour.tolist() == [[0, 0], [10, 0], [10, -5]]


def test_transforms_nest_and_y_turns_upwards(draw):
    body = """<g transform="translate(10 20)"><g transform="rotate(90) scale(2, 3)">
      <polygon id="p" points="1,0 2,0 2,1"/></g></g>"""
    contour = read(draw(body))["p"]
    expected = [[10, -22], [10, -24], [7, -24]]  # (x, y) -> (10 - 3y, 20 + 2x), then y negated
    np.testing.assert_allclose(contour, expected, atol=1e-12)


def test_mirrored_shapes_keep_their_form(draw):
    body = '<path id="p" transform="scale(-1 1)" d="M 1 0 A 1 1 0 0 1 -1 0 z"/>'
    contour = read(draw(body), 1e-4)["p"]
    assert contour[:, 1].max() <= 1e-12  # sweep 1 is downwards on the page, and stays there
    assert area(contour) == pytest.approx(math.pi / 2, abs=1e-3)


def test_coordinates_are_those_of_the_view_box(tmp_path):
    path = tmp_path / "view.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="80mm" height="40mm"'
        ' viewBox="10 10 200 100"><rect x="10%" y="20%" width="50%" height="1in"/></svg>'
    )
    expected = np.array([[20, -20], [120, -20], [120, -116], [20, -116]])
    np.testing.assert_allclose(read(path)["path_1"], expected, atol=1e-12)
    np.testing.assert_allclose(read(path, scale=0.25)["path_1"], expected / 4, atol=1e-12)


def test_the_tolerance_counts_after_the_scale(draw):
    path = draw('<circle id="c" r="10"/>')
    assert len(read(path, 0.1, scale=10)["c"]) == len(read(path, 0.01)["c"])


def test_rounded_rectangles(draw):
    contour = read(draw('<rect id="r" width="8" height="6" rx="2"/>'), 1e-4)["r"]
    assert area(contour) == pytest.approx(48 - (4 - math.pi) * 4, abs=2e-3)


def test_each_subpath_is_a_contour(draw):
    path = draw('<path id="ring" d="M0 0 h9 v9 h-9 z m3 3 v3 h3 v-3 z l -2 0 v-2 z"/>')
    contours = read(path)
    assert list(contours) == ["ring_1", "ring_2", "ring_3"]
    assert [area(contour) for contour in contours.values()] == [81, 9, 2]
    field = sardf.polygon(contours["ring_1"]) - sardf.polygon(contours["ring_2"])
    assert field([(1.5, -4.5, 0), (4.5, -4.5, 0), (10, -4.5, 0)]) == pytest.approx([1.5, -1.5, -1])
    assert list(read(path, only=["ring_2"])) == ["ring_2"]


def test_names(draw):
    body = f"""{SQUARE}<rect width="1" height="1"/>
      <circle inkscape:label="outer rim" r="1"/><polygon id="3-b" points="0 0 1 0 1 1"/>
      <polyline points="0 0 1 0 1 1 0 0"/>"""
    assert list(read(draw(body))) == ["square", "path_1", "outer_rim", "_3_b", "path_2"]


def test_repeated_and_straight_vertices_are_removed(draw):
    body = '<path id="p" d="M 1 0 H 2 2 H 4 V 1 V 1 L 4 2 L 0 2 V 0 L 1 0 Z"/>'
    assert sorted(read(draw(body))["p"].tolist()) == [[0, -2], [0, 0], [4, -2], [4, 0]]


def test_what_is_not_drawn_is_not_read(draw):
    body = """<defs><path d="M0 0 L1 1"/><text>no</text></defs><g style="display:none">
      <image/></g><title>t</title><clipPath id="c"><path d="M0 0 h1"/></clipPath>"""
    assert list(read(draw(body + SQUARE))) == ["square"]


WRONG = {
    "open": ('<path id="p" d="M0 0 h2 v2"/>', 3, '<path id="p">.*contour is open'),
    "open subpath": ('<path id="p" d="M0 0 h2 v2 z M 5 5 h1 v1"/>', 3, "contour is open"),
    "line": ('<line x1="0" y1="0" x2="3" y2="3"/>', 3, "<line>.*contour is open"),
    "text": ("<text>words</text>", 3, "text has no contour"),
    "image": ("\n<image/>", 4, "image has no contour"),
    "clone": ('<use href="#square"/>', 3, "clones are not read"),
    "clip path": ('<g clip-path="url(#c)">\n<circle r="1"/></g>', 4, "<g> has a clip-path"),
    "mask": ('<circle id="c" r="1" style="mask: url(#m)"/>', 3, "<circle> has a mask"),
    "inner drawing": ("<svg><circle r='1'/></svg>", 3, "drawings inside a drawing"),
    "style": ('<circle style="r:4"/>', 3, "its style sets 'r'"),
    "style sheet": ("<style>.a {transform: none}</style>", 3, "a style sheet sets 'transform'"),
    "crossing": ('<path d="M0 0 L4 4 L4 0 L0 4 z"/>', 3, r"edges 0-1 near \(0, 0\) and 2-3 near"),
    "touching": ('<path d="M0 0 h8 v4 h-2 l-2 -4 l-2 4 h-2 z"/>', 3, "edges 0-1 .* cross or touch"),
    "fold": ('<path d="M0 0 h8 v4 v-6 h-8 z"/>', 3, "edges 1-2 .* and 2-3 .* cross or touch"),
    "two points": ('<path id="p" d="M0 0 h8 z"/>', 3, "degenerates to 2 points"),
    "no size": ('<rect id="p" width="3"/>', 3, "'height' is 0"),
    "negative": ('<circle r="-1"/>', 3, "'r' is -1"),
    "path data": ('<path d="M0 0 h8 v3 foo"/>', 3, "cannot be read from 'foo' on"),
    "half a pair": ('<path d="M0 0 L 8 8 3 z"/>', 3, "cannot be read near character"),
    "no start": ('<path d="h8 v3 z"/>', 3, "does not begin with M"),
    "points": ('<polygon points="0 0 1 0 1"/>', 3, "5 numbers"),
    "transform": ('<g transform="turn(3)"/>', 3, r"transform 'turn\(3\)' cannot be read"),
    "units": ('<circle r="2em"/>', 3, "'2em' is no length for 'r'"),
    "same name": ('<circle id="square" r="1"/>', 3, "another contour is named 'square'"),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_errors_name_file_line_and_element(draw, wrong):
    body, line, message = WRONG[wrong]
    path = draw(SQUARE + body)
    with pytest.raises(sardf.Error, match=f"drawing.svg:{line}: .*{message}") as raised:
        read(path, 1e-3)
    assert (raised.value.file, raised.value.line) == (str(path), line)
    assert raised.value.pointer.startswith("<")
    if wrong not in ("style sheet", "transform", "same name"):
        assert list(read(draw(SQUARE + body), only=["square"])) == ["square"]


def test_errors_of_the_whole_drawing(draw, tmp_path):
    with pytest.raises(sardf.Error, match="svg:2: .*only open curves"):
        read(draw('<path d="M0 0 h2"/>'))
    with pytest.raises(sardf.Error, match="has no closed contour"):
        read(draw(""))
    with pytest.raises(sardf.Error, match="svg:3: this is no XML: mismatched tag"):
        read(draw("<g>\n"))
    with pytest.raises(sardf.Error, match="cannot be read: No such file"):
        read(tmp_path / "none.svg")
    page = tmp_path / "page.html"
    page.write_text("<html></html>")
    with pytest.raises(sardf.Error, match="html:1: <html>: this is no SVG drawing"):
        read(page)
    page.write_text('<svg><circle r="10%"/></svg>')
    with pytest.raises(sardf.Error, match="'r' is 10%, and the drawing has no viewBox"):
        read(page)


@pytest.mark.parametrize("wrong", [0, -1, math.nan, math.inf, "1"])
def test_tolerance_and_scale_are_positive(draw, wrong):
    path = draw(SQUARE)
    with pytest.raises(sardf.Error, match="tolerance is .*; a positive number"):
        read(path, wrong)
    with pytest.raises(sardf.Error, match="scale is .*; a positive number"):
        read(path, scale=wrong)
    with pytest.raises(sardf.Error, match="finer than 1e-09 of its largest coordinate, 2"):
        read(path, 1e-12)


def test_unknown_names_get_the_nearest(draw):
    with pytest.raises(sardf.Error, match="named 'sqare'; .*did you mean 'square'"):
        read(draw(SQUARE), only=["sqare"])
    with pytest.raises(sardf.Error, match="no contour is named 'square_2'"):
        read(draw(SQUARE), only=["square_2"])


def test_large_contours_are_checked_quickly(draw):
    """A comb of 3000 teeth, then the same with its last tooth bent across the others."""
    teeth = " ".join(f"{i * 0.01} {5 if i % 2 else 40}" for i in range(6000))
    assert len(read(draw(f'<polygon id="p" points="{teeth} 60 90 0 90"/>'))["p"]) == 6002
    with pytest.raises(sardf.Error, match="cross or touch"):
        read(draw(f'<polygon id="p" points="{teeth} -1 30 0 90"/>'))


def test_a_missing_library_is_named(draw, monkeypatch):
    path = draw(SQUARE)
    monkeypatch.setitem(sys.modules, "svgelements.svgelements", None)
    with pytest.raises(ImportError, match=r"not installed: pip install 'sardf\[svg\]'"):
        read(path)


def command(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "sardf.svg", *map(str, arguments)], capture_output=True, text=True
    )


def test_command_writes_fields_of_a_scene(draw, tmp_path):
    out = tmp_path / "fields.json"
    path = draw(SQUARE + "<text>label</text>")
    done = command(path, "--tolerance", 0.01, "--only", "square", "-o", out)
    assert (done.returncode, done.stderr) == (0, "")
    fields = json.loads(out.read_text())
    assert fields == {"square": {"polygon": {"vertices": [[0, 0], [2, 0], [2, -2], [0, -2]]}}}
    fields["plate"] = {"extrude": {"field": "square", "height": 2}}
    scene = sardf.Scene.from_json(json.dumps({"sardf": 1, "fields": fields, "solid": "plate"}))
    assert scene.solid((1, -0.5, 0)) == pytest.approx(0.5)
    shown = command(draw(SQUARE), "--tolerance", 0.01, "--implicit", "-o", "-")
    assert list(json.loads(shown.stdout)["square"]) == ["implicit_polygon"]
    assert [p.name for p in tmp_path.iterdir() if p.name.startswith(".")] == []


def test_exit_codes_of_the_command(draw, tmp_path):
    wrong = command(draw("<text/>"), "--tolerance", 0.01, "-o", "-")
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert wrong.stderr.startswith("sardf.svg: ")
    assert "drawing.svg:2: <text>" in wrong.stderr
    usage = command(draw(SQUARE), "-o", "-")
    assert (usage.returncode, "--tolerance" in usage.stderr) == (2, True)
    failed = command(draw(SQUARE), "--tolerance", 0.01, "-o", tmp_path / "none" / "a.json")
    assert failed.returncode == 1
    assert "Traceback" not in failed.stderr + wrong.stderr
    named = command(draw('<circle id="x" r="1"/>'), "--tolerance", 0.01, "-o", "-")
    assert (named.returncode, "cannot be named 'x'" in named.stderr) == (2, True)
