"""How many pixels a second `sardf render` and POV-Ray make of the same flat pictures, and how far
the pictures agree.

    python bench/render_rates.py --size 320x240 [scenes/tooth.json ...]

Both run on one thread, and what counts is processor time: other work on the machine changes it
little. Reading the scene is left out on both sides. Needs POV-Ray 3.7 and the package sardf.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from sardf import _image

ROOT = Path(__file__).resolve().parents[1]
COMMAND = Path(sys.executable).with_name("sardf")


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


def by_sardf(scene, folder, width, height):
    arguments = [COMMAND, "render", scene, "-o", "sardf.exr", "--look", "flat", "--bits", "32"]
    arguments += ["--size", f"{width}x{height}", "--threads", "1", "--time"]
    done = subprocess.run(arguments, cwd=folder, check=True, capture_output=True, text=True)
    return _image.read(str(folder / "sardf.exr")), seconds(r"([\d.]+) s of all", done.stdout)


def compare(reference, picture):
    """Intersection over union of the masks, and colour differences where both show something."""
    one, other = reference[..., 3] >= 0.5, picture[..., 3] >= 0.5
    both = one & other
    apart = np.abs(reference - picture)[both][:, :3].max(-1) * 255
    return both.sum() / (one | other).sum(), (apart > 2).sum(), apart.max()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("scenes", nargs="*", default=sorted((ROOT / "scenes").glob("*.json")))
    parser.add_argument("--size", default="160x120", help="WIDTHxHEIGHT")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    print("scene               sardf px/s  POV-Ray px/s  ratio      IoU  apart > 2  most apart")
    for scene in map(Path, options.scenes):
        with tempfile.TemporaryDirectory() as name:
            reference, theirs = by_povray(scene.resolve(), Path(name), width, height)
            picture, ours = by_sardf(scene.resolve(), Path(name), width, height)
        union, differing, most = compare(reference, picture)
        rates = [width * height / taken for taken in (ours, theirs)]
        print(
            f"{scene.stem:18s} {rates[0]:11.0f} {rates[1]:13.0f} {rates[0] / rates[1]:6.0f} "
            f"{union:8.5f} {differing:10d} {most:7.1f}/255",
            flush=True,
        )


if __name__ == "__main__":
    main()
