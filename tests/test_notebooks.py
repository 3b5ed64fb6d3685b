"""The notebooks: their outputs are those of a run, small, and made with public names alone."""

import re
from collections.abc import Iterator
from pathlib import Path
from tempfile import gettempdir

import nbformat
import numpy as np
import pytest
from jupyter_client.manager import AsyncKernelManager
from nbformat import NotebookNode

from tests.public_names import private_imports
from tests.refresh_notebooks import NOTEBOOKS, executed, shared_kernel

BYTES = 200_000
NUMBER = r"[-+]?\b\d+(?:\.\d+)?(?:e[-+]?\d+)?"
each_notebook = pytest.mark.parametrize(
    "notebook", sorted(NOTEBOOKS.glob("*.ipynb")), ids=lambda file: file.stem
)


def code_cells(book: NotebookNode) -> list[NotebookNode]:
    return [cell for cell in book.cells if cell.cell_type == "code"]


def shown(cell: NotebookNode) -> Iterator[tuple[str, str]]:
    """Kind and text of every output; of a picture only that there is one."""
    for output in cell.outputs:
        if output.output_type == "stream":
            yield str(output.name), str(output.text)
        elif output.output_type == "error":
            yield "error", "\n".join(output.traceback)
        else:
            pictured = "image/png" in output.data
            yield ("picture", "") if pictured else ("value", str(output.data["text/plain"]))


def words_and_numbers(text: str) -> tuple[str, list[str]]:
    """Text without its numbers and its runs of blanks, which numbers fill up."""
    words = re.sub(r"\s+", " ", re.sub(NUMBER, "#", text))
    return words.replace(" #", "#"), re.findall(NUMBER, text)


def last_digit(number: str) -> float:
    """What one in the last digit is worth."""
    mantissa, _, exponent = number.partition("e")
    return float(10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2])))


def assert_alike(kept: str, made: str) -> None:
    """The same words; numbers to one in the last digit or a hundredth, as libraries round."""
    (words, numbers), (made_words, made_numbers) = map(words_and_numbers, (kept, made))
    assert words == made_words
    for number, other in zip(numbers, made_numbers, strict=True):
        most = max(1.01 * last_digit(number), 0.01 * abs(float(number)))
        assert abs(float(number) - float(other)) <= most, (number, other, kept)


@pytest.fixture(scope="module")
def kernel() -> Iterator[AsyncKernelManager]:
    with shared_kernel() as started:
        yield started


@pytest.mark.slow
@each_notebook
def test_outputs_are_those_of_a_run(notebook: Path, kernel: AsyncKernelManager) -> None:
    kept, made = nbformat.read(notebook, as_version=4), executed(notebook, kernel)
    assert any(cell.outputs for cell in code_cells(kept))
    for cell, again in zip(code_cells(kept), code_cells(made), strict=True):
        old, new = list(shown(cell)), list(shown(again))
        assert [kind for kind, _ in old] == [kind for kind, _ in new]
        assert not {"error", "stderr"} & {kind for kind, _ in new}
        for (_, text), (_, text_again) in zip(old, new, strict=True):
            assert_alike(text, text_again)


@each_notebook
def test_outputs_are_small_and_carry_no_trace_of_a_run(notebook: Path) -> None:
    assert notebook.stat().st_size <= BYTES
    book = nbformat.read(notebook, as_version=4)
    assert set(book.metadata) == {"kernelspec", "language_info"}
    assert all(cell.metadata == {} for cell in book.cells)
    for cell in code_cells(book):
        assert cell.execution_count is None
        assert not any(gettempdir() in text for _, text in shown(cell))


@each_notebook
def test_only_public_names_are_imported(notebook: Path) -> None:
    book = nbformat.read(notebook, as_version=4)
    assert set().union(*(private_imports(cell.source) for cell in code_cells(book))) == set()


@pytest.mark.parametrize(("made", "alike"), [("a  1.24 b", True), ("a 1.26 b", False)])
def test_numbers_may_differ_in_the_last_digit(made: str, alike: bool) -> None:
    assert np.isclose(last_digit("1.23"), 0.01)
    assert np.isclose(last_digit("1.5e-05"), 1e-6)
    if alike:
        assert_alike("a 1.23 b", made)
    else:
        with pytest.raises(AssertionError):
            assert_alike("a 1.23 b", made)
