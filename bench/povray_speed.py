"""How fast POV-Ray draws our text, against a plain translation and POV-Ray's `evaluate`.

    python bench/povray_speed.py --size 160x120 [scenes/tooth.json ...]

The plain translation is one isosurface of the solid's function in its certified box, with the
smallest max_gradient, found by trial, that gives the picture; `evaluate` finds its own as it
goes. Our text has the pieces and bounds that it is written with. All are drawn flat and white, by
one thread, and what counts is processor time, calls of functions, and how far the mask agrees with
one that is drawn with twice our max_gradient. The last columns are the largest max_gradient of our
pieces, without its margin, and the steepest gradient that samples find near the surface. Needs
POV-Ray 3.7 and the package sardf.
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
        seconds = sum(map(float, re.findall(r"([\d.]+) CPU-seconds", done.stderr)))
        calls = int(re.search(r"Function VM calls: *(\d+)", done.stderr)[1])
        return _image.read(str(self.folder / "a.exr"))[..., 3] >= 0.5, seconds, calls

    def doubled(self):
        return GRADIENT.sub(lambda m: f"max_gradient {2 * float(m[1])}", self.include)

    def plain(self, max_gradient, more=""):
        """All of the solid in one container."""
        text = re.sub(r"#if \(\w+_csg\)\n  isosurface", "#if (yes)\n  isosurface", self.include)
        text = re.sub(r"function \{ min\(\S+, max\(\S+, (.*?)\)\) \}", r"function { \1 }", text)
        return GRADIENT.sub(f"max_gradient {max_gradient} {more}", text)


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


def bounds_and_truth(drawing, field):
    """How many pieces, their largest bound, and the steepest gradient near the surface."""
    boxes = [[np.fromstring(end, sep=",") for end in box] for box in BOX.findall(drawing.include)]
    bounds = [float(g) / MARGIN for g in GRADIENT.findall(drawing.include)]
    # The first is the whole, for constructive geometry, where there are pieces.
    lo, hi = boxes[0]
    points = lo + (hi - lo) * np.random.default_rng(1).random((200_000, 3))
    near = np.abs(field(points)) < 0.02 * np.linalg.norm(hi - lo)
    steepest = np.nanmax(np.linalg.norm(field.gradient(points[near]), axis=1))
    return len(bounds[1:] or bounds), max(bounds[1:] or bounds), steepest


def row(scene, width, height):
    with tempfile.TemporaryDirectory() as folder:
        drawing = Drawing(scene, Path(folder), width, height)
        reference = drawing.draw(drawing.doubled())[0]
        mask, seconds, calls = drawing.draw(drawing.include)
        gradient = smallest_gradient(drawing, reference)
        plain_seconds, plain_calls = drawing.draw(drawing.plain(gradient))[1:]
        other = drawing.draw(drawing.plain(gradient, "evaluate 1, 1.2, 0.99"))
        pieces, bound, steepest = bounds_and_truth(drawing, sardf.load(str(scene)).drawn)
    return (
        f"| {scene.stem} | {pieces} | {calls} | {seconds:.2f} | {agreement(mask, reference):.4f} "
        f"| {gradient:.2f} | {plain_calls} | {plain_seconds:.2f} | {other[2]} | {other[1]:.2f} "
        f"| {agreement(other[0], reference):.4f} "
        f"| {seconds / plain_seconds:.2f} | {bound:.3f} | {steepest:.3f} |"
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scenes", nargs="*", default=sorted((ROOT / "scenes").glob("*.json")))
    parser.add_argument("--size", default="160x120", help="WIDTHxHEIGHT")
    arguments = parser.parse_args()
    width, height = arguments.size.split("x")
    print(
        "| scene | pieces | calls | seconds | IoU | plain: max_gradient | calls | seconds "
        "| evaluate: calls | seconds | IoU | time / plain | bound | steepest |"
    )
    print("|" + " --- |" * 14)
    for scene in arguments.scenes:
        print(row(Path(scene).resolve(), width, height), flush=True)


if __name__ == "__main__":
    main()
