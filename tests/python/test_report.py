"""`sardf compare-images`: its exit codes, its numbers, and its page as Chromium shows it."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from matplotlib.image import imread, imsave

SARDF = os.environ.get("SARDF_BINARY") or str(Path(sys.executable).with_name("sardf"))
WIDTH, HEIGHT = 320, 240
RED, GREEN = (217, 38, 51), (38, 166, 64)  # sRGB bytes; no colour of the page is near them


def write_disc(path: Path, color: tuple, center: float = 160, radius: float = 90) -> Path:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    pixels = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
    pixels[np.hypot(x - center, y - 120.2) <= radius] = color
    imsave(path, pixels)
    return path


def compare(*arguments: str | Path) -> subprocess.CompletedProcess:
    command = [SARDF, "compare-images", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


def screenshot(page: Path, folder: Path, width: int = 1200, height: int = 1500) -> np.ndarray:
    """The page in headless Chromium, as bytes of shape (height, width, 3)."""
    picture = folder / f"{page.stem}-{width}.png"
    command = [
        "chromium",
        *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
        *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
        *("--hide-scrollbars", f"--user-data-dir={folder / 'profile'}"),
        *(f"--window-size={width},{height}", f"--screenshot={picture}", page.as_uri()),
    ]
    subprocess.run(command, capture_output=True, check=True, timeout=120)
    return (imread(picture)[:, :, :3] * 255).round().astype(int)


def pixels_near(picture: np.ndarray, color: tuple) -> int:
    return int((np.abs(picture - color).max(axis=2) <= 2).sum())


@pytest.fixture
def unequal(tmp_path: Path) -> tuple[Path, Path, Path]:
    """A red and a green disc and the report that compares them."""
    reference = write_disc(tmp_path / "reference.png", RED)
    candidate = write_disc(tmp_path / "candidate.png", GREEN)
    report = tmp_path / "report.html"
    assert compare(reference, candidate, "-o", report).returncode == 1
    return reference, candidate, report


def test_equal_pictures_agree(tmp_path: Path) -> None:
    picture = write_disc(tmp_path / "a.png", RED)
    numbers = tmp_path / "numbers.json"
    result = compare(picture, picture, "-o", tmp_path / "report.html", "--json", numbers)
    assert (result.returncode, result.stderr) == (0, "")
    read = json.loads(numbers.read_text())
    assert read["passes"] is True
    assert read["intersection_over_union"] == 1
    assert read["color"]["maximum"] == 0
    assert "1 comparison, all limits hold" in (tmp_path / "report.html").read_text()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"color": (217, 41, 51)}, "colour difference"),
        ({"center": 161}, "edges within 0.5 px"),
        ({"radius": 91.5}, "mask intersection over union"),
    ],
)
def test_differences_are_found(tmp_path: Path, change: dict, said: str) -> None:
    # RED's green byte 38 is 4.95/255 linear, 41 is 5.72/255: a difference of 0.77/255.
    reference = write_disc(tmp_path / "a.png", RED)
    candidate = write_disc(tmp_path / "b.png", **{"color": RED, **change})
    result = compare(reference, candidate)
    assert result.returncode == 1
    assert said in result.stderr


def test_wrong_input_is_told_apart_from_disagreement(tmp_path: Path) -> None:
    picture = write_disc(tmp_path / "a.png", RED)
    result = compare(picture, tmp_path / "missing.exr")
    assert result.returncode == 2
    assert "missing.exr: there is no such file" in result.stderr
    result = compare(picture, picture, "-o", tmp_path / "no" / "report.html")
    assert result.returncode == 1
    assert "report.html: cannot be written" in result.stderr
    assert compare(picture).returncode == 2
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


def test_page_needs_nothing_else(unequal: tuple) -> None:
    page = unequal[2].read_text()
    links = re.findall(r'(?:src|href|url)\s*[=(]\s*"?([^")>]{0,30})', page)
    assert len(links) == 4  # reference, candidate, the swap's reference, difference
    assert all(link.startswith("data:image/png;base64,") for link in links)
    assert "<script" not in page
    assert "<link" not in page


def test_page_shows_both_pictures_and_their_difference(unequal: tuple, tmp_path: Path) -> None:
    picture = screenshot(unequal[2], tmp_path)
    assert picture.shape == (1500, 1200, 3)
    red, green = pixels_near(picture, RED), pixels_near(picture, GREEN)
    # Both pictures are equally large; a disc fills pi 90^2 of 320 x 240 pixels.
    assert red > 20000
    assert abs(red - green) < 0.02 * red
    # In the difference all but the blue channel, 51 against 64, is 16-fold and clamped: yellow
    # with linear |0.0331 - 0.0513| x 16 = 0.29 of blue.
    assert pixels_near(picture, (255, 255, 74)) > 20000
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 50  # and there is text


def test_page_swaps_the_candidate_for_the_reference(unequal: tuple, tmp_path: Path) -> None:
    before = screenshot(unequal[2], tmp_path)
    page = unequal[2].read_text()
    swapped = tmp_path / "swapped.html"
    swapped.write_text(page.replace('<input type="checkbox"', '<input type="checkbox" checked'))
    after = screenshot(swapped, tmp_path)
    assert pixels_near(before, GREEN) > 20000
    assert pixels_near(after, GREEN) == 0
    assert abs(pixels_near(after, RED) - 2 * pixels_near(before, RED)) < 2000
    # The pointer does by :hover what a click does by :checked; one rule says both.
    assert ".swap:hover .back, .swap input:checked ~ .back { opacity: 1; }" in page


def test_page_fits_a_narrow_screen(unequal: tuple, tmp_path: Path) -> None:
    wide = pixels_near(screenshot(unequal[2], tmp_path), RED)
    narrow = screenshot(unequal[2], tmp_path, width=560, height=2400)
    # One picture to a row: wider than half the screen, and nothing is cut off on the right.
    columns = np.flatnonzero((np.abs(narrow - RED).max(axis=2) <= 2).any(axis=0))
    assert columns.max() - columns.min() > 0.5 * 0.5 * 560
    assert columns.max() < 560 - 16
    assert wide > 0
