"""Scene.sample_volume: shapes, order and errors; the numbers are tested in C++."""

import numpy as np
import pytest
import sardf

BOX = ((-6, -7, -8), (6, 7, 8))
COUNTS = (12, 14, 20)


@pytest.fixture(scope="module")
def scene():
    ball = sardf.sphere(center=(1, 2, 3), radius=4)
    return sardf.Scene(
        solid=ball,
        materials={"red": {"color": [0.5, 0.25, 0.125]}, "blue": {"color": [0, 0, 1]}},
        fractions={
            "formulas": {
                "red": "= clamp((x + 3) / 8, 0, 1)",
                "blue": "= 1 - clamp((x + 3) / 8, 0, 1)",
            }
        },
        attributes={
            "depth": {"value": "= x + 10*y + 100*z"},
            "way": {"value": ["= x", "= y", "= z"]},
        },
        sections=[{"remove": sardf.half_space(point=(0, 0, 3), normal=(0, 0, 1))}],
    )


def middles():
    axes = [
        lo + (np.arange(n) + 0.5) * (hi - lo) / n for lo, hi, n in zip(*BOX, COUNTS, strict=True)
    ]
    z, y, x = np.meshgrid(*reversed(axes), indexing="ij")
    return np.stack([x, y, z], axis=-1)


def test_field_is_that_of_a_ball(scene):
    points = middles()
    ball = 4 - np.linalg.norm(points - (1, 2, 3), axis=-1)
    whole = scene.sample_volume(*BOX, COUNTS, sections=False)
    assert whole["field"].dtype == np.float32
    np.testing.assert_allclose(whole["field"], ball, atol=1e-5)
    cut = scene.sample_volume(*BOX, COUNTS)
    np.testing.assert_allclose(cut["field"], np.minimum(ball, 3 - points[..., 2]), atol=1e-5)
    assert 0.95 < whole["steepness"] < 3**0.5


def test_colors_and_other_channels_are_those_of_the_points(scene):
    points = middles()
    red = np.clip((points[..., 0] + 3) / 8, 0, 1)
    expected = {
        "base_color": red[..., None] * (0.5, 0.25, 0.125) + (1 - red)[..., None] * (0, 0, 1),
        "depth": (points @ (1, 10, 100))[..., None],
        "way": points,
    }
    for channel, values in expected.items():
        found = scene.sample_volume(*BOX, COUNTS, colors="inside", channel=channel)
        color = found["color"]
        assert color.shape == (20, 14, 12, 4)
        there = color[..., 3] == 1
        assert there[found["field"] >= 0].all()
        assert there.any()
        assert not color[~there].any()
        n = values.shape[-1]
        np.testing.assert_allclose(color[there][:, :n], values[there], rtol=1e-5, atol=1e-5)
        assert not color[there][:, n:3].any()
        np.testing.assert_allclose(
            found["range"], (values[there][:, 0].min(), values[there][:, 0].max()), rtol=1e-5
        )
    share = scene.sample_volume(*BOX, COUNTS, channel="fractions", material="red")["color"]
    there = share[..., 3] == 1
    np.testing.assert_allclose(share[there][:, 0], red[there], atol=1e-6)


def test_colors_may_be_left_out(scene):
    found = scene.sample_volume(*BOX, COUNTS, colors="none")
    assert found["color"] is None
    assert found["range"] is None


def test_what_is_wrong_is_said(scene):
    def message(**changed):
        words = {"lo": BOX[0], "hi": BOX[1], "counts": COUNTS} | changed
        with pytest.raises(sardf.Error) as error:
            scene.sample_volume(**words)
        return str(error.value)

    assert "did you mean 'surface'?" in message(colors="surfaces")
    assert "accepted are red, blue; did you mean 'blue'?" in message(
        channel="fractions", material="bleu"
    )
    assert "there is no channel 'deep'" in message(channel="deep")
    assert "0 samples along z" in message(counts=(8, 8, 0))
    assert "from x = 6 to -6" in message(lo=(6, 0, 0), hi=(-6, 1, 1))


def test_progress_cancels(scene):
    shares = []

    def go_on(share):
        shares.append(share)
        return len(shares) < 2

    with pytest.raises(sardf.Cancelled):
        scene.sample_volume(*BOX, (300, 300, 300), colors="inside", progress=go_on)
    assert 0 <= shares[0] <= shares[1] < 1


def test_material_colors_are_linear():
    scene = sardf.Scene(
        solid=sardf.sphere(radius=1), materials={"a": {"color": "#ff8000"}, "b": {}}
    )
    colors = scene.material_colors
    assert list(colors) == ["a", "b"]
    np.testing.assert_allclose(colors["a"], (1, ((128 / 255 + 0.055) / 1.055) ** 2.4, 0), rtol=1e-9)


def test_first_point_on_a_ray(scene):
    assert scene.first_point((1, 2, 9), (0, 0, -1)) == pytest.approx((1, 2, 3), abs=1e-6)
    hit = scene.first_point((1, -9, 3), (0, 1, 0), plane=(0, -1, 0, 1))  # y < 1 is cut away
    assert hit == pytest.approx((1, 1, 3), abs=1e-6)
    assert scene.first_point((9, 9, 9), (1, 0, 0)) is None
    with pytest.raises(sardf.Error, match="the direction is"):
        scene.first_point((0, 0, 0), (0, 0, 0))
