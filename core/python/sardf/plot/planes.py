"""The plane of a section, and the two directions in which it is drawn."""

from dataclasses import dataclass

import numpy as np

from sardf._words import fail, number
from sardf.plot.numbers import brief, point, triple

AXES = "xyz"
# What is drawn to the right and upwards where a section is perpendicular to an axis.
DRAWN = {"x": ("y", "z"), "y": ("x", "z"), "z": ("x", "y")}


@dataclass(frozen=True)
class Plane:
    """origin + a * right + b * up. Vectors are (3,), origin in scene units, right and up of unit
    length and perpendicular to each other. `labels` name both directions, `name` the plane."""

    origin: np.ndarray
    right: np.ndarray
    up: np.ndarray
    labels: tuple[str, str]
    name: str

    @property
    def normal(self) -> np.ndarray:
        """Towards the viewer, (3,)."""
        return np.cross(self.right, self.up)

    def points(self, a, b) -> np.ndarray:
        """Points (..., 3) at the coordinates a and b in the plane."""
        a, b = np.asarray(a)[..., None], np.asarray(b)[..., None]
        return self.origin + a * self.right + b * self.up

    def coordinates(self, points) -> np.ndarray:
        """(..., 3): a, b and the height above the plane, of points (..., 3)."""
        frame = np.array([self.right, self.up, self.normal])
        return (np.asarray(points, float) - self.origin) @ frame.T


def axis_plane(axis: str, value: float) -> Plane:
    """The plane axis = value, drawn in the scene's own coordinates."""
    right, up = DRAWN[axis]
    unit = dict(zip(AXES, np.eye(3), strict=True))
    return Plane(value * unit[axis], unit[right], unit[up], (right, up), f"{axis} = {brief(value)}")


def plane_through(at, normal) -> Plane:
    """The plane through a point, seen against its normal (any length).

    z is drawn upwards as far as the plane allows, or y where the plane is nearly horizontal. A
    normal along an axis gives the same section as `axis=value`. Error for a normal of length 0.
    """
    at, normal = point(at), point(normal, "normal")
    length = np.linalg.norm(normal)
    if not length > 0:
        fail(f'the normal is {triple(normal)}; a direction is accepted, as in "0,0,1"')
    normal = normal / length
    if np.abs(normal).max() > 1 - 1e-12:
        axis = int(np.abs(normal).argmax())
        return axis_plane(AXES[axis], at[axis])
    upwards = np.eye(3)[1 if abs(normal[2]) > 0.9 else 2]
    up = upwards - (upwards @ normal) * normal
    up /= np.linalg.norm(up)
    right = np.cross(up, normal)
    labels = (f"along {triple(right, 3)}", f"along {triple(up, 3)}")
    return Plane(at, right, up, labels, f"plane through {triple(at)} normal to {triple(normal, 3)}")


def plane(text) -> Plane:
    """A plane from "y=0" (or x or z), a pair (point, normal), or a Plane as it is."""
    if isinstance(text, Plane):
        return text
    if not isinstance(text, str):
        return plane_through(*text)
    axis, equals, value = (part.strip() for part in text.partition("="))
    if axis not in DRAWN or not equals:
        fail(f"the section is '{text}'; x=, y= or z= and a number is accepted, as in y=0")
    return axis_plane(axis, number(value, f"section's {axis}"))
