"""The panels of a part and the Add menu, drawn in a window of Blender 3.4.1."""

import subprocess

import numpy as np
from blender_runs import SCREENSHOTS, SCRIPTS, run_in_window
from repository import ROOT

LINED_BORE = ROOT / "scenes/lined_bore.json"
DRAWN = {"SARDF_PT_part", "SARDF_PT_materials", "SARDF_PT_features", "SARDF_UL_entries",
         "SARDF_UL_materials", "SARDF_UL_named", "SARDF_MT_add", "SARDF_PT_sections",
         "SARDF_PT_section_object"}  # fmt: skip


def test_panels_and_menu_of_a_part_are_drawn(tmp_path):
    result, done = run_in_window(
        SCRIPTS / "gui_part.py", ROOT / "blender_addon", LINED_BORE,
        user_folder=tmp_path / "user", size=(1280, 1000), limit=400,
    )  # fmt: skip
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
