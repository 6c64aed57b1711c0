"""How many pixels a second `sardf render` and POV-Ray make of the same flat pictures, and how far
the pictures agree.

    python bench/render_rates.py --size 1280x960 [scenes/tooth.json ...]

POV-Ray draws the text that `sardf povray` writes, whose pieces and bounds sardf has found, and a
plain translation of the scene: one isosurface in its box, with the smallest max_gradient that, by
trial in a small picture, misses nothing; this one is white, so that colours cost it nothing. All
run on one thread, and what counts is processor time: other work on the machine changes it little.
Reading the scene is left out on all sides. Needs POV-Ray 3.7 and the package sardf.
"""

import argparse
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from povray_speed import MARGIN, Drawing, smallest_gradient
from sardf import _image

ROOT = Path(__file__).resolve().parents[1]
COMMAND = Path(sys.executable).with_name("sardf")
RUNS = 7


def seconds(pattern, text):
    """The number in the last match."""
    return float(re.findall(pattern, text)[-1])


def by_povray(scene, folder, width, height):
    """The picture and the processor's seconds."""
    size = ["--width", width, "--height", height]
    arguments = [COMMAND, "povray", scene, "-o", "a.pov", "--look", "flat", *map(str, size)]
    subprocess.run(arguments, cwd=folder, check=True, capture_output=True)
    # A path that begins with / would be taken for an option.
    arguments = ["povray", "+I./a.pov", "+O./povray.exr", f"+W{width}", f"+H{height}"]
    arguments += ["+FE", "+UA", "-D", "+WT1", "-A"]
    done = subprocess.run(arguments, cwd=folder, check=True, capture_output=True, text=True)
    taken = seconds(r"([\d.]+) CPU-seconds", done.stderr)
    return _image.read(str(folder / "povray.exr")), taken


def by_plain_povray(scene, folder, width, height):
    """The processor's seconds for tracing."""
    small = Drawing(scene, folder, 160, 120)
    reference = small.draw(small.plain(2 * MARGIN * max(small.bounds())))[0]
    gradient = smallest_gradient(small, reference)
    drawing = Drawing(scene, folder, width, height)
    taken = drawing.draw(drawing.plain(gradient))[1]
    return taken - drawing.start


def by_sardf(scene, folder, width, height):
    """The picture and the processor's seconds, the median of some runs."""
    arguments = [COMMAND, "render", scene, "-o", "sardf.exr", "--look", "flat", "--bits", "32"]
    arguments += ["--size", f"{width}x{height}", "--threads", "1", "--time"]
    taken = []
    for _ in range(RUNS):
        done = subprocess.run(arguments, cwd=folder, check=True, capture_output=True, text=True)
        taken.append(seconds(r"([\d.]+) s of all", done.stdout))
    return _image.read(str(folder / "sardf.exr")), statistics.median(taken)


def compare(reference, picture):
    """Intersection over union of the masks, and colour differences where both show something."""
    one, other = reference[..., 3] >= 0.5, picture[..., 3] >= 0.5
    both = one & other
    apart = np.abs(reference - picture)[both][:, :3].max(-1) * 255
    return both.sum() / (one | other).sum(), (apart > 2).sum(), apart.max()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scenes", nargs="*", default=sorted((ROOT / "scenes").glob("*.json")))
    parser.add_argument("--size", default="1280x960", help="WIDTHxHEIGHT")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    print("                    sardf   POV-Ray, ours    plain and white")
    print("scene                px/s     px/s   ratio     px/s   ratio      IoU  apart > 2  most")
    for scene in map(Path, options.scenes):
        with tempfile.TemporaryDirectory() as name:
            reference, theirs = by_povray(scene.resolve(), Path(name), width, height)
            picture, ours = by_sardf(scene.resolve(), Path(name), width, height)
            plain = by_plain_povray(scene.resolve(), Path(name), width, height)
        union, differing, most = compare(reference, picture)
        rate, text, translation = (width * height / taken for taken in (ours, theirs, plain))
        print(
            f"{scene.stem:17s} {rate:8.0f} {text:8.0f} {rate / text:7.0f} "
            f"{translation:8.0f} {rate / translation:7.0f} "
            f"{union:8.5f} {differing:10d} {most:5.1f}",
            flush=True,
        )


if __name__ == "__main__":
    main()
