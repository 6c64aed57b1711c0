"""What is said about wrong parts, and random work on parts, in four Blenders."""

import pytest
from blender_runs import INSTALLED_VERSIONS


@pytest.fixture(scope="module")
def bad(run_check, version, tmp_path_factory):
    folder = tmp_path_factory.mktemp("bad")
    return run_check(version, folder, "part_bad", folder)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("zero_scale_of_the_part", "the part 'Part' has a scale of 0"),
        ("newer_version", "made by a newer version of the add-on"),
        ("broken_memory", "what 'Part' remembers of its file is no JSON"),
        ("wrong_kind", "'Camera' is of the type CAMERA"),
        ("mesh_without_faces", "the mesh 'wire' has no faces"),
        ("curve_without_bevel", "the curve 'line' has no bevel depth"),
        ("radii", "the torus 'Torus' has a minor_radius larger than its major_radius"),
        ("contains_itself", "the part 'Part' contains itself: Part > Part"),
        ("zero_scale", "the object 'Box' has a scale of 0"),
        ("everything_deleted", "the part 'Part' has no entry that makes a solid"),
    ],
)
def test_a_wrong_part_is_told_in_one_sentence(bad, name, words):
    found = bad[name] if isinstance(bad[name], list) else [bad[name]]
    for text in found:
        assert words in text
        assert text.removeprefix("Error: ").strip().count("\n") == 0


def test_what_is_muted_or_gone_only_warns(bad):
    assert bad["older_version"] == []
    assert len(bad["zero_scale_muted"]) == len(bad["removed_from_the_file"]) == 1
    warned, restored, children = bad["deleted"]
    assert "the object of the entry 'Cylinder' was deleted" in warned[0]
    assert (restored, children) == ([], 2)


def test_wrong_lists_and_formulas_are_told(bad):
    empty, unknown = bad["formula"]
    assert "has no formula" in empty
    assert "there is no function 'nonsense'" in unknown
    expected = ("rename one", "letters, digits", "has no features", "has no object",
                "has no material", "'missing'; accepted are same, other", "numbers")  # fmt: skip
    assert len(bad["materials"]) == len(expected)
    for text, words in zip(bad["materials"], expected, strict=True):
        assert words in text
    assert bad["names"] == ["gr_e_1", "gr_e_1_2", "solid"]


def test_operators_without_a_part_and_wrong_files_report_errors(bad):
    *texts, written = bad["no_part"]
    assert all("no part is active" in text for text in texts)
    assert not written
    expected = ("not JSON", "'solid' is missing", "radius is -1", "a scene is accepted",
                "in a circle", "/materials", "missing.json", "there is no folder")  # fmt: skip
    for text, words in zip(bad["wrong_files"], expected, strict=True):
        assert words in text


def test_uneven_scale_is_labelled(bad):
    assert "Torus: an estimate: its sign is right" in bad["uneven"]
    assert not [line for line in bad["uneven"] if line.startswith("Box")]


def test_ten_thousand_objects(bad):
    many = bad["many"]
    assert many["fields"] == 10001
    print({name: round(value, 2) for name, value in many["seconds"].items()})
    # Reading took 3.3 s on a busy machine; the panel must not read so many while it is drawn.
    assert many["seconds"]["read"] < 30
    assert "press Check" in many["status"][0]


def check_random_work(found):
    assert min(found["done"].values()) > 0, found["done"]
    assert found["unexpected"] == []
    assert found["left"] == {}


def test_random_work_leaves_nothing_behind(run_check, version, tmp_path):
    """60 sequences of 12 steps in each of four Blenders."""
    seed = 20261126 + INSTALLED_VERSIONS.index(version)
    check_random_work(run_check(version, tmp_path, "part_random", 60, 12, seed, tmp_path))


@pytest.mark.long
@pytest.mark.parametrize(("sequences", "steps"), [(200, 12), (4, 500)])
def test_much_random_work_leaves_nothing_behind(run_check, version, tmp_path, sequences, steps):
    seed = 9 + INSTALLED_VERSIONS.index(version)
    words = (sequences, steps, seed, tmp_path)
    check_random_work(run_check(version, tmp_path, "part_random", *words, limit=3600))
