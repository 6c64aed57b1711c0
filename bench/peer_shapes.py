"""The shapes that peers are compared on, in Python; bench/shapes.hpp has the same in C++.

Cells are cubes; `--cells` is their number along the longest side of the tight box, which is 1.1
times as large as the shape. The cube has the same centre and that number of cells along each side.
"""

import numpy as np
import sardf


def _spheres():
    at = [(0.5 * (i // 4 - 1.5), 0.5 * (i % 4 - 1.5), 0) for i in range(16)]
    balls = sardf.union(*(sardf.sphere(center=center, radius=0.3) for center in at))
    return balls - sardf.box(center=(0, 0, 0.25), size=(1.8, 0.5, 0.5)), (1.05, 1.05, 0.3)


def _block(blend):
    holes = [sardf.cylinder(radius=3)]
    holes += [sardf.cylinder(center=(x, y, 0), radius=1) for x in (-8, 8) for y in (-4, 4)]
    drilled = sardf.difference(sardf.box(size=(20, 12, 8)), *holes, blend=blend)
    ring = sardf.torus(major_radius=5, minor_radius=1)
    return sardf.union(drilled, ring, blend=blend), (10, 6, 4)


_SHAPES = {
    "S1": _spheres,
    "S2": lambda: _block(sardf.MinMax()),
    "S3": lambda: _block(sardf.Sardf(0.5)),
}
NAMES = tuple(_SHAPES)
BOXES = ("tight", "cube")


class Grid:
    """A shape with its box and cells; the grid's points are the corners of the cells."""

    def __init__(self, name, box, cells):
        self.field, half = _SHAPES[name]()
        half = 1.1 * np.array(half)
        self.half = half if box == "tight" else np.full(3, half.max())
        self.cell = 2 * half.max() / cells
        steps = np.ceil(2 * self.half / self.cell - 1e-6).astype(int) + 1
        self.axes = [
            (self.cell * np.arange(n) - h).astype(np.float32)
            for n, h in zip(steps, self.half, strict=True)
        ]

    @property
    def shape(self):
        """The numbers of points along z, y and x."""
        return tuple(len(axis) for axis in reversed(self.axes))

    def mesh(self):
        """sardf's mesh, without a texture; making the scene shrinks the box to the solid."""
        scene = sardf.Scene(solid=self.field, bounds=(tuple(-self.half), tuple(self.half)))
        return scene.mesh(cell_size=self.cell, size=0)

    def values(self, clock):
        """The field at all points, z slowest, and the time of it by the clock, in slabs: their
        points take three times the memory of their values. Making and copying arrays costs
        nothing."""
        values = np.empty(self.shape, dtype=np.float32)
        layers = max(1, 8_000_000 // (values.shape[1] * values.shape[2]))
        took = 0.0
        for first in range(0, len(values), layers):
            slab = values[first : first + layers]
            points = np.empty((*slab.shape, 3), dtype=np.float32)
            points[..., 0] = self.axes[0]
            points[..., 1] = self.axes[1][:, None]
            points[..., 2] = self.axes[2][first : first + layers, None, None]
            points = points.reshape(-1, 3)
            begun = clock()
            found = self.field(points)
            took += clock() - begun
            slab[...] = found.reshape(slab.shape)
        return values, took
