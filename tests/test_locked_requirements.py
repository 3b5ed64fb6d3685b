"""The lock file of developers: what pyproject.toml asks for, with hashes, and no host named."""

import re
import tomllib
from itertools import chain
from pathlib import Path

import pytest
from packaging.markers import Marker
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[1]
LOCKED = (ROOT / "tests" / "requirements-dev.txt").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
ENTRY = re.compile(r"(\S+)==(\S+)(?: ; (.+?))?((?: \\\n    --hash=sha256:[0-9a-f]{64})+)\n")
ASKED = [*PROJECT["dependencies"], *chain(*PROJECT["optional-dependencies"].values())]
PYTHONS = ["3.11", "3.12", "3.13"]


def test_each_line_is_a_version_or_a_hash() -> None:
    assert ENTRY.sub("", LOCKED) == ""


@pytest.mark.parametrize("python", PYTHONS)
def test_each_dependency_is_locked_within_its_bounds(python: str) -> None:
    here = {"python_version": python, "python_full_version": f"{python}.0"}
    locked = {
        name: version
        for name, version, marker, _ in ENTRY.findall(LOCKED)
        if not marker or Marker(marker).evaluate(here)
    }
    for requirement in map(Requirement, ASKED):
        if not requirement.marker or requirement.marker.evaluate(here):
            assert requirement.specifier.contains(locked[canonicalize_name(requirement.name)])
