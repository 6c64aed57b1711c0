"""The most memory of a process that makes one mesh of a peers' shape, in GiB, and its faces.

    python bench/mesh_memory.py S1 [--box tight] [--cells 1024]

Python, NumPy and sardf themselves, about 0.03 GiB, are in it.
"""

import argparse
import re
from pathlib import Path

from peer_shapes import BOXES, NAMES, Grid


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shape", choices=NAMES)
    parser.add_argument("--box", choices=BOXES, default="tight")
    parser.add_argument("--cells", type=int, default=1024)
    options = parser.parse_args()
    mesh = Grid(options.shape, options.box, options.cells).mesh()
    # getrusage would count what the process that started this one had.
    status = Path("/proc/self/status").read_text()
    kib = re.search(r"^VmHWM:\s*(\d+) kB$", status, re.MULTILINE)[1]
    print(f"{int(kib) / 2**20:.2f} GiB, {len(mesh.faces)} quads")


if __name__ == "__main__":
    main()
