"""The panels of a part and the Add menu, drawn in a window of Blender 3.4.1."""

import json
import subprocess

import numpy as np
from blender_runs import SCRIPTS, environment
from repository import ROOT

SCREENSHOTS = ROOT / "build/screenshots"
LINED_BORE = ROOT / "scenes/lined_bore.json"
DRAWN = {"SARDF_PT_part", "SARDF_PT_materials", "SARDF_PT_features", "SARDF_UL_entries",
         "SARDF_UL_materials", "SARDF_UL_named", "SARDF_MT_add"}  # fmt: skip


def test_panels_and_menu_of_a_part_are_drawn(tmp_path):
    SCREENSHOTS.mkdir(parents=True, exist_ok=True)
    done = subprocess.run(
        ["xvfb-run", "-a", "-s", "-screen 0 1280x1000x24",
         "blender", "--factory-startup", "--window-geometry", "0", "0", "1280", "1000",
         "-P", str(SCRIPTS / "gui_part.py"), "--",
         str(ROOT / "blender_addon"), str(LINED_BORE), str(SCREENSHOTS)],
        env=environment(tmp_path / "user"), capture_output=True, text=True, timeout=400,
    )  # fmt: skip
    result_file = SCREENSHOTS / "result.json"
    assert result_file.is_file(), done.stdout + done.stderr
    result = json.loads(result_file.read_text())
    result_file.unlink()
    assert not result["errors"], result["errors"][0]
    assert set(result["drawn"]) >= DRAWN
    assert "Traceback" not in done.stderr
    raw = subprocess.run(
        ["convert", str(SCREENSHOTS / "parts.png"), "-depth", "8", "rgb:-"],
        capture_output=True, check=True,
    ).stdout  # fmt: skip
    picture = np.frombuffer(raw, np.uint8).reshape(1000, 1280, 3)
    # The wireframes: black lines on the viewport's grey, left of the sidebar and below the header.
    view = picture[150:850, 60:820].max(axis=-1)
    assert (view < 20).mean() > 0.002
