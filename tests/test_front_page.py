"""The pictures of the READMEs, the citation, and the length of the first page."""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from runpy import run_path

import pytest
import yaml

from terrain.demo import WITH, WITHOUT, run_demo
from terrain.result.run_result import RunResult

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "notebooks/pictures"
LARGEST_BYTES = 1_000_000
READMES = [ROOT / "README.md", ROOT / "data/README.md"]


def test_the_first_page_is_short() -> None:
    lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    assert len(lines) < 180


def test_pictures_are_small_and_shown_with_words() -> None:
    """Each is in a README, with a description for who cannot see it."""
    files = [file for file in PICTURES.iterdir() if file.suffix in {".png", ".jpg"}]
    assert sum(file.stat().st_size for file in files) < LARGEST_BYTES
    shown = {
        (readme.parent / target).resolve(): words
        for readme in READMES
        for words, target in re.findall(r"!\[([^\]]*)\]\(([^)]+)\)", readme.read_text("utf-8"))
    }
    assert shown.keys() == {file.resolve() for file in files}
    assert min(map(len, shown.values())) > 100


DEMO = {
    "ideal differential drive": (WITH, "differential_drive"),
    "gyroscope and mean wheel speed, nothing fitted": (WITH, "gyroscope"),
    "odometer without camera": (WITHOUT, "odometer"),
    "odometer with camera": (WITH, "odometer"),
    "odometer without camera, without gyroscope": (WITHOUT, "odometer_without_gyroscope"),
    "odometer with camera, without gyroscope": (WITH, "odometer_without_gyroscope"),
}


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> dict[str, RunResult]:
    return run_demo(tmp_path_factory.mktemp("demo"))[0]


@pytest.mark.slow
def test_the_figures_of_the_demo(results: dict[str, RunResult]) -> None:
    """Those of the first page are those that the demo gives."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (.+?) \| ([\d.]+) \| ([\d.]+) \|$", text, flags=re.MULTILINE)
    assert [name for name, *_ in rows] == list(DEMO)
    for name, metres, degrees in rows:
        result, line = DEMO[name]
        score = results[result].scores[line]
        assert float(metres) == pytest.approx(score.mean_translation_per_m, rel=0.02, abs=5e-5)
        assert float(degrees) == pytest.approx(score.mean_rotation_deg_per_m, rel=0.02, abs=5e-3)


def draw_without_data(out: Path) -> str:
    environment = {name: value for name, value in os.environ.items() if "_DATA" not in name}
    command = [sys.executable, str(ROOT / "notebooks/pictures.py"), "--out", str(out)]
    return subprocess.run(
        command, env=environment, cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout


@pytest.mark.slow
def test_the_command_without_reference_data(tmp_path: Path) -> None:
    """It makes what it can, says what is missing, and gives the same bytes in any process."""
    assert "first_page.jpg needs" in draw_without_data(tmp_path)
    assert [file.name for file in tmp_path.iterdir()] == ["frame.png"]
    first = (tmp_path / "frame.png").read_bytes()
    run_path(str(ROOT / "notebooks/pictures.py"))["frame"](tmp_path / "frame.png")
    assert (tmp_path / "frame.png").read_bytes() == first


@pytest.mark.skipif("TERRAIN_ODOMETRY_DATA" not in os.environ, reason="needs the reference data")
def test_the_picture_of_the_first_page(tmp_path: Path, results: dict[str, RunResult]) -> None:
    first_page = run_path(str(ROOT / "notebooks/pictures.py"))["first_page"]
    frames = Path(os.environ["TERRAIN_ODOMETRY_DATA"]) / "camera-frames/husky"
    first_page(tmp_path / "a.jpg", frames, results[WITH], results[WITHOUT])
    size = (tmp_path / "a.jpg").stat().st_size
    assert size == pytest.approx((PICTURES / "first_page.jpg").stat().st_size, rel=0.05)


def test_the_citation_is_of_this_version() -> None:
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert (cited["title"], cited["version"]) == (project["name"], project["version"])
    assert cited["license"] == project["license"]
    assert cited["cff-version"] == "1.2.0"
    assert cited["authors"]
