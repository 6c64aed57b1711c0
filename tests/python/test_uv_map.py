"""Sentences about UV maps that sardf did not make."""

import json

import numpy as np
import pytest
import sardf

BALL = {
    "sardf": 1,
    "units": "cm",
    "fields": {"ball": {"sphere": {"radius": 5}}},
    "solid": "ball",
}


@pytest.fixture(scope="module")
def scene():
    return sardf.Scene.from_json(json.dumps(BALL))


@pytest.fixture
def mesh(scene):
    return scene.mesh(resolution=16, size=256)


def test_our_own_atlas_has_no_faults(scene, mesh):
    assert sardf.check_uv_map(scene, mesh, 256) == []


def test_texels_per_unit_are_those_of_the_areas(scene, mesh):
    """The atlas keeps areas, so that each triangle has the same ratio."""
    a, b, c = (mesh.uv.reshape(-1, 4, 2)[:, k] for k in (0, 1, 2))
    p, q, r = (mesh.vertices[mesh.faces[:, k]] for k in (0, 1, 2))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    texels = np.abs(ux * vy - uy * vx).sum() * 256**2
    area = np.linalg.norm(np.cross(q - p, r - p), axis=1).sum()
    assert sardf.texels_per_unit(mesh, 256) == pytest.approx(np.sqrt(texels / area), rel=0.01)


def test_maps_that_leave_the_image_or_overlap_are_refused(scene, mesh):
    good = mesh.uv
    mesh.uv = good + [0.4, 0]
    with pytest.raises(sardf.Error, match=r"faces of the UV map reach out of the image"):
        sardf.check_uv_map(scene, mesh, 256)
    mesh.uv = np.abs(good - [0.25, 0])
    with pytest.raises(sardf.Error, match=r"% of the UV map's texels lie on several faces at once"):
        sardf.check_uv_map(scene, mesh, 256)
    mesh.uv = good * 0
    with pytest.raises(sardf.Error, match="no texel lies on the mesh"):
        sardf.check_uv_map(scene, mesh, 256)
    mesh.uv = np.zeros((0, 2))
    with pytest.raises(sardf.Error, match="texture coordinates"):
        sardf.check_uv_map(scene, mesh, 256)


def test_a_few_faults_are_a_warning(scene, mesh):
    moved = mesh.uv
    moved[:4] += 2
    mesh.uv = moved
    (warning,) = sardf.check_uv_map(scene, mesh, 256)
    assert warning.startswith(f"1 of {len(mesh.faces)} faces of the UV map reach out of the image")


def test_vertices_off_the_surface_are_told_with_their_distance(scene, mesh):
    vertices = mesh.vertices
    vertices[:7] *= 1.1  # of a radius of 5
    mesh.vertices = vertices
    (warning,) = sardf.check_uv_map(scene, mesh, 256)
    assert warning.startswith(f"7 of {len(vertices)} vertices lie off the part's surface")
    assert "up to 0.5" in warning
    assert "cm away" in warning
    mesh.vertices = vertices + [40, 0, 0]
    with pytest.raises(sardf.Error, match="no vertex of the mesh lies on the part's surface"):
        sardf.check_uv_map(scene, mesh, 256)
