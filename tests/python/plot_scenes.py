"""A small scene whose every value is known, and the numbers that a plot leaves behind."""

from pathlib import Path

import numpy as np

# A ball of radius 2 around (1, 0, 0), of which 30 % is red everywhere.
BALL = {
    "sardf": 1,
    "title": "ball",
    "units": "cm",
    "fields": {
        "ball": {"sphere": {"center": [1, 0, 0], "radius": 2}},
        "brick": {"box": {"size": [2, 2, 2]}},
        "slope": "=x^2",
    },
    "solid": "ball",
    "materials": {"red": {"color": "#c00000"}, "blue": {"color": "#0000ff"}},
    "fractions": {"formulas": {"red": "=0.3 + 0*x", "blue": "=0.7 + 0*x"}},
    "attributes": {
        "heat": {"value": "=20 + x", "unit": "°C"},
        "grain": {"value": ["=-y", "=x", 0]},
    },
}


def csv_of(path):
    """The columns of a CSV file by name."""
    header = Path(path).read_text().splitlines()[0]
    data = np.genfromtxt(path, delimiter=",", skip_header=1)
    names = np.loadtxt([header], delimiter=",", dtype=str, quotechar='"').tolist()
    return dict(zip(names, data.T, strict=True))


def points_of(columns):
    return np.transpose([columns[axis] for axis in "xyz"])


def ball_distance(points):
    return 2 - np.linalg.norm(np.asarray(points) - (1, 0, 0), axis=-1)
