"""Pages in a real browser: those that the program writes pass, and each fault is found."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from odometry.report.drawing.figure import save_figure
from odometry.report.drawing.html import Grid, Listing, Paragraph, Picture, Section, write_page
from tests.studies.speed.browser import Browser, installed
from tests.studies.speed.pages import faults

ROOT = Path(__file__).parents[1]
PROGRAM = installed()
needs_browser = pytest.mark.skipif(PROGRAM is None, reason="no Chromium is installed")
WORDS = "A sentence that is long enough to be broken at the end of a line of a small screen. " * 3
WORDS += "a_file_whose_name_is_longer_than_any_line_of_a_small_screen_" * 2


@pytest.fixture(scope="module")
def browser():
    with Browser(str(PROGRAM)) as opened:
        yield opened


@needs_browser
@pytest.mark.parametrize("columns", [3, 8, 9, 14])
def test_a_page_of_everything_passes(browser, tmp_path, columns):
    def draw(figure):
        figure.add_subplot().plot([1, 2])

    picture = Picture(save_figure(tmp_path / "a.png", (9.0, 4.0), draw), "a line", WORDS)
    header = ["name", *["translation error [m per m]"] * (columns - 1)]
    rows = [["differential_drive", *["0.1234 +/- 0.0123"] * (columns - 1)]] * 3
    blocks = [Paragraph(WORDS), Listing([WORDS]), Grid(header, rows, WORDS), picture]
    page = write_page(tmp_path / "report.html", "A title", WORDS, [Section(WORDS, blocks)])
    assert faults(browser, page, tmp_path) == []
    made = {file.name.partition("_")[2] for file in tmp_path.rglob(f"{tmp_path.name}_*")}
    assert {"screen.png", "small.png", "dark.png", "paper.pdf"} <= {
        name.rpartition("_")[2] for name in made
    }


FAULTS = {
    "request": '<img src="http://127.0.0.1:9/a.png">',
    "console": "<script>console.error('no')</script>",
    "sticks out": "<div style='width: 2000px'>a</div>",
    "contrast": "<p style='color: #999'>a</p>",
    "letters of a figure": "<img width=100 src='a.svg'>",
}


@needs_browser
@pytest.mark.parametrize("kind", FAULTS)
def test_each_fault_is_found(browser, tmp_path, kind):
    (tmp_path / "a.svg").write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" width="1350" height="600"/>'
    )
    page = tmp_path / "page.html"
    page.write_text(f"<!DOCTYPE html><meta charset=utf-8><body>{FAULTS[kind]}")
    assert any(f": {kind}" in fault for fault in faults(browser, page, None))


@needs_browser
def test_numbers_stay_on_one_line_of_a_small_screen(browser, tmp_path):
    """A table scrolls there; a sentence in a cell is broken, but not after every word."""
    row = ["gravel", "0.269 ± 0.020", "0.1207 m (0.1108 to 0.1300)", WORDS, "grass, sand"]
    blocks = [Grid(["terrain", "y_left [m]", "before", "remarks", "others"], [row])]
    page = write_page(tmp_path / "report.html", "A title", "", [Section("A section", blocks)])
    browser("Emulation.setEmulatedMedia", media="screen")
    browser("Emulation.setDeviceMetricsOverride", width=400, height=900,
            deviceScaleFactor=1, mobile=True)  # fmt: skip
    browser.open(page)
    lines = """[...document.querySelectorAll('td')].map(cell => {
      const text = document.createRange();
      text.selectNodeContents(cell);
      return Math.round(text.getBoundingClientRect().height / 24);
    })"""
    number, interval, words, names = browser.value(lines)
    assert (number, interval, names) == (1, 1, 1)
    assert 2 <= words <= 16


@needs_browser
def test_a_page_that_does_not_exist_is_an_error(tmp_path):
    ran = subprocess.run(
        [sys.executable, "-m", "tests.studies.speed.pages", str(tmp_path / "missing.html")],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 2
    assert "missing.html" in ran.stderr


def test_without_a_browser_it_says_so(tmp_path):
    environment = os.environ | {"PATH": str(tmp_path), "PYTHONPATH": str(ROOT)}
    ran = subprocess.run(
        [sys.executable, "-m", "tests.studies.speed.pages", "a.html"],
        env=environment, cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert ran.returncode == 2
    assert "No Chromium is installed" in ran.stdout
