"""The panels of a part and the Add menu, drawn in a window."""

import pytest
from blender_runs import SCRIPTS, addon_for_window, run_in_window, screenshot
from repository import ROOT

LINED_BORE = ROOT / "scenes/lined_bore.json"
DRAWN = {"SARDF_PT_part", "SARDF_PT_materials", "SARDF_PT_features", "SARDF_UL_entries",
         "SARDF_UL_materials", "SARDF_UL_named", "SARDF_MT_add", "SARDF_PT_sections",
         "SARDF_PT_section_object"}  # fmt: skip


@pytest.fixture(scope="module")
def window(tmp_path_factory):
    user = tmp_path_factory.mktemp("part") / "user"
    return run_in_window(
        SCRIPTS / "gui_part.py", addon_for_window(user), LINED_BORE,
        user_folder=user, size=(1280, 1000), limit=400,
    )  # fmt: skip


def test_panels_and_menu_of_a_part_are_drawn(window):
    assert set(window["drawn"]) >= DRAWN
    # The wireframes: dark lines on the viewport's grey, left of the sidebar and below the header.
    view = screenshot("part_sections")[150:850, 100:760].max(axis=-1)
    assert (view < 40).mean() > 0.005


def test_a_part_is_undone_redone_saved_and_opened_again(window):
    before, added, undone, redone, saved = window["entries"]
    assert added == redone == saved == before + 1
    assert undone == before
    assert window["reopened"]
