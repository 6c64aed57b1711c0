"""Stages in POV-Ray: parts in their places under Blender's lights, by closed forms of radiance."""

import json
import re
import subprocess
import time

import numpy as np
import pytest
import sardf
from repository import ROOT
from sardf import _image

WIDTH = 65  # pixels; the middle one's centre is the picture's
SLAB = {  # its upper side is z = 0; white is matte with an albedo of 1
    "sardf": 1,
    "units": "m",
    "fields": {"slab": {"box": {"size": [30, 30, 1], "center": [0, 0, -0.5]}}},
    "solid": "slab",
    "materials": {"white": {"color": [1, 1, 1]}},
    "fractions": {"constant": {"white": 1}},
}
FROM_ABOVE = {
    "matrix_world": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 9], [0, 0, 0, 1]],
    "type": "ORTHO",
    "ortho_scale": 6.5,
}
PLACE = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]]  # 2 above, shining down
X = (np.arange(WIDTH) - WIDTH // 2) * 6.5 / WIDTH  # of the middle row's pixels
D2 = X**2 + 4
COS = 2 / np.sqrt(D2)
HALF = 0.00098  # relative rounding of POV-Ray's half floats


def moved(*place, scale=1):
    return [[scale, 0, 0, place[0]], [0, scale, 0, place[1]], [0, 0, scale, place[2]],
            [0, 0, 0, 1]]  # fmt: skip


def picture(folder, lights=(), world=None, parts=None, look="lit", camera=FROM_ABOVE, **options):
    stage = {"camera": camera, "lights": list(lights), "parts": parts or [{"scene": SLAB}]}
    if world is not None:
        stage["world"] = world
    image = folder / f"{look}.exr"
    size = {"width": WIDTH, "height": WIDTH} | options
    sardf.povray_stage(json.dumps(stage), str(folder / "a.pov"), str(image), look=look, **size)
    return _image.read(str(image))


def row(folder, light, **options):
    """The radiance of the slab along its middle, each channel the same."""
    made = picture(folder, [light | {"matrix_world": PLACE}], **options)
    middle = made[WIDTH // 2]
    assert np.all(middle[:, 3] == 1)
    assert np.all(middle[:, 0] == middle[:, 1])
    return middle[:, 0]


def smooth(t):
    t = np.clip(t, 0, 1)
    return t * t * (3 - 2 * t)


def test_point(tmp_path):
    """E = P cos / (4 pi d^2), and a white surface has E / pi."""
    found = row(tmp_path, {"type": "point", "power": 1000})
    assert found == pytest.approx(1000 / (4 * np.pi * D2) * COS / np.pi, rel=2 * HALF)


def test_soft_point(tmp_path):
    """A disk of radius r that faces the surface: E = P cos / (4 pi (d^2 + r^2))."""
    light = {"type": "point", "power": 1000, "radius": 0.5}
    found = row(tmp_path, light)
    assert found == pytest.approx(1000 / (4 * np.pi**2 * (D2 + 0.25)) * COS, rel=2 * HALF)
    found = row(tmp_path, light | {"soft_falloff": False})
    assert found == pytest.approx(1000 / (4 * np.pi**2 * D2) * COS, rel=2 * HALF)


@pytest.mark.parametrize("blend", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("blender", [[3, 4, 1], [5, 0, 1]])
def test_spot(tmp_path, blend, blender):
    """Within the cone a point, blurred by a smooth step of the cosine; before 4.0 times it."""
    c = np.cos(0.6)
    with np.errstate(divide="ignore", invalid="ignore"):
        step = smooth((COS - c) / ((1 - c) * blend)) if blend else (c <= COS).astype(float)
    expected = 1000 / (4 * np.pi**2 * D2) * COS * step * (COS if blender[0] < 4 else 1)
    light = {"type": "spot", "power": 1000, "spot_size": 1.2, "spot_blend": blend}
    stage = {"camera": FROM_ABOVE, "blender": blender, "parts": [{"scene": SLAB}],
             "lights": [light | {"matrix_world": PLACE}]}  # fmt: skip
    image = str(tmp_path / "a.exr")
    sardf.povray_stage(json.dumps(stage), str(tmp_path / "a.pov"), image, width=65, height=65)
    found = _image.read(image)[32, :, 0]
    assert found == pytest.approx(expected, rel=2 * HALF, abs=2e-3)  # steep at its edge


def test_sun(tmp_path):
    turned = [[0.6, 0, 0.8, 0], [0, 1, 0, 0], [-0.8, 0, 0.6, 3], [0, 0, 0, 1]]
    light = {"type": "sun", "power": 3, "angle": 0.1, "matrix_world": turned}
    found = picture(tmp_path, [light])[..., :3]
    assert found == pytest.approx(3 * 0.6 / np.pi, rel=HALF)


def area(width, height, is_ellipse, points=400):
    """P / (pi A) times the integral of cos cos / d^2 over the light, divided by pi; a midpoint
    rule."""
    at = (np.arange(points) + 0.5) / points - 0.5
    u, v = np.meshgrid(at, at)
    inside = u**2 + v**2 <= 0.25 if is_ellipse else np.ones_like(u, dtype=bool)
    u, v = u[inside] * width, v[inside] * height
    d2 = (u[None] - X[:, None]) ** 2 + v[None] ** 2 + 4
    return 1000 / np.pi**2 * np.mean(4 / d2**2, axis=1)


@pytest.mark.parametrize("shape", ["rectangle", "ellipse"])
def test_area(tmp_path, shape):
    light = {"type": "area", "power": 1000, "shape": shape, "size_x": 1, "size_y": 2}
    expected = area(1, 2, shape == "ellipse")
    assert row(tmp_path, light) == pytest.approx(expected, rel=3 * HALF)
    assert row(tmp_path, light, light_samples=2) == pytest.approx(expected, rel=0.03)


def test_area_of_older_blender(tmp_path):
    """Measured in Blender 3.4: pi/4 of what it says."""
    light = {"type": "area", "power": 1000, "matrix_world": PLACE}
    stage = {"camera": FROM_ABOVE, "blender": [3, 4, 1], "parts": [{"scene": SLAB}],
             "lights": [light]}  # fmt: skip
    image = str(tmp_path / "a.exr")
    sardf.povray_stage(json.dumps(stage), str(tmp_path / "a.pov"), image, width=65, height=65)
    expected = np.pi / 4 * area(1, 1, False)
    assert _image.read(image)[32, :, 0] == pytest.approx(expected, rel=3 * HALF)


def test_color_tint_exposure_and_world(tmp_path):
    light = {"type": "sun", "power": 2, "exposure": 1.5, "color": [1, 0.5, 0.25],
             "tint": [0.5, 1, 2]}  # fmt: skip
    world = {"color": [0.1, 0.2, 0.4], "strength": 2}
    found = picture(tmp_path, [light], world)[..., :3]
    expected = 2 * 2**1.5 / np.pi * np.array([0.5, 0.5, 0.5]) + np.array([0.2, 0.4, 0.8])
    assert found == pytest.approx(np.broadcast_to(expected, found.shape), rel=2 * HALF)


def test_shadows(tmp_path):
    """A ball between a point and the slab: hard within its cone, none without shadow."""
    ball = SLAB | {"fields": {"slab": {"sphere": {"radius": 0.25}}}}
    parts = [{"scene": SLAB}, {"scene": ball, "matrix_world": moved(0, 0, 1)}]
    light = {"type": "point", "power": 1000, "matrix_world": PLACE}
    found = picture(tmp_path, [light], parts=parts)[WIDTH // 2, :, 0]
    edge = 2 * 0.25 / np.sqrt(1 - 0.25**2)  # of the shadow, seen from 2 above
    hidden = (abs(X) < edge - 0.1) & (abs(X) > 0.3)
    assert hidden.sum() >= 2
    assert np.all(found[hidden] == 0)
    assert np.all(found[abs(X) > edge + 0.1] > 0.9)
    without = picture(tmp_path, [light | {"shadow": False}], parts=parts)[WIDTH // 2, :, 0]
    assert np.all(without[hidden] > 1)


def test_parts_stand_where_their_matrices_say(tmp_path):
    """Two balls of one title and of two colours, moved, turned and scaled; flat and exact."""
    parts = []
    for color, place, scale in ((0.25, (-1.5, 0.5, 0), 0.52), (0.75, (1, -1, 2), 1.53)):
        ball = SLAB | {"title": "ball", "fields": {"slab": {"sphere": {"radius": 1}}},
                       "materials": {"white": {"color": [color] * 3}}}  # fmt: skip
        parts.append({"scene": ball, "matrix_world": moved(*place, scale=scale)})
    found = picture(tmp_path, parts=parts, look="flat")
    x, y = np.meshgrid(X, -X)
    first = (x + 1.5) ** 2 + (y - 0.5) ** 2 <= 0.52**2
    second = (x - 1) ** 2 + (y + 1) ** 2 <= 1.53**2
    expected = np.where(second, 0.75, np.where(first, 0.25, 0))
    wrong = abs(found[..., 0] - expected) > 1e-3
    assert not wrong.any(), np.argwhere(wrong)
    assert np.array_equal(found[..., 3] > 0.5, found[..., 0] > 0)


def test_sections_and_turned_parts(tmp_path):
    """Half a block, turned by 90 degrees about z."""
    half = SLAB | {"fields": {"slab": {"box": {"size": [4, 2, 1]}}},
                   "sections": [{"remove": {"half_space": {"normal": [-1, 0, 0]}}}]}  # fmt: skip
    turned = [[0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]  # x becomes y
    found = picture(tmp_path, parts=[{"scene": half, "matrix_world": turned}], look="flat")
    whole = SLAB | {"fields": {"slab": {"box": {"size": [4, 2, 1]}}}}
    all_of_it = picture(tmp_path, parts=[{"scene": whole, "matrix_world": turned}], look="flat")
    x, y = np.meshgrid(X, -X)
    mask = found[..., 3] > 0.5
    upper, lower = (abs(x) < 0.95) & (y > 0.05) & (y < 1.95), (y < -0.05) & (y > -1.95)
    lower &= abs(x) < 0.95
    assert np.all(all_of_it[upper | lower, 3] == 1)
    assert mask[upper].all()  # what has x < 0 is removed, and x became y
    assert not mask[lower].any()


@pytest.mark.timed
def test_progress_and_cancel(tmp_path):
    """Shares rise to 1, and saying no ends POV-Ray within 0.2 s."""
    shares = []
    picture(tmp_path, world={"color": [1, 1, 1]}, width=320, height=320, progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1
    risen, said_no = [], []

    def stop(share):
        risen.append(share)
        # However fast the machine is, the large picture is seen to get on before it is stopped.
        if len({share for share in risen if share > 0.2}) < 2:
            return True
        said_no.append(time.monotonic())
        return False

    with pytest.raises(sardf.Cancelled):
        picture(tmp_path, look="flat", width=4000, height=4000, progress=stop)
    assert time.monotonic() - said_no[0] < 0.2
    assert risen == sorted(risen)
    assert risen[-1] < 1
    assert not [path for path in tmp_path.iterdir() if path.name.startswith(".")]


BAD = [
    ({"lights": [{"type": "lamp"}]}, "found 'lamp'; accepted are"),
    ({"lights": [{"type": "sun", "colour": [1, 1, 1]}]}, "did you mean 'color'"),
    ({"lights": [{"type": "spot", "spot_size": 0}]}, "spot_size is 0; it must be above 0"),
    ({"lights": [{"type": "spot", "spot_blend": 1.5}]}, "at most 1"),
    ({"lights": [{"type": "point", "power": None}]}, "expected a finite number"),
    ({"lights": [{"type": "sun", "matrix_world": moved(0, 0, 0, scale=0)}]}, "a scale of 0"),
    ({"lights": [{}]}, "the light has no type"),
    ({"world": [1, 1, 1]}, "expected an object"),
    ({"parts": []}, "no parts"),
    ({"parts": [{"scene": {"sardf": 1}}]}, "solid"),
    ({"parts": [{"scene": "no such file.json"}]}, "no such file.json"),
    ({"camera": {}}, "matrix_world"),
]


@pytest.mark.parametrize(("change", "told"), BAD, ids=[told for _, told in BAD])
def test_what_is_wrong_in_a_stage_is_told(tmp_path, change, told):
    stage = {"camera": FROM_ABOVE, "parts": [{"scene": SLAB}]} | change
    with pytest.raises(sardf.Error, match=re.escape(told)):
        sardf.povray_stage(json.dumps(stage), str(tmp_path / "a.pov"))
    assert not list(tmp_path.iterdir())


def test_povray_is_missing(tmp_path):
    stage = json.dumps({"camera": FROM_ABOVE, "parts": [{"scene": SLAB}]})
    with pytest.raises(sardf.Error, match=r"POV-Ray 3.7 was not found.*/no/povray"):
        sardf.povray_stage(stage, str(tmp_path / "a.pov"), "a.exr", program="/no/povray")
    with pytest.raises(sardf.Error, match="light_samples is 0"):
        sardf.povray_stage(stage, str(tmp_path / "a.pov"), light_samples=0)


def test_the_command(tmp_path):
    """The same files and the same picture as from Python."""
    (tmp_path / "slab.json").write_text(json.dumps(SLAB))
    stage = {"camera": FROM_ABOVE, "parts": [{"scene": "slab.json"}],
             "lights": [{"type": "point", "power": 1000, "matrix_world": PLACE}]}  # fmt: skip
    (tmp_path / "stage.json").write_text(json.dumps(stage))
    words = ["stage", tmp_path / "stage.json", "-o", tmp_path / "b.pov", "--width", "65",
             "--height", "65", "--render", tmp_path / "b.exr"]  # fmt: skip
    done = subprocess.run([ROOT / ".venv/bin/sardf", *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    expected = picture(tmp_path, stage["lights"])
    assert np.array_equal(_image.read(str(tmp_path / "b.exr")), expected)


def test_pictures_compared():
    """A square that moves by a pixel, and colours that differ by 2/255."""
    first, second = np.zeros((2, 40, 40, 4), dtype=np.float32)
    first[10:30, 10:30] = (0.5, 0.5, 0.5, 1)
    second[10:30, 11:31] = (0.5, 0.5 + 2 / 255, 0.5, 1)
    numbers = sardf.compare_pictures(first, second)
    assert numbers["intersection_over_union"] == pytest.approx(380 / 420)
    assert numbers["median"] == pytest.approx(2, abs=1e-4)
    assert numbers["compared_pixels"] == 17 * 18  # of the 19 x 20 in both, without their rim
    assert numbers["difference"].shape == (40, 40, 3)
    assert numbers["difference"][20, 20] == pytest.approx([0, 32 / 255, 0], abs=1e-4)
    with pytest.raises(sardf.Error, match=r"\(height, width, 4\) is accepted"):
        sardf.compare_pictures(first[..., :3], second)
    with pytest.raises(sardf.Error, match="empty"):
        sardf.compare_pictures(first, np.zeros_like(first))
