"""The examples of adding.md, applied to a copy of the project: what is added there works."""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
TEXT = (ROOT / "tests/adding.md").read_text(encoding="utf-8")
SECTIONS = re.findall(r"^## (An? .+?)\n(.*?)(?=^## )", TEXT, flags=re.DOTALL | re.MULTILINE)
MOST_LINES = 60
CALLED = """
import contextlib, io, json, sys
import pytest
ended = {}
for name, words in json.loads(sys.argv[1]).items():
    with contextlib.redirect_stdout(io.StringIO()) as said:
        code = pytest.main(["-q", "-n", "0", "-p", "no:cacheprovider", *words])
    ended[name] = (code, said.getvalue())
print(json.dumps(ended))
"""
Block = tuple[str, str, str]  # file, the line after which it is inserted ("" of new files), lines


def blocks(section: str) -> list[Block]:
    """The blocks of a section."""
    found = []
    for fenced in re.findall(r"^```\w+\n# (.*?)^```$", section, flags=re.DOTALL | re.MULTILINE):
        place, _, lines = fenced.partition("\n")
        file, _, line = place.removeprefix("new file: ").partition(", after: ")
        found.append((file, line, lines))
    return found


def apply(root: Path, file: str, line: str, lines: str) -> None:
    """Write a new file, or insert lines after the only line of a file that is as stated."""
    target = root / file
    if not line:
        assert not target.exists(), f"{file} exists"
        target.write_text(lines, encoding="utf-8")
        return
    text = target.read_text(encoding="utf-8")
    assert text.count(f"\n{line}\n") == 1, f"{file} has not one line {line!r}"
    target.write_text(text.replace(f"\n{line}\n", f"\n{line}\n{lines}"), encoding="utf-8")


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The project with all examples."""
    root = tmp_path_factory.mktemp("copy")
    for name in ("odometry", "terrain", "tests"):
        shutil.copytree(
            ROOT / name, root / name, ignore=shutil.ignore_patterns("__pycache__", "version_*")
        )
    for name in ("notebooks", "README.md", "pyproject.toml"):
        (root / name).symlink_to(ROOT / name)
    (root / "data").mkdir()
    for file in (ROOT / "data").iterdir():
        (root / "data" / file.name).symlink_to(file)
    (root / "data/README.md").unlink()
    shutil.copy(ROOT / "data/README.md", root / "data/README.md")
    for _, section in SECTIONS:
        for block in blocks(section):
            apply(root, *block)
    return root


def test_each_example_is_short() -> None:
    assert len(SECTIONS) == 7
    for name, section in SECTIONS:
        assert all(lines.count("\n") <= MOST_LINES for *_, lines in blocks(section)), name


def test_the_copy_is_as_the_style_asks(copy: Path) -> None:
    files = [file for _, section in SECTIONS for file, *_ in blocks(section) if file[-3:] == ".py"]
    found = subprocess.run(
        [sys.executable, "-m", "ruff", "check", "--no-cache", *files],
        cwd=copy, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert found.returncode == 0, found.stdout[-2000:]


@pytest.fixture(scope="module")
def ended(copy: Path) -> dict[str, tuple[int, str]]:
    """Exit code and output of the command of each section, all called in one process."""
    commands = {name: re.findall(r"`(pytest .*?)`", section) for name, section in SECTIONS}
    calls = {name: shlex.split(command)[1:] for name, (command,) in commands.items()}
    called = subprocess.run(
        [sys.executable, "-c", CALLED, json.dumps(calls)],
        cwd=copy,
        env={**os.environ, "PYTHONPATH": str(copy)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert called.returncode == 0, called.stderr[-3000:]
    return {name: (code, said) for name, (code, said) in json.loads(called.stdout).items()}


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name, _ in SECTIONS])
def test_what_is_added_passes_its_tests(ended: dict[str, tuple[int, str]], name: str) -> None:
    code, said = ended[name]
    assert code == 0, f"{name}: {said[-3000:]}"
    assert int(re.findall(r"(\d+) passed", said)[0]) > 0
