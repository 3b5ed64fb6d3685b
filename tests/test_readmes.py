"""Links, commands, settings and Python of every README."""

import re
import shlex
import subprocess
import sys
import tomllib
from dataclasses import asdict
from functools import partial
from pathlib import Path

import click
import numpy as np
import pytest

import odometry
import terrain
import terrain.synthetic
from terrain.cli.main import cli
from terrain.config import Config
from tests.odometry.bags.made_bags import Bag
from tests.public_names import private_imports
from tests.stubs import needs_new_stubs

ROOT = Path(__file__).parents[1]
README_FILES = [
    ROOT / name
    for name in (
        "README.md",
        "data/README.md",
        "odometry/README.md",
        "terrain/README.md",
        "tests/README.md",
    )
] + sorted((ROOT / "tests/studies").glob("*.md"))
CHANGES = ROOT / "terrain/CHANGES.md"
each_readme = pytest.mark.parametrize(
    "readme", [*README_FILES, CHANGES], ids=lambda file: str(file.relative_to(ROOT))
)
# a sixth to two fifths of the time of mypy goes into garbage of a process that ends anyway
WITHOUT_COLLECTION = """
import gc, sys
from mypy.main import main
gc.disable()
gc.enable = lambda: None
main(args=sys.argv[1:], stdout=sys.stdout, stderr=sys.stderr)
"""


def blocks(readme: Path, *languages: str) -> list[str]:
    """Blocks of code in one of these languages; "" is a block that states none."""
    text = readme.read_text(encoding="utf-8")
    fences = re.findall(r"^```(\w*)\n(.*?)^```$", text, flags=re.DOTALL | re.MULTILINE)
    return [code for language, code in fences if language in languages]


def prose(readme: Path) -> str:
    """All but the blocks of code."""
    text = readme.read_text(encoding="utf-8")
    return re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)


def anchors(readme: Path) -> set[str]:
    """As GitHub makes them of headings."""
    headings = re.findall(r"^#+ (.+)$", prose(readme), flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def test_every_readme_is_tested() -> None:
    folders = ("data", "notebooks", "odometry", "terrain", "tests")
    found = [file for folder in folders for file in (ROOT / folder).rglob("README.md")]
    assert {*found, ROOT / "README.md"} <= set(README_FILES)


@each_readme
def test_links(readme: Path) -> None:
    """Files and anchors that it points to are there."""
    targets = re.findall(r"\]\(([^)\s]+)\)", prose(readme))
    targets += re.findall(r'(?:src|srcset|href)="([^"]+)"', prose(readme))
    for target in targets:
        if target.startswith(("http://", "https://")):
            continue
        name, _, anchor = target.partition("#")
        file = (readme.parent / name) if name else readme
        assert file.exists(), target
        assert not anchor or anchor in anchors(file), target


@pytest.mark.parametrize("readme", README_FILES[1:], ids=lambda file: str(file.relative_to(ROOT)))
def test_contents(readme: Path) -> None:
    """Every section stands in the line of contents below the title."""
    text = prose(readme)
    contents = next(line for line in text.splitlines() if line.startswith("[") and " · " in line)
    sections = re.findall(r"^## (.+)$", text, flags=re.MULTILINE)
    assert [name.replace("`", "") for name in sections] == re.findall(r"\[([^]]+)\]\(#", contents)


def test_the_links_that_are_tested() -> None:
    assert sum(len(re.findall(r"\]\(", prose(readme))) for readme in README_FILES) > 60


@each_readme
def test_names_of_files(readme: Path) -> None:
    """Paths of the project between backticks exist."""
    pattern = r"`((?:odometry|terrain|tests|data|notebooks)/[\w/.]+)`"
    for name in re.findall(pattern, prose(readme)):
        assert (ROOT / name).exists(), name


def lines_of_commands(readme: Path) -> list[list[str]]:
    """Words of every line that calls `terrain-odometry`, without its comment."""
    shown = "\n".join(blocks(readme, "", "bash")).replace("\\\n", " ")
    calls = re.findall(r"^(?:\$ |.*&& | *)terrain-odometry ([a-z].*)$", shown, flags=re.MULTILINE)
    return [shlex.split(call, comments=True) for call in calls]


@each_readme
def test_commands(readme: Path) -> None:
    """Verbs, options and their choices are those of the command line."""
    for verb, *words in lines_of_commands(readme):
        command = cli.get_command(click.Context(cli), verb)
        assert command is not None, verb
        context = click.Context(command)
        values, rest, _ = command.make_parser(context).parse_args(words)
        assert not rest, words
        for option in command.params:
            value = values.get(option.name)
            if isinstance(option.type, click.Choice) and value is not None and "$" not in value:
                option.type_cast_value(context, value)


def test_the_commands_that_are_tested() -> None:
    assert sum(len(lines_of_commands(readme)) for readme in README_FILES) > 20


def test_the_settings_are_the_defaults() -> None:
    """The block of data/README.md is read by the program and changes nothing."""
    (block,) = blocks(ROOT / "data/README.md", "toml")
    stated = tomllib.loads(block)
    defaults = asdict(Config())
    for name, table in stated.items():
        assert table == {key: defaults[name][key] for key in table}, name


def test_every_study_is_named() -> None:
    text = (ROOT / "tests/studies/README.md").read_text(encoding="utf-8")
    studies = {file.name for file in (ROOT / "tests/studies").glob("*/*.py")}
    assert {name for name in studies if f"`{name}`" not in text} == set()


def run_blocks(readme: Path) -> dict[str, object]:
    """Run the Python of a README in its order, as one program."""
    names: dict[str, object] = {}
    for code in blocks(readme, "python"):
        exec(compile(code, str(readme), "exec"), names)  # noqa: S102
    return names


@pytest.mark.slow
def test_the_python_of_the_guides(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As it stands there, on a shorter run and fewer patches."""
    small = terrain.synthetic.SynthesisConfig(
        zone_length_m=3.0, patches_per_terrain=12, image_rate_hz=2.0
    )
    monkeypatch.setattr(terrain, "synthesise", partial(terrain.synthetic.synthesise, config=small))
    monkeypatch.chdir(tmp_path)
    as_bag(odometry.Run.read(ROOT / "data/runs/demo"), tmp_path / "drive.bag")
    names = run_blocks(ROOT / "terrain/README.md")
    assert (tmp_path / "results" / "report.html").is_file()
    assert (tmp_path / "lenient.model").is_file()
    expected = ["gravel", "grass", "gravel"]
    assert [event.terrain for event in names["result"].watcher.events] == expected  # type: ignore[attr-defined]
    switches = [step.switch.terrain for step in names["steps"] if step.switch]  # type: ignore[attr-defined]
    assert switches == expected


@pytest.mark.slow
def test_the_python_of_the_first_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """On a short run and few patches."""
    small = terrain.SynthesisConfig(
        zones=("gravel", "grass"), zone_length_m=2.0, patches_per_terrain=8
    )
    monkeypatch.setattr(terrain, "synthesise", partial(terrain.synthetic.synthesise, config=small))
    monkeypatch.chdir(tmp_path)
    run_blocks(ROOT / "README.md")
    assert (tmp_path / "results/report.html").is_file()


@pytest.mark.slow
def test_the_making_of_the_shipped_data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As data/README.md has it, on a shorter run."""
    short = partial(terrain.synthetic.SynthesisConfig, zone_length_m=1.0, patches_per_terrain=2)
    monkeypatch.setattr(terrain, "SynthesisConfig", short)
    monkeypatch.chdir(tmp_path)
    run_blocks(ROOT / "data/README.md")
    assert (tmp_path / "demo/run.toml").is_file()
    made, shipped = (
        odometry.read_mode_set(file)
        for file in (tmp_path / "demo.toml", ROOT / "data/modes/demo.toml")
    )
    assert made.names == shipped.names
    # a search: BLAS of other processors ends 3e-6 off it, a change of the maker moved it by 3e-4
    np.testing.assert_allclose(made.modes.A, shipped.modes.A, rtol=3e-5)
    felt, kept = (
        odometry.read_feel_model(file)
        for file in (tmp_path / "demo.feel", ROOT / "data/feel/demo.feel")
    )
    assert (felt.names, felt.design.columns) == (kept.names, kept.design.columns)


def as_bag(run: odometry.Run, path: Path) -> None:
    """A bag of ROS 1 with the wheels, the gyroscope and the images of a run."""
    bag = Bag("ros1")
    stamps_s, speeds = run.odometry.stamps_s, run.odometry.stack("v_left", "v_right", "gyro_z")
    for stamp_s, (left, right, rate) in zip(stamps_s, speeds, strict=True):
        bag.joints(stamp_s, ["left_wheel", "right_wheel"], [], [left / 0.15, right / 0.15])
        bag.imu(stamp_s, [0.0, 0.0, rate], [0.0, 0.0, 9.8])
    for frame in run.frames():
        if isinstance(frame.image, Path):
            bag.compressed(frame.stamp_s, frame.image.read_bytes())
    bag.write(path)


def test_the_example_of_ros_is_python_and_no_example_is_long() -> None:
    (node,) = blocks(ROOT / "terrain/README.md", "py")
    compile(node, "node.py", "exec")
    (live,) = (code for code in blocks(ROOT / "terrain/README.md", "python") if "bag_me" in code)
    assert len(live.splitlines()) <= 40


@each_readme
def test_no_python_goes_untested(readme: Path) -> None:
    tested = {ROOT / name for name in ("README.md", "data/README.md", "terrain/README.md")}
    assert readme in tested or not blocks(readme, "python", "py")


@each_readme
def test_the_python_imports_public_names(readme: Path) -> None:
    assert private_imports("\n".join(blocks(readme, "python"))) == set()


@pytest.mark.slow
@needs_new_stubs
def test_the_packages_and_the_python_of_the_guides_are_typed(tmp_path: Path) -> None:
    """By one run of mypy, as strictly as pyproject.toml says; each README is one program."""
    for readme in README_FILES:
        program = tmp_path / f"{'_'.join(readme.relative_to(ROOT).parts[:-1])}_readme.py"
        program.write_text("\n".join(blocks(readme, "python")), encoding="utf-8")
    programs = sorted(map(str, tmp_path.glob("*.py")))
    mypy = [sys.executable, "-c", WITHOUT_COLLECTION, "odometry", "terrain", *programs]
    result = subprocess.run(mypy, cwd=ROOT, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
