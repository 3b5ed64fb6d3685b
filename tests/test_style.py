"""The tree is clean under ruff and ruff-format; under mypy, see `test_readmes.py`."""

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize(
    "command",
    [
        pytest.param(["ruff", "check", "."], id="ruff"),
        pytest.param(["ruff", "format", "--check", "."], id="ruff-format"),
    ],
)
def test_the_tree_is_clean(command: list[str]) -> None:
    result = subprocess.run(
        [sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stdout + result.stderr


def test_the_top_level_holds_what_it_is_fixed_to() -> None:
    """What a program left in the folder that it was started in is no part of the project."""
    if not (ROOT / ".git").exists():
        pytest.skip("no git checkout: only tracked files are looked at")
    listed = subprocess.run(
        ["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.split("\n")
    shown = {name.split("/")[0] for name in listed if name and not name.startswith(".")}
    rooms = {"terrain", "odometry", "data", "tests", "notebooks"}
    assert shown == rooms | {"pyproject.toml", "README.md", "LICENSE", "CITATION.cff"}
