"""The bake's settings in four Blenders, for scene files and for parts alike."""

from itertools import combinations

import pytest

HEIGHTS = {"sardf uv map": 130, "Principled BSDF": 750, "sardf normal switch": 90}
HEIGHT = 320  # of any other node at most: an image node, as a window draws it


@pytest.fixture(scope="module")
def choices(run_check, version, tmp_path_factory):
    folder = tmp_path_factory.mktemp("choices")
    return run_check(version, folder, "bake_choices", folder)


@pytest.fixture(params=("file", "part"))
def found(request, choices):
    return choices[request.param]


def test_channels_are_chosen_one_by_one(found):
    made = found["channels"]
    assert made["text"] == "density, heat, four"
    assert made["first"] == ["sardf density", "sardf four_1", "sardf four_2", "sardf heat"]
    # heat is 20 + x on a ball of radius 5; fractions by inverse squared distances to x = -8 and 8
    assert made["heat"] == pytest.approx([15, 25], abs=0.01)
    share = (1 / 3**2) / (1 / 3**2 + 1 / 13**2)
    ends = [2 * share + 8 * (1 - share), 8 * share + 2 * (1 - share)]
    assert made["density"] == pytest.approx(ends, abs=0.01)


def test_what_is_no_longer_chosen_goes_from_material_and_file(found):
    made = found["channels"]
    assert made["second"] == ["sardf base_color", "sardf fractions_1"]
    assert made["images"] == ["graded base_color", "graded fractions_1"]
    assert "accepted are base_color" in made["wrong"]
    assert "did you mean 'base_color'?" in made["wrong"]


def test_an_edited_mesh_is_baked_again_on_its_own_uv_map(found):
    made = found["existing"]
    assert "there is no baked object yet" in made["nothing yet"]
    assert made["same object"]
    assert made["heat"] < 0.3  # a texel is 1/7 unit wide
    assert made["attributes"] == ["heat", "red"]
    left, right = made["left half"]
    assert left > 9
    assert right == 0


def test_wrong_uv_maps_are_refused_in_one_sentence(found):
    made = found["existing"]
    assert "faces of the UV map reach out of the image" in made["outside"]
    assert "lie on several faces at once" in made["overlap"]
    assert "no texel lies on the mesh" in made["nothing"]
    assert "no vertex of the mesh lies on the part's surface" in made["other shape"]
    assert "has no UV map: unwrap it" in made["no map"]
    assert made["moved vertices"]  # a few are a warning
    assert made["kept images"]


def test_another_object_is_baked_on_and_keeps_what_it_had(found):
    made = found["existing"]["other"]
    assert made["object"] == "mine"
    assert made["materials"] == ["my own", "graded.001"]
    assert made["slots used"] == [0]
    assert made["heat"] < 0.3
    assert not made["marked"]  # so that no later bake takes it for what it made


def test_smart_uv_project_gives_a_map_that_can_be_baked_on(found):
    made = found["smart"]
    assert made["heat"] < 0.3
    assert made["more"] == {"objects": 1, "meshes": 1}
    assert made["density"] > 5
    assert "Object Mode only" in made["in edit mode"]


def test_textures_in_a_folder_are_never_written_over_unasked(found):
    made = found["destinations"]
    assert "is not saved yet" in made["unsaved"]
    assert made["files"] == ["graded_base_color.exr", "graded_roughness.exr"]
    assert made["packed"] == [False, False]
    assert "is there already; tick Replace Files" in made["again"]
    assert made["unchanged"]
    assert made["replaced"]
    assert made["larger"]
    assert made["relative"] == ["//maps/graded_base_color.exr", "//maps/graded_roughness.exr"]


def test_places_that_cannot_hold_textures_are_named(found):
    made = found["destinations"]
    assert "is a folder; a texture cannot be written there" in made["folder in the way"]
    assert "is a file; textures need a folder" in made["a file"]
    assert "choose a folder" in made["none"]
    assert made["left"] == []
    assert "there is no channel 'nothing'" in found["mistakes"]["no channel"]
    assert not found["mistakes"]["folder left"]
    assert found["mistakes"]["same"]


def test_nodes_stand_in_frames_and_do_not_overlap(found):
    made = found["material"]
    assert made["labels"] == [
        "Attributes", "Fractions", "Masks", "More textures", "Normal map", "Textures", "UV map",
    ]  # fmt: skip
    boxes = {}
    for name, (left, top, width, frame) in made["boxes"].items():
        height = 20 if name.startswith("sardf mask") else HEIGHTS.get(name, HEIGHT)
        boxes[name] = (left, left + (20 if height == 20 else width), top - height, top)
        assert frame or not name.startswith("sardf"), name
    for (a, first), (b, second) in combinations(boxes.items(), 2):
        apart = (
            first[1] <= second[0] or second[1] <= first[0]
            or first[3] <= second[2] or second[3] <= first[2]
        )  # fmt: skip
        rows = {a, b} & set(HEIGHTS) or a.split()[1] == b.split()[1] == "attribute"
        assert apart or rows, (a, b)
    assert made["masks"] == ["red", "steel"]


def test_the_normal_map_has_a_switch_that_later_bakes_keep(found):
    made = found["material"]
    assert made["switch"] == [1.0, True]
    assert made["in panel"]
    assert made["kept off"] == 0


def test_nodes_that_the_user_deleted_are_not_made_again(found):
    assert found["material"]["stays deleted"]
    assert found["material"]["no longer baked"] == []


def test_the_panel_knows_channels_and_cost_before_the_bake(found):
    made = found["info"]
    assert made["channels"] == [
        "base_color", "roughness", "metallic", "emission", "fractions", "field", "normal",
        "density", "heat", "four",
    ]  # fmt: skip
    assert made["error"] == ""
    assert made["estimated"] == pytest.approx(made["baked"], rel=0.3)
    told, baked = made["faces"]
    assert told == pytest.approx(baked, rel=0.25)


def test_an_add_on_that_is_disabled_stops_its_bake_and_works_again(found):
    made = found["disabled"]
    assert made["cancelled"]
    assert not made["left"]
    assert made["same"]
    assert made["again"]
    assert "graded_base_color.exr" in made["files"]
