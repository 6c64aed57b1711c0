"""The true surface as a fine mesh: refined, measured, and asked for closest points by libigl."""

from dataclasses import dataclass

import numpy as np

from sardf._command import library
from sardf._core import Scene
from sardf._scene import Scene as make_scene

STEPS = 8  # of Newton's iteration, each along the gradient
ROUNDS = 3  # of splitting triangles in four
FLAT = 2e-6  # deviation below which a triangle is not split, relative to the solid's diagonal
ROUNDING = 1e-13  # |field| that counts as 0, relative to the largest coordinate
PROBES = 20_000  # points from which the surface is looked for


@dataclass
class Reference:
    """Triangles near the surface. `error` is the greatest distance found between the two, from
    the triangles to the surface and from points of the surface to the triangles."""

    vertices: np.ndarray
    triangles: np.ndarray
    error: float
    mean_error: float
    checks: int  # points at which that was measured
    resolution: int

    @property
    def bounds(self):
        return self.vertices.min(axis=0), self.vertices.max(axis=0)

    def distances(self, points):
        return distances_to(self.vertices, self.triangles, points)


def reference(what, resolution=128, most_triangles=500_000):
    """The zero set of a scene's solid, or of a solid's field, as a Reference.

    Vertices are moved onto the zero set by Newton's iteration; triangles whose edges are far from
    it are split, the farthest first, until there are `most_triangles`. That leaves gaps as narrow
    as the deviation: it is no mesh for anything else.
    """
    scene = what if isinstance(what, Scene) else make_scene(solid=what)
    field = scene.solid
    mesh = scene.mesh(resolution=resolution, sections=False, size=0)
    triangles = triangles_of(mesh.faces)
    vertices, _ = onto_surface(field, mesh.vertices)
    diagonal = np.linalg.norm(np.ptp(vertices, axis=0))
    vertices, triangles = refined(field, vertices, triangles, FLAT * diagonal, most_triangles)
    away = np.concatenate(
        [
            deviations(field, vertices, triangles),
            missed(field, vertices, triangles),
        ]
    )
    return Reference(
        vertices, triangles, float(away.max()), float(away.mean()), len(away), resolution
    )


def distances_to(vertices, triangles, points):
    igl = library("igl", "accuracy")
    points = np.ascontiguousarray(points, dtype=float)
    squared, _, _ = igl.point_mesh_squared_distance(points, vertices, triangles)
    return np.sqrt(np.maximum(squared, 0))


def triangles_of(faces):
    """Quads as two triangles each, split from the first corner to the third."""
    faces = faces.astype(np.int64)
    both = np.vstack([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    return np.ascontiguousarray(both[np.all(both != np.roll(both, 1, axis=1), axis=1)])


def onto_surface(field, points):
    """The points moved onto the zero set, and how far that is from where they were.

    A step is taken only where it makes |field| smaller. What is left of the field, divided by its
    slope, is added to the distance.
    """
    at, value = points.copy(), field(points)
    done = ROUNDING * np.abs(points).max()
    moving = np.flatnonzero(np.abs(value) > done)
    left = np.zeros(len(points))
    for _ in range(STEPS):
        if not len(moving):
            break
        gradient = np.nan_to_num(field.gradient(at[moving]))
        squared = np.einsum("ij,ij->i", gradient, gradient)
        squared[squared == 0] = 1
        left[moving] = np.abs(value[moving]) / np.sqrt(squared)
        trial = at[moving] - (value[moving] / squared)[:, None] * gradient
        found = field(trial)
        better = np.abs(found) < np.abs(value[moving])
        moving, found = moving[better], found[better]
        at[moving], value[moving] = trial[better], found
        left[moving] = np.abs(found) / np.sqrt(squared[better])
        moving = moving[left[moving] > done]
    return at, np.linalg.norm(at - points, axis=1) + left


def edges_of(triangles):
    """The edges (E, 2), and for each triangle which three are its own."""
    ends = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    count = ends.max() + 1
    keys, index = np.unique(ends[:, 0] * count + ends[:, 1], return_inverse=True)
    return np.column_stack(np.divmod(keys, count)), index.reshape(-1, 3)


def refined(field, vertices, triangles, flat, most_triangles):
    """Triangles that are far from the surface become four, whose new corners are on it."""
    finished = []
    for _ in range(ROUNDS):
        edges, index = edges_of(triangles)
        middles, away = onto_surface(field, vertices[edges].mean(axis=1))
        centers = onto_surface(field, vertices[triangles].mean(axis=1))[1]
        away = np.maximum(away[index].max(axis=1), centers)
        room = (most_triangles - len(triangles) - sum(map(len, finished))) // 3
        far = away > flat
        if far.sum() > room:
            far = away > np.sort(away)[-max(room, 0) - 1]
        if not far.any():
            break
        finished.append(triangles[~far])
        a, b, c = triangles[far].T
        ab, bc, ca = (index[far] + len(vertices)).T
        vertices = np.vstack([vertices, middles])
        corners = (a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)
        triangles = np.vstack([np.column_stack(three) for three in corners])
    return vertices, np.ascontiguousarray(np.vstack([*finished, triangles]))


def deviations(field, vertices, triangles):
    """From the middles of edges and triangles to the surface."""
    edges, _ = edges_of(triangles)
    points = np.vstack([vertices[edges].mean(axis=1), vertices[triangles].mean(axis=1)])
    return onto_surface(field, points)[1]


def missed(field, vertices, triangles):
    """From points of the surface, found from all over the solid's box, to the triangles."""
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    start = np.random.default_rng(0).uniform(low, high, (PROBES, 3))
    found, _ = onto_surface(field, start)
    values, slopes = field(found), np.linalg.norm(field.gradient(found), axis=1)
    on = np.abs(values) <= 1e-9 * np.linalg.norm(high - low) * np.nan_to_num(slopes)
    return distances_to(vertices, triangles, found[on]) if on.any() else np.zeros(1)
