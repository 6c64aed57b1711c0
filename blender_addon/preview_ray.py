# SPDX-License-Identifier: GPL-3.0-or-later
"""What lies under the cursor: a ray's first point on a part, by the exact field; no bpy here."""

import numpy as np

STEPS = 400  # samples along a ray through the part's bounds
ROUNDS = 3  # each divides the interval with the surface by 64
PARTS = 64
SURFACE = 1e-6  # of the part's diagonal: a smaller distance is none


def first_hit(scene, origin, direction, plane):
    """The first point (3,) of the drawn solid on a ray, or None.

    All in the part's coordinates; plane (a, b, c, d): what has a x + b y + c z + d > 0 is cut away.
    A wall thinner than a STEPS-th of the part may be missed.
    """
    origin, direction = np.asarray(origin, float), np.asarray(direction, float)
    direction = direction / np.linalg.norm(direction)
    start, end = _interval(origin, direction, *map(np.asarray, scene.bounds))
    normal, offset = np.asarray(plane[:3], float), plane[3]
    if normal.any():
        height, rise = normal @ origin + offset, normal @ direction
        crossing = -height / (rise if abs(rise) > 1e-12 else 1e-12)
        start, end = (max(start, crossing), end) if rise < 0 else (start, min(end, crossing))
    if not start < end:
        return None
    drawn = scene.drawn
    places = np.linspace(start, end, STEPS)
    for _ in range(ROUNDS + 1):
        inside = drawn(origin + places[:, None] * direction) >= 0
        if not inside.any():
            return None
        first = int(np.argmax(inside))
        if first == 0:
            return origin + places[0] * direction
        places = np.linspace(places[first - 1], places[first], PARTS)
    return origin + places[-1] * direction


def _interval(origin, direction, lo, hi):
    """(start, end) of the ray in the box; start > end where it misses."""
    safe = np.where(np.abs(direction) < 1e-12, 1e-12, direction)
    a, b = (lo - origin) / safe, (hi - origin) / safe
    return max(np.minimum(a, b).max(), 0.0), np.maximum(a, b).min()


def lines(scene, point):
    """What there is to say of a point of the part, one line each."""
    here = np.array([point])
    unit = scene.units
    place = ", ".join(f"{c:.4g}" for c in point)
    distance = scene.solid(here)[0]
    lo, hi = map(np.asarray, scene.bounds)
    if abs(distance) < SURFACE * np.linalg.norm(hi - lo):
        distance = 0.0
    told = [f"({place}) {unit}", f"distance {distance:.4g} {unit}"]
    fractions = scene.fractions(here)[0]
    for name, share in zip(scene.materials, fractions, strict=True):
        if share >= 5e-4 or len(scene.materials) <= 3:
            told.append(f"{name} {100 * share:.1f} %")
    for name, evaluate in scene.attributes.items():
        values = evaluate(here)
        if isinstance(values, dict):
            told += [f"{name}_{part} {of[0]:.4g}" for part, of in values.items()]
        else:
            told.append(f"{name} " + ", ".join(f"{v:.4g}" for v in np.ravel(values[0])))
    return told
