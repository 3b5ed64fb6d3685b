"""What the docstrings show does run."""

import doctest
import importlib
import re
from pathlib import Path
from types import ModuleType

import pytest

import odometry
import terrain

ROOT = Path(__file__).parents[1]
SOURCES = {
    ".".join(file.relative_to(ROOT).with_suffix("").parts): file.read_text(encoding="utf-8")
    for package in ("odometry", "terrain")
    for file in sorted((ROOT / package).rglob("*.py"))
}
WITH_EXAMPLES = [name for name, source in SOURCES.items() if ">>>" in source]


def test_docstrings_of_no_module_go_untested() -> None:
    assert len(WITH_EXAMPLES) > 60


@pytest.mark.slow
@pytest.mark.parametrize("name", WITH_EXAMPLES)
def test_docstrings(name: str) -> None:
    result = doctest.testmod(importlib.import_module(name))
    assert result.attempted > 0
    assert result.failed == 0


def examples_of(package: ModuleType, name: str) -> list[doctest.Example]:
    """Those in the docstring of a name; where it is a plain value, in that of its file."""
    value = getattr(package, name)
    if not callable(value):
        stub = Path(str(package.__file__)).with_suffix(".pyi").read_text(encoding="utf-8")
        (file,) = re.findall(rf"^from \.(\S+) import .*\b{name}\b", stub, flags=re.MULTILINE)
        value = importlib.import_module(f"{package.__name__}.{file}")
    found = doctest.DocTestFinder(recurse=False).find(value, name)
    return [example for each in found for example in each.examples]


@pytest.mark.parametrize("package", [odometry, terrain])
def test_every_public_name_has_an_example(package: ModuleType) -> None:
    for name in package.__all__:
        assert examples_of(package, name), name


def test_only_the_long_demonstration_is_shown_and_not_run() -> None:
    """The verb `demo` runs it."""
    skipped = {name for name in WITH_EXAMPLES if "+SKIP" in SOURCES[name]}
    assert skipped == {"terrain.demo"}
