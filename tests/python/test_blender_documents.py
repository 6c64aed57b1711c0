"""The examples of docs/blender.md run as they stand there, in four Blenders."""

import json
import re
import shlex

import numpy as np
import pytest
import sardf
from blender_runs import HEADLESS, run_script
from repository import ROOT

TEXT = (ROOT / "docs/blender.md").read_text()


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)


COMMANDS = [
    shlex.split(line, comments=True)[1:]
    for block in blocks("bash") for line in block.splitlines() if line.startswith("blender ")
]  # fmt: skip


@pytest.fixture(scope="module")
def made(run_check, version, tmp_path_factory):
    """(version, the folder in which the script of all Python examples ran, what it made)"""
    folder = tmp_path_factory.mktemp("documented")
    script = folder / "part.py"
    script.write_text("\n".join(blocks("python")))
    found = run_check(version, folder, "documented", "script", folder, script)
    return version, folder, found


def test_the_script_bakes_what_its_last_frame_is(made):
    """A rounded block of half sizes 2, 1.4, 0.8 with a bore of radius 0.9, cut at y = 0: the side
    towards -y is gone."""
    _, _, found = made
    assert found["frame"] == 24
    assert found["roughness"] == pytest.approx(0.2)
    x, y, z = np.array(found["corners"]).T
    np.testing.assert_allclose([x.min(), x.max()], [-2, 2], atol=0.01)
    np.testing.assert_allclose([y.min(), y.max()], [0, 1.4], atol=0.01)
    np.testing.assert_allclose([z.min(), z.max()], [-0.8, 0.8], atol=0.01)
    # The bore's wall: its edges are rounded by 0.15 near the top and bottom.
    wall = np.abs(z) < 0.5
    assert np.hypot(x, y)[wall].min() == pytest.approx(0.9, abs=0.01)


def test_the_script_leaves_textures_pieces_and_the_reference(made):
    _, folder, found = made
    names = {path.name.partition("_")[2] for path in (folder / "textures").iterdir()}
    assert names >= {"base_color.exr", "fractions_1.exr", "normal.exr"}
    assert len(found["pieces"]) == 1
    assert {"sardf reference", "sardf cycles", "sardf difference ×16"} <= set(found["images"])
    assert found["outline"] > 0.995
    assert found["median"] < 2
    assert (folder / "reference.exr").stat().st_size > 1000


def test_the_script_exports_the_part(made):
    """Rounded block minus bore, with fractions by inverse squares of the distances to both."""
    _, folder, _ = made
    document = json.loads((folder / "part.json").read_text())
    assert document["units"] == "mm"
    assert len(document["sections"]) == 1
    points = np.array([[1.2, 0.3, 0.0], [0.0, 1.2, 0.2], [1.5, 0.6, -0.3]])
    bore = np.hypot(points[:, 0], points[:, 1]) - 0.7
    block = (np.array([2, 1.4, 0.8]) - np.abs(points)).min(axis=1)
    weights = 1 / np.stack([bore, block]) ** 2
    expected = weights / weights.sum(axis=0)
    scene = sardf.load(str(folder / "part.json"))
    assert list(document["materials"]) == ["lining", "body"]
    np.testing.assert_allclose(scene.fractions(points).T, expected, atol=1e-6)


def run_documented(run_check, made, words):
    """Run a command of the document: its exit code and the text it printed."""
    version, folder, _ = made
    user = folder / "user"
    if words[0] == "-c":
        assert words[1] == "sardf"
        code = run_check(version, folder, "documented", "command", folder, *words[2:])
        return code, ""
    script = words[words.index("-P") + 1]
    assert ROOT / script == HEADLESS
    after = words[words.index("--") + 1 :]
    done = run_script(version, HEADLESS, *after, user_folder=user, cwd=folder)
    return done.returncode, done.stdout + done.stderr


@pytest.mark.parametrize(
    "words", [words for words in COMMANDS if words != ["-b", "-P", "part.py"]], ids=" ".join
)
def test_the_commands_make_what_they_name(run_check, made, words):
    output = made[1] / words[words.index("-o") + 1]
    code, said = run_documented(run_check, made, words)
    assert code == 0, said
    if output.suffix:
        fields = json.loads(output.read_text())["fields"]  # in the frame that was saved, the first
        assert fields["Cylinder"]["cylinder"] == {"radius": 0.5, "height": 2.4}
        return
    names = {path.name for path in output.iterdir()}
    if "--frames" in words:
        first, last = map(int, words[words.index("--frames") + 1 :][:2])
        pictures = {f"part_{frame:04d}.png" for frame in range(first, last + 1)}
        assert names == pictures | {"camera.json"}
    elif "reference" in words:
        assert names == {
            "cycles_flat.exr", "difference_flat.exr", "numbers_flat.json", "reference_flat.exr"
        }  # fmt: skip
    else:
        assert names == {"part.blend", "camera.json", "textures"}


def test_the_document_has_all_that_it_should():
    """What a reader wants to script; each word stands in an example that the tests above run."""
    script = "\n".join(blocks("python"))
    for word in ("primitive_add", "preset", "features.add", "sardf.bake()", "section_add",
                 "bake_pieces", "sardf.reference()", "part_export", "keyframe_insert"):  # fmt: skip
        assert word in script
    assert ["-b", "-P", "part.py"] in COMMANDS
    said = {words[2] for words in COMMANDS if words[0] == "-c"}
    assert said == {"bake", "render", "export", "reference"}
