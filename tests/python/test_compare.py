"""Blender's pictures against POV-Ray's on every scene; and that the comparison can fail."""

import json
import subprocess
from pathlib import Path

import pytest
import sardf

ROOT = Path(__file__).resolve().parents[2]
SARDF = ROOT / ".venv/bin/sardf"
SCENES = sorted(path.stem for path in (ROOT / "scenes").glob("*.json"))
# Stripes and steep gradients need more pixels for enough of them to be flat.
STEEP = [name for name in SCENES if name.endswith("_stripes")] + ["tooth_cut", "tooth_slice"]
LATTICES = ["gyroid_sandwich"]
BLENDERS = ["blender", str(ROOT / ".venv-bpy/bin/python")]


def compare(output, scenes, *options, blenders=BLENDERS, size="320x240"):
    """Runs `sardf compare`; its exit code and numbers."""
    command = [SARDF, "compare", *scenes, "-o", output, "--size", size]
    for blender in blenders:
        command += ["--blender", blender]
    done = subprocess.run(
        [str(word) for word in [*command, *options]], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode in (0, 1), done.stderr
    return done, json.loads((Path(output) / "numbers.json").read_text())


@pytest.fixture(scope="module")
def numbers(tmp_path_factory):
    output = tmp_path_factory.mktemp("compare")
    lattices = [word for name in LATTICES for word in ("--lattice", name)]
    scenes = [ROOT / "scenes" / f"{name}.json" for name in SCENES if name not in STEEP]
    return compare(output, scenes, *lattices)[1]


def missed(verdict):
    """The criteria that do not hold."""
    assert verdict["passes"] == all(c["holds"] for c in verdict["criteria"])
    return [c for c in verdict["criteria"] if not c["holds"]]


@pytest.mark.parametrize("blender", range(len(BLENDERS)))
@pytest.mark.parametrize("scene", sorted(set(SCENES) - set(STEEP)))
@pytest.mark.timeout(900)
def test_pictures_agree(numbers, scene, blender):
    assert not missed(list(numbers[scene].values())[blender])


@pytest.mark.long
@pytest.mark.parametrize("scene", STEEP)
@pytest.mark.timeout(1800)
def test_large_pictures_agree(tmp_path, scene):
    path = ROOT / "scenes" / f"{scene}.json"
    verdicts = compare(tmp_path / "out", [path], size="640x480")[1][scene]
    assert len(verdicts) == len(BLENDERS)
    for verdict in verdicts.values():
        assert not missed(verdict)


# A block cut open, coloured by its distances to a ball and its middle, or by the field of the block
# without the ball, whose level lines have the radius R.
BLOCK = """{"sardf": 1, "title": "block", "parameters": {"R": 1}, "fields": {
  "block": {"box": {"size": [8, 6, 4]}}, "ball": {"sphere": {"radius": 2.5}},
  "part": {"difference": {"of": ["block", "ball"], "blend": {"sardf": "=R"}}}},
  "solid": "block",
  "materials": {"red": {"color": "#d03020"}, "blue": {"color": "#2040c0"}},
  "fractions": FRACTIONS,
  "sections": [{"remove": {"half_space": {"normal": [0, -1, 0]}}}]}
"""
WEIGHTED = """{"inverse_distance": {"features": [
    {"at": {"boundary": {"solid": "ball"}}, "material": "red", "exponent": 2},
    {"at": {"point": {"at": [0, 0, 0]}}, "material": "blue", "exponent": 2}]}}"""
ROUNDED = """{"ramp": {"field": "part", "stops": [
    {"at": 0, "material": "red"}, {"at": 1, "material": "blue"}]}}"""


@pytest.mark.parametrize(
    ("fractions", "old", "new"),
    [
        (ROUNDED, '"R": 1', '"R": 0.4'),
        (WEIGHTED, '"blue", "exponent": 2', '"blue", "exponent": 1.5'),
        (WEIGHTED, "#d03020", "#d03828"),
    ],
    ids=["R", "exponent", "color"],
)
def test_a_changed_scene_is_noticed(tmp_path, fractions, old, new):
    text = BLOCK.replace("FRACTIONS", fractions)
    assert old in text
    scene, same, changed = (tmp_path / f"{name}.json" for name in ("scene", "same", "changed"))
    scene.write_text(text)
    same.write_text(text)
    changed.write_text(text.replace(old, new))
    for reference, code in ((same, 0), (changed, 1)):
        options = ("--reference", reference, "--texture", "1024")
        done, _ = compare(tmp_path / "out", [scene], *options, blenders=["blender"])
        assert done.returncode == code, done.stdout + done.stderr
    assert "asked for" in done.stderr


def test_a_camera_moved_by_a_pixel_is_noticed(tmp_path):
    scene = ROOT / "scenes/two_ellipsoids.json"
    camera = sardf.load(str(scene)).camera(width=320, height=240)
    camera["shift_x"] += 1 / 320
    (tmp_path / "camera.json").write_text(json.dumps(camera))
    options = ("--reference-camera", tmp_path / "camera.json", "--texture", "512")
    done, _ = compare(tmp_path / "out", [scene], *options, blenders=["blender"])
    assert done.returncode == 1, done.stdout
    assert "asked for" in done.stderr
