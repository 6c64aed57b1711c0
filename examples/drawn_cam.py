"""A cam drawn as an SVG file: hardened towards its running face, bronze around its shaft.

python examples/drawn_cam.py [FOLDER] writes cam.json, which `sardf` and Blender read, and cam.pov
there.
"""

import sys
from pathlib import Path

import sardf
import sardf.svg

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# Arcs and splines become polylines that are nowhere farther than 0.01 mm from the drawing.
drawing = sardf.svg.read_contours(Path(__file__).with_name("cam.svg"), tolerance=0.01)
outline = sardf.polygon(drawing["outline"])
shaft = sardf.union(sardf.polygon(drawing["shaft"]), sardf.polygon(drawing["key"]))

with sardf.blend(sardf=1.0):
    cam = sardf.extrude(sardf.difference(outline, shaft), height=8)

scene = sardf.Scene(
    solid=cam,
    title="cam",
    fields={"outline": outline, "shaft": shaft},
    materials={
        "hardened": {"color": "#2b3a67", "metallic": 1, "roughness": 0.3, "density": 7.8},
        "bronze": {"color": "#b5803a", "metallic": 1, "roughness": 0.4, "density": 8.8},
    },
    fractions={
        "inverse_distance": {
            "features": [
                {"at": sardf.boundary(outline), "material": "hardened", "exponent": 2},
                {"at": sardf.boundary(shaft), "material": "bronze", "exponent": 2},
            ]
        }
    },
)
print("proven: blending moves the field by at most", round(cam.error_bound(), 4), scene.units)
print("in the middle of the web:", scene.fractions([[46.5, -25, 0]])[0].round(3))

scene.save(str(folder / "cam.json"))
scene.povray(str(folder / "cam.pov"))
