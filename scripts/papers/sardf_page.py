"""The page of Fayolle et al. 2004, with what it says in numbers measured."""

import json
import math
from pathlib import Path

import numpy as np
import sardf

from papers import sardf_tables as tables
from papers.page import table
from papers.paper import FOLDER, ROOT, Drawing, Paper
from papers.sardf_figures import CREASE, PARTS, TREE_ERROR

CORNER = FOLDER / "scenes/corner.json"
MEASURED = FOLDER / "sardf_accuracy.json"

ACCURACY = [
    f"{scene} --blend {blend}"
    for scene in ("scenes/two_ellipsoids.json", "scenes/cad_plate.json")
    for blend in ("sardf=0.5", "min_max")
]
# The picture that sardf.accuracy draws, and how it is asked to.
MAP = ("sardf_true_error.png", "scenes/two_ellipsoids.json --section y=0")
BOUNDED = (
    ("two_ellipsoids", "both", "y"),
    ("cad_plate", "part", "z"),
    ("cad_plate", "feature_2", "z"),
    ("cad_pins", "insert", "y"),
    ("tooth_slice", "outer", "z"),
)


def values() -> dict[str, str]:
    """What the page says besides its figures."""
    ours = tables.OURS_WRITTEN if (FOLDER / "table1.md").exists() else tables.OURS_TO_MEASURE
    return {
        **exactness(),
        "times": times_table(),
        "our_times": ours,
        "jumps": jumps_table(),
        "crease_pictures": PAPER.pictures_of(CREASE, CREASE.shows),
        "error_pictures": PAPER.pictures_of(TREE_ERROR, TREE_ERROR.shows),
        "bounds": bounds_table(),
        "accuracy": accuracy_table(),
        "commands": "\n".join(f"$ python -m sardf.accuracy {words}" for words in ACCURACY),
        "map": map_text(),
        "typos": table(("place", "printed", "read as", "because"), tables.TYPOS),
        "chosen": table(("section", "not printed", "chosen here"), tables.CHOSEN),
    }


def map_text() -> str:
    image, words = MAP
    return (
        f"![Where the two ellipsoids' field differs from the true distance](images/{image})\n\n"
        f"```console\n$ python -m sardf.accuracy {words} -o {image}\n```"
    )


def times_table() -> str:
    rows = []
    for points, *groups in tables.TIMES:
        for word, seconds in zip(("intersection", "union"), groups, strict=True):
            rows.append((points, word, *seconds, *quotients(seconds)))
    names = ("SARDF", "min or max", "R-function")
    return table(("points", "", *names, *(f"SARDF : {name}" for name in names[1:])), rows)


def quotients(seconds) -> list[str]:
    return [f"{seconds[0] / other:.2f}" for other in seconds[1:]]


def jumps_table() -> str:
    fields = sardf.load(str(CORNER)).fields
    rows = []
    for level, exact in zip((1, -2), tables.JUMP_FORMULAS, strict=True):
        jumps = (f"{jump(fields[name], level):.6f}" for name in ("corner", "corner_c1"))
        rows.append((f"{{F = {'R' if level == 1 else '-2R'}}}", *jumps, exact))
    return table(("arc", "jump of `sardf`", "jump of `sardf_c1`", "exactly, `sardf`"), rows)


def jump(field, level, step=1e-6) -> float:
    """How much the slope along the diagonal jumps where R = 1 and the field has that level."""
    middle = level + 1 - 1 / math.sqrt(2)
    before, there, after = field([[middle + i * step] * 2 + [0] for i in (-1, 0, 1)])
    return abs(after - 2 * there + before) / (step * math.sqrt(2))


def exactness() -> dict:
    corner = sardf.load(str(CORNER)).fields["corner_min"]
    inside, outside = corner.exactness
    value = f"{corner([[-3, -4, 0]])[0]:g}"
    return {"corner_min": value, "corner_inside": inside, "corner_outside": outside}


def bounds_table() -> str:
    rows = [bound_row(*named) for named in BOUNDED]
    head = ("field", "R", "operations on the deepest path", "proven bound", "greatest found")
    return table(head, rows)


def bound_row(scene_name, name, across):
    scene = sardf.load(str(ROOT / f"scenes/{scene_name}.json"))
    field = scene.fields[name]
    radius = json.loads(scene.to_json())["parameters"]["R"]
    bound = field.error_bound()
    found = greatest_error(scene, field, across)
    operations = round(bound / ((1 - 1 / math.sqrt(2)) * radius))
    return f"`{scene_name}`: `{name}`", radius, operations, f"{bound:.3f}", f"{found:.3f}"


def greatest_error(scene, field, across) -> float:
    """On a plane through the middle of the scene's bounds, and a margin around them."""
    low, high = (np.array(corner) for corner in scene.bounds)
    margin = (high - low).max() / 4
    axes = [np.linspace(a - margin, b + margin, 400) for a, b in zip(low, high, strict=True)]
    axes["xyz".index(across)] = np.array([0.0])
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return float(np.abs(sardf.blend_error(field)(points)).max())


def accuracy_table() -> str:
    """From the summaries of sardf.accuracy, which are measured together with the pictures."""
    rows = []
    for words, found in json.loads(MEASURED.read_text()).items():
        scene, _, blend = words.split()
        for side, errors in found["measured"].items():
            rows.append((
                f"`{Path(scene).stem}`, `{blend}`", side,
                f"{errors['mean']:.1e}", f"{errors['max']:.1e}",
                f"{found['reference']['max_error']:.1e}",
            ))  # fmt: skip
    return table(("scene and blend", "side", "mean (mm)", "largest (mm)", "mesh (mm)"), rows)


_image, _words = MAP
PAPER = Paper(
    "sardf", PARTS, extra=(CREASE, TREE_ERROR), values=values,
    others=(Drawing(_image, "sardf.accuracy", [*_words.split(), "-o", _image]),),
)  # fmt: skip
