"""What the docstrings and the notebooks show does run."""

import doctest
import importlib
import pkgutil
from pathlib import Path

import nbformat
import pytest
from nbclient import NotebookClient

import odometry
import terrain

ROOT = Path(__file__).parents[1]
MODULES = [
    module.name
    for package in (odometry, terrain)
    for module in pkgutil.walk_packages(package.__path__, package.__name__ + ".")
]


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
