"""Parts made of objects in the live preview, without a window: a coarse mesh stands in."""

import numpy as np
import pytest

CELL = 0.2  # a stand-in's cells are smaller


@pytest.fixture(scope="module")
def shown(run_check, version, tmp_path_factory):
    return run_check(version, tmp_path_factory.mktemp("shown"), "part_shown")


def check_box(step, lo, hi):
    (box,) = step["boxes"].values()
    np.testing.assert_allclose(box, [lo, hi], atol=CELL)


def test_a_moved_object_or_part_is_seen_where_it_went(shown):
    check_box(shown["built"], (-2, -1.5, -1), (2, 1.5, 1))
    check_box(shown["moved"], (-2, -1.5, -1), (5, 1.5, 1))
    check_box(shown["part moved"], (-2, -1.5, 9), (5, 1.5, 11))
    assert not any(shown["part moved"]["errors"].values())


def test_what_is_wrong_with_a_part_is_said_and_the_picture_stays(shown):
    (error,) = shown["flat"]["errors"].values()
    assert "scale" in error
    check_box(shown["flat"], (-2, -1.5, 9), (5, 1.5, 11))


def test_hidden_parts_and_deleted_objects_are_not_seen(shown):
    assert shown["hidden"]["boxes"] == {}
    check_box(shown["deleted"], (-2, -1.5, 9), (2, 1.5, 11))
