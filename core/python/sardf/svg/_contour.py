"""Closed contours: superfluous vertices removed, crossings found."""

import itertools

import numpy as np

from sardf.svg._flatten import distances

PAIRS_AT_ONCE = 1 << 20


def tidy(points, nearly_zero):
    """Without vertices that repeat the one before, or lie between their neighbours on a line.

    The contour moves by at most 4 `nearly_zero`.
    """
    points = without_repeats(points, nearly_zero)
    if len(points) > 2 and has_straight(points, nearly_zero):
        points = without_straight(points, nearly_zero)
    return points


def without_repeats(points, nearly_zero):
    kept = [points[0]]
    for point in points[1:]:
        if np.linalg.norm(point - kept[-1]) > nearly_zero:
            kept.append(point)
    while len(kept) > 1 and np.linalg.norm(kept[-1] - kept[0]) <= nearly_zero:
        kept.pop()
    return np.array(kept)


def has_straight(points, nearly_zero):
    before, after = np.roll(points, 1, axis=0), np.roll(points, -1, axis=0)
    along = after - before
    height = np.abs(cross(along, points - before))
    return bool(np.any(height <= nearly_zero * np.linalg.norm(along, axis=1)))


def without_straight(points, nearly_zero):
    """Each vertex that goes is within `nearly_zero` of the edge that takes its place."""
    kept, run = [points[0]], []
    for point in itertools.chain(points[1:], points[:1]):
        if run and distances(np.array(run), kept[-1], point).max() > nearly_zero:
            kept.append(run[-1])
            run = []
        run.append(point)
    if len(kept) > 2 and distances(kept[0][None], kept[-1], kept[1])[0] <= nearly_zero:
        kept.pop(0)
    return np.array(kept)


def check_contour(points, fail):
    """Calls fail(message) unless the contour has an inside and meets itself nowhere."""
    n = len(points)
    if n < 3:
        fail(f"the contour degenerates to {n} point{'s' if n > 1 else ''}; it has no inside")
    found = crossing(points)
    if found:
        i, j = found
        fail(
            f"edges {i}-{(i + 1) % n} near {shown(points[i])} and {j}-{(j + 1) % n} near"
            f" {shown(points[j])} cross or touch; a contour must not meet itself"
            " (where the drawn curve does not, a smaller tolerance helps)"
        )


def shown(point):
    return f"({point[0]:.6g}, {point[1]:.6g})"


def crossing(points):
    """Two edges that have a point in common which neighbours need not have; None otherwise."""
    ends = np.roll(points, -1, axis=0)
    after = np.roll(points, -2, axis=0)
    turn = cross(ends - points, after - points)
    back = np.einsum("ij,ij->i", points - ends, after - ends) > 0
    folded = np.flatnonzero((turn == 0) & back)
    if len(folded):
        return int(folded[0]), int(folded[0] + 1) % len(points)
    for i, j in pairs_of_near_edges(points, ends):
        met = np.flatnonzero(meet(points[i], ends[i], points[j], ends[j]))
        if len(met):
            return int(i[met[0]]), int(j[met[0]])
    return None


def pairs_of_near_edges(points, ends):
    """Arrays (i, j) of edges, no neighbours, whose ranges of x overlap, some at a time."""
    n = len(points)
    low, high = np.minimum(points[:, 0], ends[:, 0]), np.maximum(points[:, 0], ends[:, 0])
    order = np.argsort(low, kind="stable")
    counts = np.searchsorted(low[order], high[order], "right") - np.arange(n) - 1
    # An edge that is a point in x comes behind others that begin where it ends.
    counts = np.maximum(counts, 0)
    first, total = 0, np.concatenate([[0], np.cumsum(counts)])
    while first < n:
        last = max(
            first + 1, int(np.searchsorted(total, total[first] + PAIRS_AT_ONCE, "right")) - 1
        )
        rank = np.repeat(np.arange(first, last), counts[first:last])
        other = np.arange(len(rank)) - (total[rank] - total[first]) + rank + 1
        i, j = np.sort([order[rank], order[other]], axis=0)
        apart = (j - i > 1) & (j - i < n - 1)
        yield i[apart], j[apart]
        first = last


def cross(a, b):
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]


def meet(a, b, c, d):
    """Whether the segments ab and cd have a common point, by the signs of four areas."""
    p, q = cross(b - a, c - a), cross(b - a, d - a)
    r, s = cross(d - c, a - c), cross(d - c, b - c)
    across = (np.sign(p) * np.sign(q) < 0) & (np.sign(r) * np.sign(s) < 0)
    touch = (p == 0) & in_box(a, b, c) | (q == 0) & in_box(a, b, d)
    return across | touch | (r == 0) & in_box(c, d, a) | (s == 0) & in_box(c, d, b)


def in_box(a, b, p):
    return np.all((np.minimum(a, b) <= p) & (p <= np.maximum(a, b)), axis=1)
