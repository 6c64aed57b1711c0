"""Meshing times of the peers' shapes: sardf against VTK's Flying Edges on sardf's own values.

    python bench/mesh_against_vtk.py [--cells 256] [--rounds 7] [--threads 1]

Needs `pip install vtk` in the environment that has sardf. Both get cubic cells of the same size;
both times are processor time (wall-clock time with more than one thread), in turns, medians.
sardf's has sharp edges, quads and normals in it. Flying Edges has neither edges nor, as it is run
here, normals; the time of the values that it needs is that of sardf's batch evaluation, with the
points at hand.
"""

import argparse
import os
import time
from statistics import median

import numpy as np
import sardf
import vtk
from vtk.util import numpy_support


def spheres():
    at = [(0.5 * (i // 4 - 1.5), 0.5 * (i % 4 - 1.5), 0) for i in range(16)]
    balls = sardf.union(*(sardf.sphere(center=center, radius=0.3) for center in at))
    return balls - sardf.box(center=(0, 0, 0.25), size=(1.8, 0.5, 0.5)), (1.05, 1.05, 0.3)


def block(blend):
    holes = [sardf.cylinder(radius=3)]
    holes += [sardf.cylinder(center=(x, y, 0), radius=1) for x in (-8, 8) for y in (-4, 4)]
    drilled = sardf.difference(sardf.box(size=(20, 12, 8)), *holes, blend=blend)
    ring = sardf.torus(major_radius=5, minor_radius=1)
    return sardf.union(drilled, ring, blend=blend), (10, 6, 4)


SHAPES = {
    "S1 spheres": spheres,
    "S2 block": lambda: block(sardf.MinMax()),
    "S3 blended block": lambda: block(sardf.Sardf(0.5)),
}


def flying_edges(values, origin, cell):
    image = vtk.vtkImageData()
    image.SetDimensions(*values.shape[::-1])
    image.SetSpacing(cell, cell, cell)
    image.SetOrigin(*origin)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(values.ravel()))
    mesher = vtk.vtkFlyingEdges3D()
    mesher.SetInputData(image)
    mesher.SetValue(0, 0.0)
    mesher.ComputeNormalsOff()
    mesher.ComputeGradientsOff()
    mesher.Update()
    return mesher.GetOutput()


def measure(name, cells, rounds, clock):
    field, half = SHAPES[name]()
    half = 1.1 * np.array(half)
    cell = 2 * half.max() / cells
    axes = [np.arange(-h, h + cell, cell, dtype=np.float32) for h in half]
    z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
    points = np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
    scene = sardf.Scene(solid=field, bounds=(tuple(-half), tuple(half)))
    times = {"sardf": [], "values": [], "flying edges": []}
    for _ in range(rounds):
        begun = clock()
        mesh = scene.mesh(cell_size=cell, size=0)
        times["sardf"].append(clock() - begun)
        begun = clock()
        values = field(points).astype(np.float32, copy=False)
        times["values"].append(clock() - begun)
        begun = clock()
        triangles = flying_edges(values.reshape(x.shape), -half, cell).GetNumberOfCells()
        times["flying edges"].append(clock() - begun)
    ms = {what: 1e3 * median(of) for what, of in times.items()}
    other = ms["values"] + ms["flying edges"]
    print(
        f"{name:<18} {ms['sardf']:8.1f} {ms['values']:8.1f} {ms['flying edges']:8.1f} "
        f"{ms['sardf'] / other:8.2f}   {len(mesh.faces)} quads, {triangles} triangles"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--cells", type=int, default=256, help="along the longest side")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--threads", type=int, default=1)
    options = parser.parse_args()
    os.sched_setaffinity(0, range(options.threads))
    backend = vtk.vtkSMPTools()
    backend.SetBackend("Sequential" if options.threads == 1 else "STDThread")
    backend.Initialize(options.threads)
    clock = time.process_time if options.threads == 1 else time.perf_counter
    print(f"{'':<18} {'sardf ms':>8} {'values':>8} {'edges':>8} {'ratio':>8}")
    for name in SHAPES:
        measure(name, options.cells, options.rounds, clock)


if __name__ == "__main__":
    main()
