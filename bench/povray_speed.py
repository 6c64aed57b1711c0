"""How fast POV-Ray draws our text, against a plain translation and POV-Ray's `evaluate`.

    python bench/povray_speed.py --size 320x240 [scenes/tooth.json ...]

The plain translation is one isosurface of the solid's function in its certified box, with the
smallest max_gradient, found by trial, that gives the picture; `evaluate` finds its own as it
goes. Our text has the pieces, fields and bounds that it is written with. All are drawn flat and
white, by one thread, and what counts is processor time, calls of functions, and how far the mask
agrees with that of the plain translation with twice our max_gradient. Of the time, "start" is what
passes before the first ray: reading the text and density files, and sorting boxes; it is part of
all times. The last columns are the largest max_gradient of our pieces, without its margin, and the
steepest gradient near the surface: what samples find of the scene's field, or, where the solid is
read from a density file, the most that its cells have. Needs POV-Ray 3.7 and the package sardf.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import sardf
from sardf import _image

ROOT = Path(__file__).resolve().parents[1]
COMMAND = Path(sys.executable).with_name("sardf")
MARGIN = 1.02  # of max_gradient, in our text
GRADIENT = re.compile(r"max_gradient ([\d.e+-]+)")
BOX = re.compile(r"contained_by \{ box \{ <(.*?)>, <(.*?)> \} \}")


class Drawing:
    """Include texts of one scene, drawn."""

    def __init__(self, scene, folder, width, height):
        self.folder, self.size = folder, [f"+W{width}", f"+H{height}"]
        arguments = [COMMAND, "povray", scene, "-o", "a.pov", "--look", "flat"]
        arguments += ["--width", str(width), "--height", str(height)]
        subprocess.run(arguments, cwd=folder, check=True, capture_output=True)
        # Colours cost all of them the same.
        white = re.sub(r"pigment \{ \w+ \}", "pigment { rgb 1 }", (folder / "a.pov").read_text())
        (folder / "a.pov").write_text(white)
        self.include = (folder / "a.inc").read_text()

    def draw(self, include):
        """The mask, the processor's seconds, the calls of functions."""
        (self.folder / "a.inc").write_text(include)
        # A path that begins with / would be taken for an option.
        arguments = ["povray", "+I./a.pov", "+O./a.exr", *self.size, "+FE", "+UA", "-D", "+WT1"]
        done = subprocess.run(
            [*arguments, "-A"], cwd=self.folder, check=True, capture_output=True, text=True
        )
        # Of parsing, of sorting boxes, of tracing.
        times = list(map(float, re.findall(r"([\d.]+) CPU-seconds", done.stderr)))
        self.start, seconds = sum(times[:2]), sum(times)
        calls = int(re.search(r"Function VM calls: *(\d+)", done.stderr)[1])
        return _image.read(str(self.folder / "a.exr"))[..., 3] >= 0.5, seconds, calls

    def plain(self, max_gradient, more=""):
        """All of the solid in one container, by its own function."""
        text = re.sub(r"#if \(\w+_csg\)\n  isosurface", "#if (yes)\n  isosurface", self.include)
        prefix = re.search(r"#declare (\w+)_csg", text)[1]
        solid = f"isosurface {{\n    function {{ -({prefix}_solid(x, y, z)) }}"
        text = re.sub(r"isosurface \{\n    function \{ .* \}", solid, text, count=1)
        return GRADIENT.sub(f"max_gradient {max_gradient} {more}", text)

    def bounds(self):
        """Of the pieces, without the margin; the first isosurface of several is the whole."""
        bounds = [float(g) / MARGIN for g in GRADIENT.findall(self.include)]
        return bounds[1:] or bounds

    def density(self):
        """The values and the steps of the samples that the solid is read from; else nothing."""
        text = re.sub(r"\s+", " ", self.include)
        for name in re.findall(r"(\w+)\(x, y, z\)", re.search(r"isosurface \{.*?\}", text)[0]):
            function = re.search(rf"#declare {name} = function\(x, y, z\) \{{(.*?)\}}", text)
            if not function or f"{name}_samples(" not in function[1]:
                continue
            file = re.search(rf'#declare {name}_samples = .*? df3 "(.*?)"', text)[1]
            data = (self.folder / file).read_bytes()
            stored = np.frombuffer(data[:6], ">u2").astype(int)
            codes = np.frombuffer(data[6:], ">u4").reshape(stored[::-1])[:-1, :-1, :-1]
            low, factor = re.search(rf"(\S+) \+ (\S+) \* {name}_samples\(", function[1]).groups()
            scales = np.array(re.findall(r"\) \* ([\d.e+-]+), 0\)", function[1]), float)
            return float(low) + float(factor) / (2**32 - 1) * codes, 1 / (scales * stored)
        return None


def agreement(one, other):
    return (one & other).sum() / max((one | other).sum(), 1)


def smallest_gradient(drawing, reference):
    """By halving and doubling: the least of 2 ** (k / 4) whose picture is the reference's."""
    k = 8
    while agreement(drawing.draw(drawing.plain(2 ** (k / 4)))[0], reference) < 0.999 and k < 40:
        k += 4
    for step in (4, 2, 1):
        while (
            k - step >= -12
            and agreement(drawing.draw(drawing.plain(2 ** ((k - step) / 4)))[0], reference) >= 0.999
        ):
            k -= step
    return 2 ** (k / 4)


def steepest_cell(values, steps):
    """The longest gradient of trilinear cells at the surface: one at a corner of a cell."""
    cells = [n - 1 for n in values.shape]
    squares = np.zeros(cells)
    low, high = np.full(cells, np.inf), np.full(cells, -np.inf)
    for corner in np.ndindex(2, 2, 2):
        at = [slice(c, c + n) for c, n in zip(corner, cells, strict=True)]
        low = np.minimum(low, values[tuple(at)])
        high = np.maximum(high, values[tuple(at)])
        rises = 0
        for axis in range(3):
            beside = at[:axis] + [slice(None)] + at[axis + 1 :]
            rises = rises + (np.diff(values, axis=axis)[tuple(beside)] / steps[2 - axis]) ** 2
        squares = np.maximum(squares, rises)
    return np.sqrt(squares[(low <= 0) & (high >= 0)].max())


def steepest(drawing, field):
    """The longest gradient near the surface that is found."""
    density = drawing.density()
    if density:
        return steepest_cell(*density)
    lo, hi = [np.fromstring(end, sep=",") for end in BOX.search(drawing.include).groups()]
    points = lo + (hi - lo) * np.random.default_rng(1).random((200_000, 3))
    near = np.abs(field(points)) < 0.02 * np.linalg.norm(hi - lo)
    return np.nanmax(np.linalg.norm(field.gradient(points[near]), axis=1))


def row(scene, width, height):
    with tempfile.TemporaryDirectory() as folder:
        drawing = Drawing(scene, Path(folder), width, height)
        reference = drawing.draw(drawing.plain(2 * MARGIN * max(drawing.bounds())))[0]
        mask, seconds, calls = drawing.draw(drawing.include)
        start = drawing.start
        gradient = smallest_gradient(drawing, reference)
        plain_seconds, plain_calls = drawing.draw(drawing.plain(gradient))[1:]
        other = drawing.draw(drawing.plain(gradient, "evaluate 1, 1.2, 0.99"))
        truth = steepest(drawing, sardf.load(str(scene)).drawn)
    bounds = drawing.bounds()
    return (
        f"| {scene.stem} | {len(bounds)} | {calls} | {start:.2f} | {seconds:.2f} "
        f"| {agreement(mask, reference):.4f} "
        f"| {gradient:.2f} | {plain_calls} | {plain_seconds:.2f} | {other[2]} | {other[1]:.2f} "
        f"| {agreement(other[0], reference):.4f} | {calls / plain_calls:.2f} "
        f"| {seconds / plain_seconds:.2f} | {max(bounds):.3f} | {truth:.3f} |"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scenes", nargs="*", default=sorted((ROOT / "scenes").glob("*.json")))
    parser.add_argument("--size", default="160x120", help="WIDTHxHEIGHT")
    arguments = parser.parse_args()
    width, height = arguments.size.split("x")
    print(
        "| scene | pieces | calls | start | seconds | IoU | plain: max_gradient | calls | seconds "
        "| evaluate: calls | seconds | IoU | calls / plain | time / plain | bound | steepest |"
    )
    print("|" + " --- |" * 16)
    for scene in arguments.scenes:
        print(row(Path(scene).resolve(), width, height), flush=True)


if __name__ == "__main__":
    main()
