"""The shipped scenes in Python: bounds, fractions, meshes, bakes, round trip."""

import json
from pathlib import Path

import manifold3d
import numpy as np
import pytest
import sardf
import scipy.sparse
import scipy.spatial
import trimesh
from sardf import _image

ROOT = Path(__file__).resolve().parents[2]
SCENES = sorted((ROOT / "scenes").glob("*.json"))
RESOLUTION = 128
# Euler characteristics counted by hand: 2 - 2 × (through holes) for each connected piece.
EULER = {
    "two_ellipsoids": 2,
    "cad_pins": 2,
    "cad_pins_stripes": 2,
    "cad_plate": 0,
    "cad_plate_cut": 2,
    "cad_plate_stripes": 2,
    "diamond_cutter": 2,
    "exponents": 2,
    "forged_lever": 0,
    "hardened_gear": 0,
    "lined_bore": -4,
    "s_and_ring": 2,
    "s_curve": 2,
    "spline_surface": 2,
    "three_materials": 2,
    "turbine_blade": 2,
    "tooth": 2,
    "tooth_cut": 2,
    "tooth_slice": 2,
    "tooth_stripes": 2,
}


@pytest.fixture(scope="module", params=SCENES, ids=lambda path: path.stem)
def scene(request):
    loaded = sardf.load(str(request.param))
    loaded_name = request.param.stem
    return loaded_name, loaded


@pytest.fixture(scope="module")
def surface(scene):
    return scene[1].mesh(resolution=RESOLUTION)


def triangles(mesh):
    """Triangles of the quads, those of a repeated index left out."""
    faces = mesh.faces
    both = np.concatenate([faces[:, (0, 1, 2)], faces[:, (0, 2, 3)]])
    return both[
        (both[:, 0] != both[:, 1]) & (both[:, 1] != both[:, 2]) & (both[:, 0] != both[:, 2])
    ]


def cell_of(scene):
    low, high = np.array(scene.bounds[0]), np.array(scene.bounds[1])
    return (high - low).max() / RESOLUTION


def test_solid_is_empty_outside_its_bounds(scene):
    low, high = (np.array(corner) for corner in scene[1].bounds)
    points = np.random.default_rng(3).uniform(low - (high - low), high + (high - low), (20000, 3))
    outside = np.any((points < low) | (points > high), axis=1)
    assert scene[1].solid(points[outside]).max() < 0


def test_fractions_are_a_partition_of_unity(scene):
    low, high = (np.array(corner) for corner in scene[1].bounds)
    points = np.random.default_rng(4).uniform(low, high, (5000, 3))
    fractions = scene[1].fractions(points)
    assert fractions.shape == (5000, len(scene[1].materials))
    assert fractions.min() >= 0
    np.testing.assert_allclose(fractions.sum(axis=1), 1, rtol=0, atol=1e-12)


def test_outside_can_be_marked(scene):
    low, high = (np.array(corner) for corner in scene[1].bounds)
    points = np.random.default_rng(5).uniform(low, high, (2000, 3))
    marked = np.isnan(scene[1].fractions(points, outside="nan")).any(axis=1)
    np.testing.assert_array_equal(marked, scene[1].solid(points) < 0)


def test_mesh_is_closed_and_manifold(scene, surface):
    body = trimesh.Trimesh(surface.vertices, triangles(surface), process=False)
    assert body.is_watertight
    assert body.is_winding_consistent
    assert body.volume > 0
    solid = manifold3d.Manifold(
        manifold3d.Mesh(
            vert_properties=surface.vertices.astype(np.float32),
            tri_verts=triangles(surface).astype(np.uint32),
        )
    )
    assert solid.status() == manifold3d.Error.NoError


def test_euler_characteristic(scene, surface):
    name, loaded = scene
    body = trimesh.Trimesh(surface.vertices, triangles(surface), process=False)
    if name in EULER:
        assert body.euler_number == EULER[name]
    else:
        finer = loaded.mesh(resolution=2 * RESOLUTION, size=0)
        assert (
            body.euler_number
            == trimesh.Trimesh(finer.vertices, triangles(finer), process=False).euler_number
        )


def test_vertices_lie_on_the_surface(scene, surface):
    _, loaded = scene
    value, gradient = loaded.drawn(surface.vertices), loaded.drawn.gradient(surface.vertices)
    steep = np.linalg.norm(gradient, axis=1)
    known = steep > 0
    distance = np.abs(value[known]) / steep[known]
    assert known.mean() > 0.99
    assert distance.max() <= 0.005 * cell_of(loaded)


def box_edges(low, high):
    """Points along the twelve edges of a box."""
    low, high, share = np.array(low), np.array(high), np.linspace(0, 1, 400)[:, None]
    corners = [np.where([i & 1, i & 2, i & 4], high, low) for i in range(8)]
    pairs = [(i, i | bit) for i in range(8) for bit in (1, 2, 4) if not i & bit]
    return np.concatenate([corners[i] + share * (corners[j] - corners[i]) for i, j in pairs])


def rim(center, axis, radius):
    """Points along a circle around the y or the z axis."""
    angle = np.linspace(0, 2 * np.pi, 2000)
    a, b = radius * np.cos(angle), radius * np.sin(angle)
    ring = [a, 0 * a, b] if axis == "y" else [a, b, 0 * a]
    return np.array(center) + np.transpose(ring)


# Edges of the solids as their scene files describe them.
EDGES = {
    "cad_pins": box_edges((-5, -5, -3), (5, 5, 3)),
    "lined_bore": np.concatenate(
        [rim((0, y, 28), "y", 11) for y in (-17, 17)]
        + [rim((x, 0, z), "z", 3.5) for x in (-32, 32) for z in (0, 12)]
    ),
}


@pytest.mark.parametrize("name", EDGES)
def test_edges_are_sharp_and_in_their_place(name):
    loaded = sardf.load(str(ROOT / "scenes" / f"{name}.json"))
    surface = loaded.mesh(resolution=RESOLUTION, size=0)
    true, cell = EDGES[name], cell_of(loaded)
    sharp = surface.vertices[np.unique(surface.creases)]
    distance, _ = scipy.spatial.cKDTree(true).query(sharp)
    on_edge = distance < 0.5 * cell
    spacing = np.linalg.norm(np.diff(true[:400], axis=0), axis=1).max()
    assert on_edge.sum() > 0.5 * len(true) * spacing / cell
    # The nearest point of the samples is up to half a spacing off along the edge.
    along = np.sqrt(np.maximum(distance[on_edge] ** 2 - (spacing / 2) ** 2, 0))
    assert along.max() <= 0.02 * cell
    # And no part of an edge is missing: a vertex stands on it at least every second cell.
    assert scipy.spatial.cKDTree(sharp).query(true)[0].max() <= 2 * cell


def test_volume_agrees_with_the_field(scene, surface):
    """The mesh's volume against counting random points: an estimate that shares no code."""
    _, loaded = scene
    low, high = (np.array(corner) for corner in loaded.bounds)
    points = np.random.default_rng(6).uniform(low, high, (400_000, 3))
    share = (loaded.drawn(points) >= 0).mean()
    spread = np.sqrt(share * (1 - share) / len(points))
    body = trimesh.Trimesh(surface.vertices, triangles(surface), process=False)
    assert body.volume / np.prod(high - low) == pytest.approx(share, abs=5 * spread + 1e-4)


def test_atlas(scene, surface):
    uv = surface.uv
    assert uv.shape == (4 * len(surface.faces), 2)
    assert uv.min() >= 0
    assert uv.max() <= 1
    corners = uv.reshape(-1, 4, 2)
    area = 0.0
    for a, b, c in ((0, 1, 2), (0, 2, 3)):
        e, f = corners[:, b] - corners[:, a], corners[:, c] - corners[:, a]
        signed = (e[:, 0] * f[:, 1] - e[:, 1] * f[:, 0]) / 2
        assert signed.min() > -1e-9
        area += signed.sum()
    assert area >= 0.55
    assert chart_count(surface) <= 60


def chart_count(surface):
    """Charts: faces joined wherever they share an edge with the same texture coordinates."""
    keys = np.concatenate([surface.faces.reshape(-1, 1), surface.uv.round(7)], axis=1)
    _, corner = np.unique(keys, axis=0, return_inverse=True)
    corner = corner.reshape(-1, 4)
    start, end = corner.ravel(), np.roll(corner, -1, axis=1).ravel()
    size = corner.max() + 1
    graph = scipy.sparse.coo_matrix((np.ones(len(start)), (start, end)), (size, size))
    return scipy.sparse.csgraph.connected_components(graph, directed=False)[0]


def bilinear(image, uv):
    """The bilinear lookup of an image, row 0 at the top, clamped at its border."""
    height, width = image.shape[:2]
    x = np.clip(uv[:, 0] * width - 0.5, 0, width - 1)
    y = np.clip((1 - uv[:, 1]) * height - 0.5, 0, height - 1)
    i, j = np.minimum(x.astype(int), width - 2), np.minimum(y.astype(int), height - 2)
    s, t = (x - i)[:, None], (y - j)[:, None]
    top = image[j, i] * (1 - s) + image[j, i + 1] * s
    bottom = image[j + 1, i] * (1 - s) + image[j + 1, i + 1] * s
    return top * (1 - t) + bottom * t


def random_surface_points(surface, count, seed):
    """Points, their texture coordinates: uniform over the triangles' areas."""
    rng = np.random.default_rng(seed)
    faces, uv = surface.faces, surface.uv.reshape(-1, 4, 2)
    corners = surface.vertices[faces]
    points = np.concatenate([corners[:, (0, 1, 2)], corners[:, (0, 2, 3)]])
    coordinates = np.concatenate([uv[:, (0, 1, 2)], uv[:, (0, 2, 3)]])
    area = np.linalg.norm(
        np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]), axis=1
    )
    chosen = rng.choice(len(area), count, p=area / area.sum())
    a, b = rng.random((2, count))
    a, b = np.where(a + b > 1, 1 - a, a), np.where(a + b > 1, 1 - b, b)
    weights = np.stack([1 - a - b, a, b], axis=1)[:, :, None]
    return (points[chosen] * weights).sum(axis=1), (coordinates[chosen] * weights).sum(axis=1)


def test_texture_lookup_is_the_volume(scene, surface):
    """>= 10 000 points: a lookup of the 2048² texture against the exact path."""
    name, loaded = scene
    maps = loaded.bake(surface, size=2048, channels=("fractions",))
    points, uv = random_surface_points(surface, 12_000, 8)
    # The mesh's chords lie within a small part of a cell of the surface: the exact foot is found.
    gradient = loaded.drawn.gradient(points)
    squared = (gradient**2).sum(axis=1, keepdims=True)
    points = points - loaded.drawn(points)[:, None] * gradient / np.where(squared > 0, squared, 1)
    exact = loaded.fractions(points)
    looked_up = np.concatenate([bilinear(maps[key], uv) for key in sorted(maps)], axis=1)
    error = np.abs(looked_up[:, : exact.shape[1]] - exact).max(axis=1)
    smooth = ~near_discontinuity(loaded, points, surface)
    assert np.isfinite(looked_up).all()
    assert smooth.mean() > 0.8, name
    assert np.quantile(error[smooth], 0.99) <= 0.004


def near_discontinuity(loaded, points, surface):
    """Whether fractions jump within about one texel of a point: by much over a tiny step."""
    area = trimesh.Trimesh(surface.vertices, triangles(surface), process=False).area
    texel = np.sqrt(area / (0.55 * 2048**2))
    jumps = np.zeros(len(points), dtype=bool)
    for axis in range(3):
        for side in (-1, 1):
            near = points + side * 1.5 * texel * np.eye(3)[axis]
            jumps |= np.abs(loaded.fractions(near) - loaded.fractions(points)).max(axis=1) > 0.2
    return jumps


def test_round_trip(scene):
    _, loaded = scene
    again = sardf.Scene.from_json(loaded.to_json())
    points = np.random.default_rng(9).uniform(*np.array(loaded.bounds), (2000, 3))
    np.testing.assert_array_equal(again.solid(points), loaded.solid(points))
    np.testing.assert_array_equal(again.fractions(points), loaded.fractions(points))
    assert json.loads(again.to_json()) == json.loads(loaded.to_json())


def test_povray_files_of_a_scene(tmp_path):
    loaded = sardf.load(str(ROOT / "scenes" / "two_ellipsoids.json"))
    path, picture = tmp_path / "part.pov", tmp_path / "part.png"
    camera = loaded.camera(width=80, height=60)
    loaded.povray(str(path), render=str(picture), camera=camera, look="flat", width=80, height=60)
    assert sorted(file.name for file in tmp_path.iterdir()) == ["part.inc", "part.png", "part.pov"]
    assert '#include "part.inc"' in path.read_text()
    image = _image.read(str(picture))
    assert image.shape == (60, 80, 4)
    assert 0.1 < (image[:, :, 3] > 0.5).mean() < 0.9
    with pytest.raises(sardf.Error, match="did you mean 'flat'"):
        loaded.povray(str(path), look="flatt")
    with pytest.raises(sardf.Error, match=r"\.pov"):
        loaded.povray(str(tmp_path / "part.txt"))


def test_a_section_is_one_more_cut():
    loaded = sardf.load(str(ROOT / "scenes" / "lined_bore.json"))
    half = sardf.half_space(point=(0, 0, 0), normal=(1, 0, 0))
    cut = loaded.section(remove=half)
    assert (cut.section_count, loaded.section_count) == (1, 0)
    points = np.random.default_rng(10).uniform(*np.array(loaded.bounds), (2000, 3))
    points = points[np.abs(points[:, 0]) > 1e-6]
    inside = (loaded.solid(points) >= 0) & (points[:, 0] < 0)
    np.testing.assert_array_equal(cut.drawn(points) >= 0, inside)
    np.testing.assert_array_equal(cut.solid(points), loaded.solid(points))
    np.testing.assert_array_equal(cut.fractions(points), loaded.fractions(points))


def test_the_grain_of_the_forged_lever():
    """Unit vectors in the plane: along the arm, round the eye without running into the seat, and
    circles in the bush."""
    lever = sardf.load(str(ROOT / "scenes" / "forged_lever.json"))
    eye, seat = np.array([35, 35.707]), 8.5
    points = np.random.default_rng(11).uniform(*np.array(lever.bounds), (20000, 3))
    points = points[lever.solid(points) >= 0]
    grain = lever.attributes["grain_direction"](points)
    np.testing.assert_allclose(np.linalg.norm(grain, axis=1), 1, rtol=0, atol=1e-9)
    assert np.abs(grain[:, 2]).max() < 1e-9
    offset = points[:, :2] - eye
    radius = np.linalg.norm(offset, axis=1)
    outwards = np.einsum("ij,ij->i", grain[:, :2], offset) / radius
    assert np.abs(outwards[radius < seat]).max() < 1e-9
    np.testing.assert_allclose(lever.fractions(points)[:, 1], radius < seat, rtol=0, atol=1e-9)
    # On the middle of the arm, an arc of radius 50, the grain is its tangent.
    angle = np.radians(np.linspace(75, 138, 40))
    middle = np.stack([50 * np.cos(angle), 50 * np.sin(angle), 0 * angle], axis=1)
    tangent = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=1)
    found = lever.attributes["grain_direction"](middle)
    np.testing.assert_allclose(found, tangent, rtol=0, atol=1e-9)
    # Just outside of the seat it runs along the seat, the same way on both sides.
    for side in (-1, 1):
        across = side * eye / np.linalg.norm(eye)
        place = np.append(eye + (seat + 1e-3) * across, 0)[None]
        found = lever.attributes["grain_direction"](place)[0, :2]
        expected = np.array([-eye[1], eye[0]]) / np.linalg.norm(eye)
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-3)


def test_progress_rises_and_cancels():
    loaded = sardf.load(str(ROOT / "scenes" / "two_ellipsoids.json"))
    shares = []
    loaded.mesh(resolution=48, size=0, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1
    with pytest.raises(sardf.Cancelled):
        loaded.mesh(resolution=64, progress=lambda share: share < 0.3)
