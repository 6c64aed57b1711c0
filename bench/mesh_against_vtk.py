"""Meshing times of the peers' shapes: sardf against VTK's Flying Edges on sardf's own values.

    python bench/mesh_against_vtk.py [--box cube] [--cells 256] [--rounds 7] [--threads 1]
                                     [--memory]

Needs `pip install vtk` in the environment that has sardf. Both get cubic cells of the same size;
both times are processor time (wall-clock time with more than one thread), in turns, medians.
sardf's has sharp edges, quads and normals in it. Flying Edges has neither edges nor, as it is run
here, normals; the time of the values that it needs is that of sardf's batch evaluation, with the
points at hand. The boxes are those of peer_shapes.py: the tight one hardly has points far from the
shape; the cube, as which grids for meshers of implicit surfaces are usual, has more.
"""

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path
from statistics import median

import vtk
from peer_shapes import BOXES, NAMES, Grid
from vtk.util import numpy_support

HEAD = ("shape", "box", "cells", "quads", "triangles", "sardf, ms", "values, ms",
        "Flying Edges, ms", "VTK with values / sardf")  # fmt: skip


def flying_edges(values, grid):
    image = vtk.vtkImageData()
    image.SetDimensions(*values.shape[::-1])
    image.SetSpacing(grid.cell, grid.cell, grid.cell)
    image.SetOrigin(*-grid.half)
    image.GetPointData().SetScalars(numpy_support.numpy_to_vtk(values.ravel()))
    mesher = vtk.vtkFlyingEdges3D()
    mesher.SetInputData(image)
    mesher.SetValue(0, 0.0)
    mesher.ComputeNormalsOff()
    mesher.ComputeGradientsOff()
    mesher.Update()
    return mesher.GetOutput()


def measure(name, box, options, clock):
    grid = Grid(name, box, options.cells)
    times = {"sardf": [], "values": [], "edges": []}
    for _ in range(options.rounds):
        begun = clock()
        mesh = grid.mesh()
        times["sardf"].append(clock() - begun)
        quads = len(mesh.faces)
        del mesh
        values, took = grid.values(clock)
        times["values"].append(took)
        begun = clock()
        polygons = flying_edges(values, grid)
        times["edges"].append(clock() - begun)
        triangles = polygons.GetNumberOfCells()
        del polygons, values
    ours, values, edges = (median(of) for of in times.values())
    points = " x ".join(str(n - 1) for n in reversed(grid.shape))
    milliseconds = [f"{1e3 * seconds:.1f}" for seconds in (ours, values, edges)]
    return [name, box, points, quads, triangles, *milliseconds, f"{(values + edges) / ours:.2f}"]


def memory(name, box, cells):
    """What mesh_memory.py says, from a process of its own."""
    script = Path(__file__).with_name("mesh_memory.py")
    command = [sys.executable, script, name, "--box", box, "--cells", str(cells)]
    return subprocess.run(command, check=True, text=True, capture_output=True).stdout.split(",")[0]


def print_row(cells):
    print(f"| {' | '.join(str(cell) for cell in cells)} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--box", choices=BOXES, action="append", help="by default both")
    parser.add_argument("--cells", type=int, default=256, help="along the longest side")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--memory", action="store_true", help="sardf's most memory as well")
    options = parser.parse_args()
    os.sched_setaffinity(0, range(options.threads))
    backend = vtk.vtkSMPTools()
    backend.SetBackend("Sequential" if options.threads == 1 else "STDThread")
    backend.Initialize(options.threads)
    clock = time.process_time if options.threads == 1 else time.perf_counter
    more = ("sardf's process",) if options.memory else ()
    print_row(HEAD + more)
    print_row(["---"] * len(HEAD + more))
    for box in options.box or BOXES:
        for name in NAMES:
            row = measure(name, box, options, clock)
            print_row(row + ([memory(name, box, options.cells)] if options.memory else []))


if __name__ == "__main__":
    main()
