"""Numbers of SVG attributes: lengths in user units, transforms, the viewBox."""

import math
import re

import numpy as np

from sardf._command import library

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
LENGTH = re.compile(rf"\s*({NUMBER})\s*(px|pt|pc|mm|cm|in|Q|%)?\s*")
NUMBERS = re.compile(rf"[\s,]*(?:{NUMBER}[\s,]*)*")
TRANSFORMS = re.compile(r"[\s,]*(?:(?:matrix|translate|scale|rotate|skew[XY])\s*\([^()]*\)[\s,]*)*")
# User units, of which CSS counts 96 in an inch.
UNITS = {"px": 1, "in": 96, "pt": 96 / 72, "pc": 16, "cm": 96 / 2.54, "mm": 96 / 25.4}
UNITS["Q"] = UNITS["mm"] / 4


def numbers_of(text, fail, what):
    """The numbers of a list, which may be separated by nothing but their signs."""
    if not NUMBERS.fullmatch(text):
        fail(f"'{text}' is no list of numbers, as {what} needs it")
    return [float(number) for number in re.findall(NUMBER, text)]


def view_size(attributes, fail):
    """Width and height of the outermost viewBox; none when there is none."""
    if "viewBox" not in attributes:
        return None
    numbers = numbers_of(attributes["viewBox"], fail, "a viewBox")
    if len(numbers) != 4 or min(numbers[2:]) <= 0:
        fail(f"the viewBox '{attributes['viewBox']}' must be x, y, a width and a height above 0")
    return tuple(numbers[2:])


def length(element, key, missing=0.0):
    """A length in user units; percentages are those of the viewBox."""
    text = element.attributes.get(key)
    if text is None or text.strip() == "auto":
        return missing
    found = LENGTH.fullmatch(text)
    if not found:
        element.fail(f"'{text}' is no length for '{key}'; a number is accepted")
    value, unit = float(found[1]), found[2]
    if unit != "%":
        return value * UNITS[unit or "px"]
    if element.view is None:
        element.fail(f"'{key}' is {text}, and the drawing has no viewBox that would say of what")
    width, height = element.view
    if key in ("x", "cx", "rx", "width", "x1", "x2"):
        return value / 100 * width
    if key in ("y", "cy", "ry", "height", "y1", "y2"):
        return value / 100 * height
    return value / 100 * math.hypot(width, height) / math.sqrt(2)


def matrix_of(text, fail):
    """A transform attribute as a (3, 3) matrix."""
    if not text or text.strip() == "none":
        return np.eye(3)
    if not TRANSFORMS.fullmatch(text):
        fail(f"the transform '{text}' cannot be read")
    for arguments in re.findall(r"\(([^()]*)\)", text):
        numbers_of(arguments, fail, "a transform")
    try:
        m = library("svgelements", "svg").Matrix(text)
    except (ValueError, IndexError, TypeError, ArithmeticError):
        fail(f"the transform '{text}' cannot be read")
    return np.array([[m.a, m.c, m.e], [m.b, m.d, m.f], [0.0, 0.0, 1.0]], dtype=float)
