"""How far meshes of the peers' shapes are from the true surface: sardf against VTK's Flying Edges.

    python bench/mesh_error.py [--cells 256] [--stl FOLDER]

Both get cubic cells of the same size, and Flying Edges sardf's own values; see mesh_against_vtk.py.
FOLDER may hold meshes of other programs, as S1.stl, S2.stl, S3.stl in binary form; `bench/fidget`
writes Fidget's.

The error is one-sided: from points on the mesh's triangles to the true surface, in cells of the
grid. Each point goes to the surface by Newton's method in double precision, whose path is as long
as the way to the surface where that is smooth, and longer, never shorter, where it is not.
"""

import argparse
import pathlib

import numpy as np
import sardf
import vtk
from mesh_against_vtk import SHAPES, flying_edges
from vtk.util import numpy_support

# Points of a triangle: its corners, the middles of its edges, its centre and three around it.
WEIGHTS = np.array(
    [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5]]
    + [[1 / 3] * 3, [0.6, 0.2, 0.2], [0.2, 0.6, 0.2], [0.2, 0.2, 0.6]]
)


def distances(field, points):
    """The lengths of the paths of Newton's method from points to the surface."""
    length = np.zeros(len(points))
    at = points.copy()
    for _ in range(8):
        gradient = np.nan_to_num(field.gradient(at))
        square = np.maximum((gradient**2).sum(axis=1), 1e-12)
        step = -(field(at) / square)[:, None] * gradient
        at += step
        length += np.linalg.norm(step, axis=1)
    return length


def report(name, program, field, triangles, cell):
    """One line: greatest error, root of the mean square over the area, number of triangles."""
    greatest, squares, areas = 0.0, 0.0, 0.0
    for part in np.array_split(triangles, max(1, len(triangles) // 50_000)):
        edges = part[:, 1:] - part[:, :1]
        area = 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
        points = np.einsum("wk,tkx->twx", WEIGHTS, part).reshape(-1, 3)
        error = distances(field, points).reshape(len(part), -1) / cell
        greatest = max(greatest, error.max())
        squares += (area * (error**2).mean(axis=1)).sum()
        areas += area.sum()
    rms = np.sqrt(squares / areas)
    print(f"{name:<18} {program:<13} {greatest:10.2e} {rms:10.2e} {len(triangles):10}", flush=True)


def triangles_of_quads(mesh):
    faces, at = np.asarray(mesh.faces), np.asarray(mesh.vertices, dtype=float)
    halves = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    return at[halves[(halves[:, 1] != halves[:, 2]) & (halves[:, 0] != halves[:, 2])]]


def triangles_of_vtk(polygons):
    points = numpy_support.vtk_to_numpy(polygons.GetPoints().GetData()).astype(float)
    cells = numpy_support.vtk_to_numpy(polygons.GetPolys().GetConnectivityArray())
    return points[cells.reshape(-1, 3)]


def triangles_of_stl(path):
    reader = vtk.vtkSTLReader()
    reader.SetFileName(str(path))
    reader.Update()
    return triangles_of_vtk(reader.GetOutput())


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=256, help="along the longest side")
    parser.add_argument("--stl", type=pathlib.Path, help="folder of meshes of another program")
    options = parser.parse_args()
    print(f"{'':<18} {'':<13} {'greatest':>10} {'rms':>10} {'triangles':>10}   (errors in cells)")
    for name, make in SHAPES.items():
        field, half = make()
        half = 1.1 * np.array(half)
        cell = 2 * half.max() / options.cells
        scene = sardf.Scene(solid=field, bounds=(tuple(-half), tuple(half)))
        mesh = scene.mesh(cell_size=cell, size=0)
        report(name, "sardf", field, triangles_of_quads(mesh), cell)
        axes = [np.arange(-h, h + cell, cell, dtype=np.float32) for h in half]
        z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
        values = field(np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)).astype(np.float32)
        polygons = flying_edges(values.reshape(x.shape), -half, cell)
        report(name, "Flying Edges", field, triangles_of_vtk(polygons), cell)
        if options.stl:
            path = options.stl / f"{name[:2]}.stl"
            report(name, path.parent.name, field, triangles_of_stl(path), cell)


if __name__ == "__main__":
    main()
