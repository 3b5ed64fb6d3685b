"""What the README, the docstrings and the notebooks show does run."""

import doctest
import importlib
import pkgutil
import re
from functools import partial
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

import odometry
import terrain
from terrain.synthetic import SynthesisConfig, synthesise

ROOT = Path(__file__).parents[1]
MODULES = [
    module.name
    for package in (odometry, terrain)
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + ".")
]


def test_the_python_of_the_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As it stands there, on a shorter run and fewer patches."""
    small = SynthesisConfig(zone_length_m=4.0, patches_per_terrain=16)
    monkeypatch.setattr(terrain, "synthesise", partial(synthesise, config=small))
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    exec(compile(code, "README.md", "exec"), names)  # noqa: S102
    assert (tmp_path / "results" / "report.html").is_file()
    assert [event.terrain for event in names["result"].watcher.events] == ["grass", "gravel"]  # type: ignore[attr-defined]


def test_docstrings() -> None:
    results = [doctest.testmod(importlib.import_module(name)) for name in MODULES]
    assert sum(result.attempted for result in results) > 0
    assert sum(result.failed for result in results) == 0


@pytest.mark.parametrize("notebook", sorted(ROOT.glob("notebooks/*.ipynb")), ids=lambda p: p.stem)
def test_notebooks_run(notebook: Path, tmp_path: Path) -> None:
    book = nbformat.read(notebook, as_version=4)
    NotebookClient(
        book, timeout=300, kernel_name="python3", resources={"metadata": {"path": tmp_path}}
    ).execute()
    errors = [
        output
        for cell in book.cells
        for output in cell.get("outputs", [])
        if output.output_type == "error"
    ]
    assert not errors
