"""Parts cut open by section objects, in four Blenders."""

import math

import numpy as np
import pytest
from blender_runs import GRADED_SPHERE, expected_fractions, write_scene

RADIUS = GRADED_SPHERE["fields"]["ball"]["sphere"]["radius"]
FRONT = {"half_space": {"point": [0, 0, 0], "normal": [0, -1, 0]}}
NEAR = 1e-3  # scene units: vertices on a plane


@pytest.fixture(scope="module")
def found(run_check, version, tmp_path_factory):
    folder = tmp_path_factory.mktemp("sections")
    scene = write_scene(folder, GRADED_SPHERE)
    return run_check(version, folder, "part_sections", scene, folder)


def half_space(point, normal):
    return [{"remove": {"half_space": {"point": point, "normal": normal}}}]


def test_a_plane_removes_what_its_z_axis_points_to_seen_from_the_part(found):
    planes = found["planes"]
    assert planes["new"] == planes["part moved"] == [{"remove": FRONT}]
    assert planes["parent"]
    assert planes["lines"] > 4
    assert planes["moved"] == planes["mirrored"] == half_space([0, -1, 0], [0, -1, 0])
    assert planes["inside out"] == half_space([0, -1, 0], [0, 1, 0])
    assert planes["muted"] == []


def test_a_box_removes_what_is_in_it(found):
    (section,) = found["box"]
    box = section["remove"]["rotate"]["field"]["box"]  # mirrored along z: turned about z by 180°
    assert box == {"center": [1, 2, 3], "size": [2, 4, 6]}
    assert section["remove"]["rotate"]["center"] == [1, 2, 3]


def test_sections_that_cut_together_remove_what_both_cover(found):
    together = found["together"]
    side = {"half_space": {"point": [0, 0, 0], "normal": [1, 0, 0]}}
    (section,) = together["sections"]
    assert section == {"remove": {"intersection": {"of": [FRONT, side]}}}
    assert together["kept"] == [section | {"keep": ["ball"]}]
    assert together["planes"] == [2]
    assert together["planes where something is kept"] == []
    mesh = together["mesh"]
    points = np.array(mesh["points"])
    x, y, _ = points.T
    assert not ((x > NEAR) & (y < -NEAR)).any()
    caps = ((np.abs(x) < NEAR) & (y <= NEAR)) | ((np.abs(y) < NEAR) & (x >= -NEAR))
    assert caps.sum() > 100
    radii = np.linalg.norm(points, axis=1)
    assert (caps | (np.abs(radii - RADIUS) < 0.05)).all()
    assert mesh["closed"]
    assert mesh["volume"] == pytest.approx(math.pi * RADIUS**3, rel=0.01)
    # Inside, on the cut, the fractions are those of the scene.
    np.testing.assert_allclose(mesh["red"], expected_fractions(points)[:, 0], atol=1e-3)


def test_a_section_of_all_parts_cuts_each_where_it_stands(found):
    case = found["everywhere"]
    here = half_space([0, -0.5, 0], [0, -1, 0])
    there = half_space([0, -1.5, 0], [0, -1, 0])  # of a part that stands at y = 1
    assert case["free"]
    assert case["both"] == case["listed"] == [here, there]
    assert case["muted in one"] == case["ignored by one"] == [[], there]
    assert case["muted"] == [[], []]


def cap(height):
    """The volume of what a plane at `height` from the middle takes off the ball."""
    return math.pi * (RADIUS - height) ** 2 * (2 * RADIUS + height) / 3


def test_pieces_are_closed_and_make_up_the_whole(found):
    case = found["pieces"]
    assert case["bake"] == ["FINISHED"]
    assert set(case["meshes"]) == {"00", "01", "10", "11"}
    for code, mesh in case["meshes"].items():
        points = np.array(mesh["points"])
        taken_by_first = points[:, 1] < -1 + NEAR
        taken_by_second = points[:, 0] > 2 - NEAR
        assert (taken_by_first if code[0] == "1" else points[:, 1] > -1 - NEAR).all(), code
        assert (taken_by_second if code[1] == "1" else points[:, 0] < 2 + NEAR).all(), code
        assert mesh["closed"], code
        np.testing.assert_allclose(mesh["red"], expected_fractions(points)[:, 0], atol=1e-3)
    volume = {code: mesh["volume"] for code, mesh in case["meshes"].items()}
    assert sum(volume.values()) == pytest.approx(4 / 3 * math.pi * RADIUS**3, rel=0.01)
    assert volume["10"] + volume["11"] == pytest.approx(cap(1), rel=0.01)
    assert volume["01"] + volume["11"] == pytest.approx(cap(2), rel=0.01)


def test_pieces_are_moved_by_the_spreads_of_their_sections(found):
    case = found["pieces"]
    for frame, spread in (("1", 0), ("11", 6)):
        for code, place in case["places"][frame].items():
            expected = [spread * int(code[1]), -4 * int(code[0]), 0]
            np.testing.assert_allclose(place, expected, atol=1e-5)
    assert case["again"]
    assert case["cut by one"] == ["10"]


def test_where_nothing_is_left_a_message_says_so(found):
    case = found["nothing_left"]
    assert case["ends"] == [["FINISHED"]] * 3
    assert case["full"] > 500
    assert case["empty"] == [0, True]
    assert case["frames"] == [case["full"]]
    assert case["kept"]
    ((error, note),) = case["said"].values()
    assert (error, note) == ("", "the sections leave nothing of graded sphere")


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("zero", "the section 'Section Plane' has a scale of 0"),
        ("zero baked", "the section 'Section Plane' has a scale of 0"),
        ("flat empty", "the section 'empty' has a scale of 0"),
        ("deleted", "the object of the section 'Section Plane' was deleted"),
        ("removed", "the section 'Section Plane' has no object: it cuts nothing"),
        ("text", "the section 'Section Plane' is no JSON"),
        ("no pieces", "no section cuts 'graded sphere' into pieces"),
        ("too many", "4 sections are accepted at most"),
    ],
)
def test_what_is_wrong_with_a_section_is_told_in_one_sentence(found, name, words):
    text = found["wrong"][name]
    (line,) = [text.strip()] if isinstance(text, str) else text
    assert words in line
    assert "\n" not in line


def test_linked_sections_and_parts_are_cut(found):
    case = found["linked"]
    assert case["own"] == case["theirs"] == [{"remove": FRONT}]
    assert case["cut here"] == [{"remove": FRONT}, *half_space([0, 3, 0], [0, -1, 0])]
    assert case["own is cut, too"] == 2


def test_a_part_is_read_once_after_a_change(found):
    moved, moved_again, deleted, unchanged = found["once"]
    assert moved == moved_again == deleted == 1
    assert unchanged == 0


def test_of_preview_and_baked_object_one_is_seen(found):
    case = found["choice"]
    assert case["before"]
    assert case["up to date"][0] is False
    assert "up to date" in case["up to date"][1][0]
    assert case["changed"][0] is True
    assert "changed since it was baked" in case["changed"][1][0]
    assert case["back"] is False
    assert case["hidden by hand"] == [True, True]
    assert case["preview"] == [True, True]
    assert case["newer"] == case["baked"] == [False, False]
    assert case["still hidden by hand"] is True
    assert case["baked, though changed"] is False
    assert case["baked stands elsewhere"] is True
    assert case["baked is gone"] is True


def test_sections_of_a_file_are_objects(found):
    case = found["file"]
    assert case["kinds"] == ["half_space", "half_space", "box"]
    assert all(case["are"])
    assert case["how"] == ["union", "intersection", "union"]
    assert case["same"] == case["original"]
    moved = {"half_space": {"point": [0, -1, 0], "normal": [0, -1, 0]}}
    first = case["moved"][0]["remove"]["intersection"]["of"]
    assert first == [{"half_space": {"point": [0, 0, 0], "normal": [1, 0, 0]}}, moved]
    assert case["moved"][1] == case["original"][1]
