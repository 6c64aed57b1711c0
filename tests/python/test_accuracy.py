"""Errors against the true distance, where that is known from a formula."""

import json
import math
import subprocess
import sys

import matplotlib.pyplot as plt
import numpy as np
import pytest
import sardf
import sardf.accuracy
from sardf.accuracy import _reference
from sardf.accuracy.__main__ import main

FEW = 20_000  # triangles, so that these tests are quick


def coarse(what, resolution=32):
    return sardf.accuracy.reference(what, resolution, FEW)


@pytest.fixture(scope="module")
def quadrant():
    """x >= 0 and y >= 0, far from the other ends of the boxes."""
    right = sardf.box(center=(10, 0, 0), size=(20, 40, 40))
    above = sardf.box(center=(0, 10, 0), size=(40, 20, 40))
    return sardf.intersection(right, above)


@pytest.fixture(scope="module")
def ellipsoids():
    a = sardf.ellipsoid(center=(-0.5, 0, 0), radii=(1, 0.6, 0.6))
    b = sardf.ellipsoid(center=(0.5, 0, 0), radii=(0.6, 1, 0.6))
    return sardf.union(a, b, blend=sardf.Sardf(0.5))


def test_a_sphere_is_as_exact_as_the_reference():
    measured = sardf.accuracy.measure(
        sardf.sphere(radius=2), samples=14, reference=coarse(sardf.sphere(radius=2))
    )
    expected = 2 - np.linalg.norm(measured.points, axis=1)
    assert 0 < measured.reference.error < 2e-3
    assert np.abs(measured.true - expected).max() <= measured.reference.error
    assert max(measured.inside.max, measured.outside.max) <= measured.reference.error
    assert measured.inside.points + measured.outside.points == len(measured.points)
    assert measured.exactness == ("exact", "exact")


def test_more_triangles_are_nearer():
    few, many = (sardf.accuracy.reference(sardf.sphere(radius=2), 16, n) for n in (1, 60_000))
    assert len(few.triangles) < FEW < len(many.triangles) <= 60_000
    # From the middle of a chord c on a sphere: c²/(8 r); quads fall short by up to their diagonal.
    edge = 4 / 16
    assert edge**2 / 32 < few.error < edge**2 / 4
    assert many.error < few.error / 3
    assert np.abs(np.linalg.norm(many.vertices, axis=1) - 2).max() < 1e-12


def test_a_box_is_exact():
    box = sardf.box(size=(3, 2, 1))
    measured = sardf.accuracy.measure(box, samples=20, resolution=24)
    assert measured.reference.error < 1e-12
    assert measured.inside.max < 1e-12
    assert measured.outside.max < 1e-12


def test_the_minimum_of_distances_is_none_beside_a_corner(quadrant):
    points = [(-3, -4, 0), (-3, 4, 0), (3, 4, 0), (-6, -8, 1)]
    measured = sardf.accuracy.measure(quadrant, points=points, resolution=24)
    np.testing.assert_allclose(measured.field, [-4, -3, 3, -8], atol=1e-12)
    np.testing.assert_allclose(measured.true, [-5, -3, 3, -10], atol=1e-12)
    np.testing.assert_allclose(measured.error, [-1, 0, 0, -2], atol=1e-12)
    outside = measured.outside
    assert (outside.points, outside.where) == (3, [-6, -8, 1])
    assert outside.max == pytest.approx(2)
    assert outside.mean == pytest.approx(1)
    assert outside.rms == pytest.approx(math.sqrt(5 / 3))
    assert (outside.least, outside.greatest) == pytest.approx((-2, 0), abs=1e-12)
    assert measured.inside.max < 1e-12
    assert (measured.error_bound, measured.exactness) == (0, ("exact", "bound"))


def test_a_union_is_none_inside():
    """Two unit spheres: from the middle to the circle in which they meet it is sqrt(3)/2."""
    both = sardf.union(*(sardf.sphere(center=(x, 0, 0), radius=1) for x in (-0.5, 0.5)))
    surface = coarse(both)
    measured = sardf.accuracy.measure(both, points=[(0, 0, 0), (2, 0, 0)], reference=surface)
    assert measured.error[0] == pytest.approx(0.5 - math.sqrt(3) / 2, abs=2 * surface.error)
    assert measured.error[1] == pytest.approx(0, abs=2 * surface.error)
    assert surface.error < 2e-3


def test_blends_move_errors_by_no_more_than_their_bound(ellipsoids):
    surface = coarse(ellipsoids)  # the zero set is that of the maximum, too
    plain = sardf.with_blend(ellipsoids, blend=sardf.MinMax())
    points = np.random.default_rng(3).uniform((-2, -1.5, -1.2), (1.6, 1.5, 1.2), (4000, 3))
    blended, without = (
        sardf.accuracy.measure(field, points=points, reference=surface)
        for field in (ellipsoids, plain)
    )
    bound = (1 - math.sqrt(0.5)) * 0.5
    assert blended.error_bound == pytest.approx(bound)
    assert np.abs(blended.error - without.error).max() <= bound * (1 + 1e-9)
    # The maximum of distances is exact outside; the blend is never below it.
    assert without.outside.max <= surface.error
    assert 0.1 < blended.outside.max <= bound + surface.error
    assert blended.outside.greatest <= surface.error
    assert np.sign(blended.field).tolist() == np.sign(blended.true).tolist()


def test_what_the_mesh_lacks_is_noticed():
    two = sardf.union(*(sardf.sphere(center=(x, 0, 0), radius=1) for x in (-2, 2)))
    surface = coarse(two, 24)
    assert surface.error < 0.01
    left = surface.vertices[surface.triangles][:, 0, 0] < 0
    away = _reference.missed(two, surface.vertices, surface.triangles[left])
    assert 3.9 < away.max() <= 4.01  # from the right sphere's far end, (3, 0, 0), to (-1, 0, 0)


def test_sections_are_grids():
    sphere = sardf.sphere(center=(1, 0, 0), radius=2)
    cut = sardf.accuracy.measure_section(
        sphere, "y", 0.5, bounds=((-2, -9, -1), (4, 9, 2)), samples=37, reference=coarse(sphere)
    )
    assert (cut.axes, len(cut.across), len(cut.up)) == (("x", "z"), 13, 7)
    expected = 2 - np.sqrt((cut.across[None] - 1) ** 2 + 0.25 + cut.up[:, None] ** 2)
    np.testing.assert_allclose(cut.grid(cut.field), expected, atol=1e-12)
    np.testing.assert_allclose(cut.grid(cut.true), expected, atol=cut.reference.error)
    assert (cut.points[:, 1] == 0.5).all()


def test_scenes_give_their_units_and_fields():
    scene = sardf.Scene(solid=sardf.box(size=(3, 2, 1)), units="cm", title="brick")
    measured = sardf.accuracy.measure(scene, samples=5, resolution=24)
    summary = measured.summary()
    assert summary == json.loads(json.dumps(summary))
    assert (summary["name"], summary["units"]) == ("brick", "cm")
    assert summary["labelled"] == {"inside": "exact", "outside": "exact"}
    assert summary["measured"]["outside"]["points"] == measured.outside.points
    text = measured.text()
    for word in ("brick", "in cm", "proven", "measured", "labelled  exact inside, exact outside"):
        assert word in text
    lines = measured.csv().splitlines()
    assert lines[0] == "x,y,z,field,true,error"
    assert len(lines) == len(measured.points) + 1
    row = [float(number) for number in lines[1].split(",")]
    np.testing.assert_allclose(row[:4], [*measured.points[0], measured.field[0]], rtol=1e-9)


def test_wrong_input(quadrant):
    surface = coarse(quadrant, 24)
    measure = sardf.accuracy.measure
    with pytest.raises(sardf.Error, match="a str was given; a Scene or a Field"):
        measure("part")
    with pytest.raises(sardf.Error, match=r"shape \(2, 2\); \(N, 3\)"):
        measure(quadrant, points=np.zeros((2, 2)), reference=surface)
    with pytest.raises(sardf.Error, match="samples is 1; at least 2"):
        measure(quadrant, samples=1, reference=surface)
    with pytest.raises(sardf.Error, match="lowest corner, highest corner"):
        measure(quadrant, bounds=((0, 0, 0), (1, 1, 0)), reference=surface)
    with pytest.raises(sardf.Error, match="across 'w'; accepted are x, y and z"):
        sardf.accuracy.measure_section(quadrant, "w", 0, reference=surface)
    with pytest.raises(sardf.Error):
        measure(sardf.half_space())


SCENE = {
    "sardf": 1,
    "title": "step",
    "fields": {
        "low": {"box": {"size": [4, 4, 2]}},
        "high": {"box": {"size": [2, 2, 6]}},
        "step": {"union": ["low", "high"]},
    },
    "solid": "step",
}


def command(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "sardf.accuracy", *map(str, arguments)],
        capture_output=True, text=True,
    )  # fmt: skip


def test_command(tmp_path):
    scene, table, points = (tmp_path / name for name in ("s.json", "table.json", "map.csv"))
    scene.write_text(json.dumps(SCENE))
    few = ("--resolution", 16, "--samples", 12)
    done = command(scene, *few, "--blend", "sardf=0.5", "-o", table)
    assert (done.returncode, done.stderr) == (0, "")
    assert "step: error = |field| - |true distance|, in mm" in done.stdout
    found = json.loads(table.read_text())
    assert found["proven"]["error_bound_against_min_max"] == pytest.approx(0.14645, abs=1e-5)
    assert found["measured"]["inside"]["max"] > 0.1
    done = command(scene, *few, "--field", "low", "--section", "z=0.25", "-o", points)
    assert (done.returncode, done.stderr) == (0, "")
    rows = np.loadtxt(points, delimiter=",", skiprows=1)
    assert (rows[:, 2] == 0.25).all()
    assert np.abs(rows[:, 5]).max() < 1e-9  # a box is exact
    assert sorted(p.name for p in tmp_path.iterdir()) == ["map.csv", "s.json", "table.json"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--field", "lwo"], "no field 'lwo'; accepted are low, high, step; did you mean 'low'?"),
        (["--blend", "sardf"], "'sardf=NUMBER' is accepted"),
        (["--blend", "sarf=1"], "did you mean 'sardf'?"),
        (["--blend", "sardf=a"], "blend's radius is 'a'; a finite number is accepted"),
        (["--section", "w=3"], "as in y=0"),
        (["-o", "table.txt"], ".json, .csv, .png, .svg and .pdf can be written"),
    ],
)
def test_wrong_usage_of_the_command(tmp_path, arguments, message):
    scene = tmp_path / "s.json"
    scene.write_text(json.dumps(SCENE))
    done = command(scene, *arguments)
    assert (done.returncode, done.stdout) == (2, "")
    assert message in done.stderr
    assert "Traceback" not in done.stderr


def test_a_map_is_a_picture(tmp_path, capsys):
    """Two unit balls with their centres 1 apart: inside, max is right but near the lens."""
    scene = tmp_path / "balls.json"
    balls = [{"sphere": {"radius": 1}}, {"sphere": {"center": [1, 0, 0], "radius": 1}}]
    scene.write_text(json.dumps({"sardf": 1, "title": "balls", "solid": {"union": {"of": balls}}}))
    picture = tmp_path / "map.png"
    words = [str(scene), "--resolution", "32", "--samples", "40"]
    assert main([*words, "--section", "y=0", "-o", str(picture)]) == 0
    assert "inside" in capsys.readouterr().out
    colors = plt.imread(picture)[:, :, :3]
    # The lens is dark, the rest of the map as light as an error of 0.
    assert colors.min() < 0.3
    assert (colors.min(axis=2) > 0.9).mean() > 0.5
    assert main([*words, "-o", str(tmp_path / "other.png")]) == 2
    assert "a map needs a plane" in capsys.readouterr().err
    assert not (tmp_path / "other.png").exists()
