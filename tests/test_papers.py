"""tests/papers.md, row by row: what it cites is there, and cites the equation in turn."""

import ast
import re
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
TABLE = (ROOT / "tests/papers.md").read_text(encoding="utf-8")
NUMBERED = {  # equations, tables, figures
    "Chen 2023": (26, 2, 9),
    "Baril 2020": (13, 1, 8),
    "Martinez 2024": (13, 2, 8),
    "Martinez 2017": (30, 2, 8),
    "Salvi 2024": (11, 0, 6),
}
KINDS = ("eq.", "Table", "Fig.")
NUMBERS = r"\d+(?:(?:-|\sto\s)\d+)?"
LIST = rf"{NUMBERS}(?:(?:,\s|\sand\s){NUMBERS})*"
CITATION = re.compile(
    rf"(?P<author>[A-Z]\w+)(?:\s+et\s+al\.)?,?\s+(?P<year>(?:19|20)\d\d)\b|\b[Ee]q\.\s+(?P<eq>{LIST})"
)
PACKAGES = sorted(file for name in ("odometry", "terrain") for file in (ROOT / name).rglob("*.py"))


def expanded(numbers: str) -> set[int]:
    """Of "4, 5 and 7-9" or "4 to 6"."""
    found: set[int] = set()
    for first, last in re.findall(r"(\d+)(?:(?:-|\sto\s)(\d+))?", numbers):
        found |= set(range(int(first), int(last or first) + 1))
    return found


def rows() -> dict[str, list[list[str]]]:
    """Cells of every row, by paper."""
    found = {}
    for section in re.split(r"^## ", TABLE, flags=re.MULTILINE)[1:]:
        paper, _, text = section.partition("\n")
        lines = [line for line in text.splitlines() if line.startswith("| ")]
        found[paper] = [[c.strip() for c in line.strip("|").split(" |")] for line in lines[1:]]
    return found


ROWS = rows()
each_paper = pytest.mark.parametrize("paper", NUMBERED)


def numbers_of(cell: str, kind: str) -> set[int]:
    return expanded(cell.removeprefix(kind)) if cell.startswith(kind) else set()


@cache
def tree_of(file: str) -> ast.Module:
    return ast.parse((ROOT / file).read_text(encoding="utf-8"))


def lines_of(file: str, name: str) -> tuple[int, int]:
    """First and last line of a function, class or method (`Class.method`)."""
    node: ast.Module | ast.ClassDef | ast.FunctionDef = tree_of(file)
    for part in name.split("."):
        named = [n for n in node.body if isinstance(n, ast.ClassDef | ast.FunctionDef)]
        assert part in [n.name for n in named], f"{file}:{name}"
        (node,) = (n for n in named if n.name == part)
    assert not isinstance(node, ast.Module)
    assert node.end_lineno
    return node.lineno, node.end_lineno


@cache
def citations(file: str) -> list[tuple[int, str, int]]:
    """Line, paper and number of each equation that a file cites, by the author named last."""
    text, paper, found = (ROOT / file).read_text(encoding="utf-8"), "", []
    for match in CITATION.finditer(text):
        if match["author"]:
            paper = f"{match['author']} {match['year']}"
        else:
            line = text.count("\n", 0, match.start()) + 1
            found += [(line, paper, number) for number in expanded(match["eq"])]
    return found


def test_there_is_a_table_of_each_paper() -> None:
    assert set(ROWS) == set(NUMBERED)
    assert {len(cells) for table in ROWS.values() for cells in table} == {5}


@each_paper
def test_every_numbered_thing_has_one_row(paper: str) -> None:
    for kind, many in zip(KINDS, NUMBERED[paper], strict=True):
        found = [number for cells in ROWS[paper] for number in numbers_of(cells[0], kind)]
        assert sorted(found) == list(range(1, many + 1)), kind


@each_paper
def test_cited_code_cites_the_equation(paper: str) -> None:
    """Each function that a row names cites one of its equations, together they cite all."""
    for row, _, code, *_ in ROWS[paper]:
        wanted, found = numbers_of(row, "eq."), set()
        for file, name in re.findall(r"`([\w/.]+\.py):([\w.]+)`", code):
            first, last = lines_of(file, name)
            here = {n for line, of, n in citations(file) if of == paper and first <= line <= last}
            assert here & wanted or not wanted, f"{row}: {file}:{name}"
            found |= here
        assert wanted <= found or code == "-", row


@each_paper
def test_cited_tests_and_files_exist(paper: str) -> None:
    for row, _, code, test, words in ROWS[paper]:
        for file, name in re.findall(
            r"`([\w/.]+\.(?:py|toml|ipynb))(?::([\w.]+))?`", f"{code} {test} {words}"
        ):
            assert (ROOT / file).is_file(), f"{row}: {file}"
            assert not name or lines_of(file, name), f"{row}: {name}"
        assert (code == "-") == (test == "-"), f"{row}: code has a test"
        assert words, row


@each_paper
def test_every_equation_that_the_code_cites_has_code_in_the_table(paper: str) -> None:
    """A citation of an equation that the table says is not needed would be news."""
    implemented = {
        number
        for row, _, code, *_ in ROWS[paper]
        if code != "-"
        for number in numbers_of(row, "eq.")
    }
    for path in PACKAGES:
        file = path.relative_to(ROOT).as_posix()
        cited = {
            number
            for line, of, number in citations(file)
            if of == paper and not is_a_source(path, line)
        }
        assert cited <= implemented, f"{file}: {cited - implemented}"


def is_a_source(path: Path, line: int) -> bool:
    """Whether a line states what a whole file or class is from, in one range."""
    text = path.read_text(encoding="utf-8").splitlines()[line - 1]
    return line == 1 or text.lstrip().startswith(('source = "', '"""'))


def test_the_ways_to_cite_that_are_read() -> None:
    assert expanded("4, 5 and 7-9") == {4, 5, 7, 8, 9}
    assert expanded("4 to 6") == {4, 5, 6}
    cited = citations("odometry/icrs/points.py")
    assert {(paper, number) for _, paper, number in cited} >= {
        *(("Baril 2020", n) for n in (4, 5, 6)),
        *(("Martinez 2017", n) for n in (1, 2, 3, 17, 18, 19)),
        ("Chen 2023", 2),
    }
