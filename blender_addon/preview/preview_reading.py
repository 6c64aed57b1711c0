# SPDX-License-Identifier: GPL-3.0-or-later
"""What the probe says about a point of a part; no bpy here."""

import numpy as np

SURFACE = 1e-6  # of the part's longest side: a smaller distance is none


def lines(scene, point):
    """What there is to say of a point of the part, one line each."""
    here = np.array([point])
    unit = scene.units
    place = ", ".join(f"{c:.4g}" for c in point)
    distance = scene.solid(here)[0]
    lo, hi = map(np.asarray, scene.bounds)
    if abs(distance) < SURFACE * (hi - lo).max():
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
