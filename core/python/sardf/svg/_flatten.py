"""Curves as chains of chords whose distance from the curve is proven."""

import math
from dataclasses import dataclass

import numpy as np


@dataclass
class Bezier:
    """A line, a quadratic or a cubic by its control points (2 to 4, 2)."""

    control: np.ndarray

    @property
    def start(self):
        return self.control[0]

    @property
    def end(self):
        return self.control[-1]

    def hull(self):
        return self.control

    def moved(self, matrix):
        return Bezier(apply(matrix, self.control))

    def chords(self, tolerance):
        """Ends of the chords; halved until the bound of each is below the tolerance."""
        waiting, ends = [self.control], []
        while waiting:
            piece = waiting.pop()
            if deviation(piece) <= tolerance:
                ends.append(piece[-1])
            else:
                waiting += reversed(halves(piece))
        return ends


@dataclass
class Arc:
    """center + u cos(t) + v sin(t) from t = angle to t = angle + sweep; u and v need not be
    perpendicular, so that every affine image is one, too."""

    start: np.ndarray
    end: np.ndarray
    center: np.ndarray
    u: np.ndarray
    v: np.ndarray
    angle: float
    sweep: float

    def hull(self):
        reach = np.abs(self.u) + np.abs(self.v)
        return np.array([self.center - reach, self.center + reach, self.start, self.end])

    def moved(self, matrix):
        start, end, center = apply(matrix, np.array([self.start, self.end, self.center]))
        u, v = matrix[:2, :2] @ self.u, matrix[:2, :2] @ self.v
        return Arc(start, end, center, u, v, self.angle, self.sweep)

    def at(self, t):
        return self.center + self.u * math.cos(t) + self.v * math.sin(t)

    def chords(self, tolerance):
        """Ends of the chords. On the unit circle a chord over the angle w (at most pi) is
        1 - cos(w/2) from its arc, along the direction of the arc's middle, and the foot of every
        point along that direction is on the chord; the affine image keeps that."""
        count = max(1, math.ceil(abs(self.sweep) / (math.pi / 2)))
        steps = np.linspace(self.angle, self.angle + self.sweep, count + 1)
        waiting, ends = list(zip(steps[:-1], steps[1:], strict=True))[::-1], []
        while waiting:
            a, b = waiting.pop()
            middle = (a + b) / 2
            height = 2 * math.sin((b - a) / 4) ** 2
            if height * np.linalg.norm(self.at(middle) - self.center) <= tolerance:
                ends.append(self.at(b))
            else:
                waiting += [(middle, b), (a, middle)]
        ends[-1] = self.end
        return ends


def apply(matrix, points):
    return points @ matrix[:2, :2].T + matrix[:2, 2]


def deviation(control):
    """A bound of the distance between a Bezier curve and its chord.

    Both are proven: at equal parameters they differ by at most max |second derivative| / 8, which
    the second differences bound; and the curve lies in the hull of its control points.
    """
    degree = len(control) - 1
    if degree == 1:
        return 0.0
    second = control[2:] - 2 * control[1:-1] + control[:-2]
    by_parameter = degree * (degree - 1) / 8 * math.sqrt((second * second).sum(axis=1).max())
    return min(by_parameter, distances(control[1:-1], control[0], control[-1]).max())


def halves(control):
    """De Casteljau: the control points of the two halves."""
    left, right = [control[0]], [control[-1]]
    while len(control) > 1:
        control = (control[1:] + control[:-1]) / 2
        left.append(control[0])
        right.append(control[-1])
    return np.array(left), np.array(right[::-1])


def distances(points, a, b):
    """Distances of points (N, 2) to the segment from a to b."""
    along = b - a
    squared = along @ along
    t = np.clip((points - a) @ along / squared, 0, 1) if squared > 0 else np.zeros(len(points))
    return np.linalg.norm(points - a - t[:, None] * along, axis=1)


def flatten(segments, tolerance):
    """The vertices (N, 2) of a closed chain of segments."""
    points = [segments[0].start]
    for segment in segments:
        points += segment.chords(tolerance)
    return np.array(points)
