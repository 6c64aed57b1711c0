"""What a bake was said to take and what it took; run as: bake_probe.py ROOT SCENE RESOLUTION SIZE.

Prints JSON: "seconds" and "bytes" as [estimated, measured], with the parts of the time. The peak of
the memory is that of the process (proc(5): VmHWM, which clear_refs sets back) over what it had.
"""

import json
import sys
import tempfile
import time
from pathlib import Path

import sardf

root, scene_file, resolution, size, *names = sys.argv[1:]
sys.path.insert(0, root)
from blender_addon.baked import job, store  # noqa: E402


def memory(word):
    line = next(x for x in Path("/proc/self/status").read_text().splitlines() if x.startswith(word))
    return int(line.split()[1]) * 1024


names = tuple(names) or job.CHANNELS
sample = sardf.measure_bake(sardf.load(scene_file), names)
cost = sample.cost(int(resolution), int(size))
marks = {}


def progress(share):
    for place, end in enumerate((0.4, 0.8, 1.0)):
        if share <= end:
            marks[place] = time.perf_counter()
            return True
    return True


with tempfile.TemporaryDirectory() as folder:
    request = job.Request(
        scene_file, int(resolution), int(size), channels=names, store=store.Store(folder)
    )
    Path("/proc/self/clear_refs").write_text("5")
    before, begun = memory("VmRSS"), time.perf_counter()
    part = job.make_part(sardf, request, progress)
    took, peak = time.perf_counter() - begun, memory("VmHWM") - before
marks = [begun, *(marks.get(place, begun) for place in range(3))]
print(json.dumps({
    "seconds": [cost.seconds, took],
    "stages": [
        [estimated, stop - start]
        for estimated, start, stop in zip(
            (cost.mesh_seconds, cost.bake_seconds, cost.store_seconds), marks, marks[1:],
            strict=False,
        )
    ],
    "bytes": [cost.bytes, peak],
    "faces": [cost.faces, len(part.mesh.faces)],
    "texels per unit": [cost.texels_per_unit, part.texels_per_unit],
}))  # fmt: skip
