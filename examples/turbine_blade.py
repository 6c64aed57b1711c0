"""A turbine blade as triangles: cambered sections that taper and twist along the span.

Run it as `python examples/turbine_blade.py FOLDER`; the folder (default: the current one) receives
turbine_blade.ply, in millimetres. scenes/turbine_blade.json grades its materials by the distance to
it.
"""

import sys
from pathlib import Path

import numpy as np

SPAN, AROUND, SECTIONS = 40.0, 72, 33


def section(share):
    """The outline at that share of the span: (AROUND, 2), counter-clockwise."""
    chord, thickness, camber = 24 - 8 * share, 0.17 - 0.04 * share, 0.10 - 0.04 * share
    twist = np.radians(50 - 38 * share)
    angle = np.linspace(0, 2 * np.pi, AROUND, endpoint=False)
    along = 0.5 + 0.5 * np.cos(angle)  # 1 at the trailing edge
    # An ellipse, thickest before the middle, with a trailing edge as round as it is thin.
    half = thickness * np.sin(angle) * (1 - 0.62 * along**2)
    mean = 4 * camber * along * (1 - along)
    outline = chord * np.column_stack([along - 0.45, mean + half])
    c, s = np.cos(twist), np.sin(twist)
    return outline @ np.array([[c, s], [-s, c]])


def blade():
    """Vertices (N, 3) and triangles (M, 3), outwards."""
    shares = np.linspace(0, 1, SECTIONS)
    rings = [np.column_stack([section(t), np.full(AROUND, SPAN * t)]) for t in shares]
    ends = [rings[0].mean(axis=0), rings[-1].mean(axis=0)]
    vertices = np.concatenate([*rings, ends])
    at = np.arange(AROUND)
    after = (at + 1) % AROUND
    faces = []
    for k in range(SECTIONS - 1):
        low, high = k * AROUND, (k + 1) * AROUND
        faces += [np.column_stack([low + at, low + after, high + after])]
        faces += [np.column_stack([low + at, high + after, high + at])]
    last = (SECTIONS - 1) * AROUND
    faces += [np.column_stack([after, at, np.full(AROUND, SECTIONS * AROUND)])]
    faces += [np.column_stack([last + at, last + after, np.full(AROUND, SECTIONS * AROUND + 1)])]
    return vertices, np.concatenate(faces)


def write_ply(path, vertices, faces):
    """Binary PLY with vertices in double."""
    rows = np.empty(len(faces), dtype=[("n", "u1"), ("of", "<i4", 3)])
    rows["n"], rows["of"] = 3, faces
    header = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    path.write_bytes(header.encode() + vertices.astype("<f8").tobytes() + rows.tobytes())


if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    vertices, faces = blade()
    write_ply(folder / "turbine_blade.ply", vertices, faces)
    print(f"{len(vertices)} vertices, {len(faces)} triangles")
