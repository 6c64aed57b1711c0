"""The panels of a part and the Add menu, drawn in a window."""

from blender_runs import SCRIPTS, run_in_window, screenshot
from repository import ROOT

LINED_BORE = ROOT / "scenes/lined_bore.json"
DRAWN = {"SARDF_PT_part", "SARDF_PT_materials", "SARDF_PT_features", "SARDF_UL_entries",
         "SARDF_UL_materials", "SARDF_UL_named", "SARDF_MT_add", "SARDF_PT_sections",
         "SARDF_PT_section_object"}  # fmt: skip


def test_panels_and_menu_of_a_part_are_drawn(tmp_path):
    result = run_in_window(
        SCRIPTS / "gui_part.py", ROOT / "blender_addon", LINED_BORE,
        user_folder=tmp_path / "user", size=(1280, 1000), limit=400,
    )  # fmt: skip
    assert set(result["drawn"]) >= DRAWN
    # The wireframes: black lines on the viewport's grey, left of the sidebar and below the header.
    view = screenshot("parts")[150:850, 60:820].max(axis=-1)
    assert (view < 20).mean() > 0.002
