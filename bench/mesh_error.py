"""How far meshes of the peers' shapes are from the true surface: sardf against VTK's Flying Edges.

    python bench/mesh_error.py [--cells 256] [--stl FOLDER]

All have cubic cells of the same size, and Flying Edges has sardf's own values; see peer_shapes.py.
FOLDER may hold meshes of another program, whose name it bears, as S1.stl, S2.stl, S3.stl in binary
form; `bench/compare_fidget --stl FOLDER` writes Fidget's, with 256 cells.

The error is one-sided: from points on the mesh's triangles to the true surface, in cells of the
grid. Each point goes to the surface by Newton's method in double precision, whose path is as long
as the way to the surface where that is smooth, and longer, never shorter, where it is not.
"""

import argparse
import pathlib
import time

import numpy as np
import vtk
from mesh_against_vtk import flying_edges, print_row
from peer_shapes import NAMES, Grid
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


def report(name, program, grid, triangles):
    """A row: number of triangles, greatest error, root of the mean square over the area."""
    greatest, squares, areas = 0.0, 0.0, 0.0
    for part in np.array_split(triangles, max(1, len(triangles) // 50_000)):
        edges = part[:, 1:] - part[:, :1]
        area = 0.5 * np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)
        points = np.einsum("wk,tkx->twx", WEIGHTS, part).reshape(-1, 3)
        error = distances(grid.field, points).reshape(len(part), -1) / grid.cell
        greatest = max(greatest, error.max())
        squares += (area * (error**2).mean(axis=1)).sum()
        areas += area.sum()
    rms = np.sqrt(squares / areas)
    print_row([name, program, len(triangles), f"{greatest:.4f}", f"{rms:.4f}"])


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
    print_row(["shape", "mesher", "triangles", "greatest error, cells", "rms, cells"])
    print_row(["---"] * 5)
    for name in NAMES:
        grid = Grid(name, "tight", options.cells)
        report(name, "sardf", grid, triangles_of_quads(grid.mesh()))
        values, _ = grid.values(time.perf_counter)
        report(name, "Flying Edges", grid, triangles_of_vtk(flying_edges(values, grid)))
        if options.stl:
            triangles = triangles_of_stl(options.stl / f"{name}.stl")
            report(name, options.stl.name, grid, triangles)


if __name__ == "__main__":
    main()
