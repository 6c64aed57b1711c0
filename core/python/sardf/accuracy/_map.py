"""The map of the error on a plane, drawn by sardf.plot."""

import numpy as np


def write_map(path, scene, measured):
    """Draws a Section's error over its plane and writes .png, .svg or .pdf.

    scene: the Scene that was measured. Raises Error as sardf.plot does.
    """
    from sardf import plot

    def error(points):
        return np.abs(scene.solid(points)) - measured.reference.distances(points)

    name = "|field| - |true distance|"
    label = f"error against the true distance ({scene.units})"
    quantity = plot.Quantity(name, "error", label, error, ("error",), scene, scene.solid)
    fixed = next(axis for axis in "xyz" if axis not in measured.axes)
    at = measured.points[0]["xyz".index(fixed)]
    across, up = measured.across, measured.up
    cut = plot.section(
        scene, f"{fixed}={at:.17g}", [quantity], window=(across[0], across[-1], up[0], up[-1])
    )
    plot.save(plot.draw_sections(cut), path)
