"""Mesh files, written by `sardf mesh` and read by libraries that are not ours."""

import os
import subprocess
import sys
from pathlib import Path

import manifold3d
import numpy as np
import pytest
import trimesh

ROOT = Path(__file__).resolve().parents[2]
SCENE = ROOT / "scenes" / "lined_bore.json"  # 84 x 34 x 48 mm with three through holes
SARDF = os.environ.get("SARDF_BINARY") or str(Path(sys.executable).with_name("sardf"))
METRES_PER_UNIT = 0.001


@pytest.fixture(scope="module", params=["ply", "obj", "glb"])
def read(request, tmp_path_factory):
    """The file's extension, what trimesh reads from it as it is, and with equal points joined."""
    path = tmp_path_factory.mktemp("mesh") / f"part.{request.param}"
    command = [SARDF, "mesh", SCENE, "-o", path, "--resolution", "96", "--size", "0"]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    raw = trimesh.load(path, process=False, force="mesh")
    joined = trimesh.Trimesh(raw.vertices, raw.faces, process=False)
    joined.merge_vertices()
    return request.param, raw, joined


def test_closed_and_manifold(read):
    extension, raw, joined = read
    assert joined.is_watertight
    assert joined.is_winding_consistent
    assert joined.euler_number == -4
    # Equal points are one vertex: joining them merges nothing but what GLB and trimesh's OBJ
    # reader split at creases.
    if extension == "ply":
        assert len(raw.vertices) == len(joined.vertices)
    properties = np.asarray(joined.vertices, np.float32)
    solid = manifold3d.Manifold(manifold3d.Mesh(properties, np.asarray(joined.faces, np.uint32)))
    assert solid.status() == manifold3d.Error.NoError
    assert solid.genus() == 3


def test_lengths_and_axes(read):
    extension, raw, _ = read
    size = raw.bounds[1] - raw.bounds[0]
    expected = np.array([84, 34, 48.0])
    if extension == "glb":  # y is up: depth is the third axis
        expected = expected[[0, 2, 1]] * METRES_PER_UNIT
    np.testing.assert_allclose(size, expected, rtol=1e-3)


def test_normals_agree_with_the_faces(read):
    extension, raw, _ = read
    corners = raw.vertex_normals[raw.faces]
    cosine = np.einsum("fkc,fc->fk", corners, raw.face_normals)
    large = raw.area_faces > 1e-6 * raw.area
    assert cosine[large].mean(axis=1).min() > 0  # none is turned over
    # Few bend by more than 60 degrees, where three edges nearly meet. PLY has one normal at a
    # vertex: the mean of its sides.
    least = -0.1 if extension == "ply" else 0.5
    assert (cosine[large].min(axis=1) < least).mean() < 5e-4
    assert np.median(cosine) > 0.999


def test_fractions_sum_to_one(read):
    extension, raw, _ = read
    if extension == "obj":  # the format has no attributes
        assert "_ply_raw" not in raw.metadata
        assert not raw.vertex_attributes
        return
    if extension == "glb":
        values = [raw.vertex_attributes[f"_MATERIAL_{m}"] for m in ("steel", "carbide", "bronze")]
    else:
        data = raw.metadata["_ply_raw"]["vertex"]["data"]
        values = [data[f"fraction_{m}"] for m in ("steel", "carbide", "bronze")]
    total = sum(np.asarray(v, float).ravel() for v in values)
    np.testing.assert_allclose(total, 1, atol=1e-6)
    assert min(np.min(v) for v in values) >= 0
