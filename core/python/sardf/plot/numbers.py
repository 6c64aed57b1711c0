"""Numbers in the words of a user: points, windows, steps."""

import numpy as np

from sardf._words import fail


def numbers(text, count: int, what: str, example: str) -> np.ndarray:
    """`count` finite numbers from "a,b,..." or a sequence; Error otherwise."""
    parts = text.split(",") if isinstance(text, str) else list(text)
    try:
        values = np.array([float(part) for part in parts])
    except (TypeError, ValueError):
        values = np.array([])
    if len(values) != count or not np.isfinite(values).all():
        fail(f"the {what} is '{text}'; {count} finite numbers are accepted, as in \"{example}\"")
    return values


def point(text, what: str = "point") -> np.ndarray:
    """A point or direction (3,), in scene units."""
    return numbers(text, 3, what, "0,0,1")


def brief(value: float, digits: int = 4) -> str:
    """A number for labels and titles, with so many significant digits."""
    text = f"{0.0 if abs(value) < 1e-12 else value:.{digits}g}"
    return text.replace("-", "−")


def triple(values, digits: int = 4) -> str:
    """(x, y, z) for labels and titles."""
    return f"({', '.join(brief(value, digits) for value in values)})"
