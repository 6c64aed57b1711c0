"""A bronze bushing with a hard inside, from Python: its grams, its mesh, and how it is graded.

Run it as `python examples/bushing.py FOLDER`; the folder (default: the current one) receives
bushing.json, which `sardf` and Blender read, and bushing.csv.
"""

import sys
from pathlib import Path

import numpy as np
import sardf

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

bore = sardf.cylinder(radius=6)
with sardf.blend(sardf=1.5):  # both edges of the bore become arcs of this radius
    body = sardf.cylinder(radius=10, height=16) | sardf.cylinder(
        center=(0, 0, -7), radius=14, height=3
    )
    bushing = body - bore

scene = sardf.Scene(
    title="bushing",
    solid=bushing,
    materials={
        "bronze": {"color": "#b5722a", "metallic": 1, "density": 8.8},
        "carbide": {"color": "#1d2f63", "density": 15.6},
    },
    fractions={
        "ramp": {
            "field": bore,  # negative outside the bore: minus the depth below its wall
            "stops": [{"at": -2, "material": "bronze"}, {"at": 0, "material": "carbide"}],
        }
    },
)
scene.save(str(folder / "bushing.json"))

mesh = scene.mesh(resolution=96)
print(f"{len(mesh.vertices)} vertices, {len(mesh.faces)} quads")

# Along a radius: the field, and the fractions of both materials.
points = np.zeros((17, 3))
points[:, 0] = np.linspace(6, 10, 17)
table = np.column_stack([points[:, 0], scene.solid(points), scene.fractions(points)])
np.savetxt(
    folder / "bushing.csv", table, delimiter=",", header="x,field,bronze,carbide", comments=""
)
print(table[::4].round(3))
