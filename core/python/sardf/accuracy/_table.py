"""What was measured as a table, as JSON data and as CSV."""

import math
from dataclasses import asdict, dataclass

import numpy as np


@dataclass
class Side:
    """Errors on one side of the surface; lengths in scene units."""

    points: int
    max: float  # of |error|
    where: list  # the point with that error
    mean: float  # of |error|
    rms: float
    least: float  # of the error: below 0 where the field is too small
    greatest: float


def side_of(measured, chosen):
    error, points = measured.error[chosen], measured.points[chosen]
    if not len(error):
        return Side(0, 0.0, [], 0.0, 0.0, 0.0, 0.0)
    size = np.abs(error)
    worst = int(size.argmax())
    numbers = size[worst], points[worst].tolist(), size.mean(), math.sqrt((size * size).mean())
    return Side(len(error), *numbers, error.min(), error.max())


def plain(value):
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, np.generic):
        value = value.item()
    return str(value) if isinstance(value, float) and not math.isfinite(value) else value


def summary_of(measured):
    surface = measured.reference
    return plain({
        "name": measured.name,
        "units": measured.units,
        "proven": {"error_bound_against_min_max": measured.error_bound},
        "labelled": dict(zip(("inside", "outside"), measured.exactness, strict=True)),
        "measured": {"inside": asdict(measured.inside), "outside": asdict(measured.outside)},
        "reference": {
            "resolution": surface.resolution,
            "triangles": len(surface.triangles),
            "max_error": surface.error,
            "mean_error": surface.mean_error,
            "checks": surface.checks,
        },
    })  # fmt: skip


def text_of(measured):
    unit = f" {measured.units}" if measured.units else ""
    surface = measured.reference
    bound = measured.error_bound
    head = "points", "mean", "rms", "max", "least", "greatest"
    lines = [
        f"{measured.name or 'field'}: error = |field| - |true distance|, in"
        f"{unit or ' scene units'}",
        "",
        f"{'':8}" + "".join(f"{word:>11}" for word in head) + "   where the maximum is",
    ]
    for name in ("inside", "outside"):
        side = getattr(measured, name)
        numbers = (side.mean, side.rms, side.max, side.least, side.greatest)
        shown = "".join(f"{number:11.3g}" for number in numbers)
        place = ", ".join(f"{x:.5g}" for x in side.where)
        lines.append(f"{name:8}{side.points:11d}{shown}   ({place})")
    moved = f"by at most {bound:.4g}{unit}" if math.isfinite(bound) else "by no known bound"
    lines += [
        "",
        "measured  at these points only, against closest points on "
        f"{len(surface.triangles)} triangles",
        f"measured  those are within {surface.error:.2g}{unit} of the surface, "
        f"{surface.mean_error:.2g} on average, at {surface.checks} points:",
        "          errors below that are the mesh's",
        f"proven    blends move the field {moved} from minima and maxima, which are no",
        "          distances themselves",
        f"labelled  {measured.exactness[0]} inside, {measured.exactness[1]} outside, by "
        "construction",
    ]
    return "\n".join(lines) + "\n"


def csv_of(measured):
    columns = (measured.points, measured.field, measured.true, measured.error)
    rows = np.column_stack(columns).tolist()
    lines = [",".join(f"{value:.10g}" for value in row) for row in rows]
    return "\n".join(["x,y,z,field,true,error", *lines]) + "\n"
