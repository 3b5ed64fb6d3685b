"""No input becomes code: of Python, of a page, of a spreadsheet. Checked by the source itself."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
FILES = sorted(file for room in ("odometry", "terrain") for file in (ROOT / room).rglob("*.py"))
CODE = {
    "pickle",
    "cPickle",
    "dill",
    "cloudpickle",
    "marshal",
    "shelve",
    "subprocess",
    "code",
    "runpy",
}
CALLS = {
    "eval",
    "exec",
    "compile",
    "__import__",
    "system",
    "popen",
    "execv",
    "spawnv",
    "literal_eval",
}

# What opens a file to write lines into it, and why no formula can stand in a cell of it.
LINES = {
    "odometry/io/csv_table.py": "texts are quoted",
    "terrain/batch/batch.py": "names of runs are quoted",
    "odometry/bags/rows/image_files.py": "stamps, and names that are numbered",
    "odometry/bags/rows/ordered_rows.py": "numbers below names of columns of its own",
    "odometry/bags/rows/pose_rows.py": "numbers behind the lines of ordered_rows.py",
    "odometry/io/euroc.py": "numbers",
    "odometry/io/kitti.py": "numbers",
    "odometry/io/tum.py": "numbers",
}


@cache
def trees() -> dict[str, ast.Module]:
    """The source of each file, parsed."""
    return {file.relative_to(ROOT).as_posix(): ast.parse(file.read_text("utf-8")) for file in FILES}


def nodes(kind: type[ast.AST]) -> Iterator[tuple[str, ast.AST]]:
    for file, tree in trees().items():
        yield from ((file, node) for node in ast.walk(tree) if isinstance(node, kind))


@cache
def calls() -> list[tuple[str, str, str, ast.Call]]:
    """File, what is called, its last name, and the call."""
    named = [(file, ast.unparse(node.func), node) for file, node in nodes(ast.Call)]
    return [(file, called, called.rpartition(".")[2], node) for file, called, node in named]


def modes_of(call: ast.Call) -> list[str]:
    """Arguments that are a mode in which `open` writes text."""
    values = [*call.args, *(word.value for word in call.keywords if word.arg == "mode")]
    texts = [each.value for each in values if isinstance(each, ast.Constant)]
    return [
        t for t in texts if isinstance(t, str) and set(t) & set("wax") and not set(t) - set("waxt+")
    ]


@pytest.mark.slow
def test_nothing_imports_what_makes_code_of_bytes_or_starts_programs():
    found = []
    for kind in (ast.Import, ast.ImportFrom):
        for file, node in nodes(kind):
            names = [name.name for name in node.names] + [getattr(node, "module", None) or ""]
            found += [(file, name) for name in names if name.partition(".")[0] in CODE]
    assert not found


def test_nothing_computes_a_text():
    found = [(file, called) for file, called, name, _ in calls() if name in CALLS]
    assert [one for one in found if one[1] != "re.compile"] == []


def test_modules_are_imported_by_names_of_the_program():
    """A name of a file of the package, or of a table of the code: no argument is joined to it."""
    found = {file for file, _, name, _ in calls() if name == "import_module"}
    assert found == {
        "odometry/bags/files/damage.py",
        "odometry/bags/files/messages.py",
        "odometry/installed.py",
        "terrain/cli/verbs/export.py",
        "terrain/cli/main.py",
    }


def test_yaml_and_arrays_are_read_as_data():
    loads = [ast.unparse(node) for _, called, _, node in calls() if called.startswith("yaml.")]
    assert [text for text in loads if "load" in text and "Loader=yaml.BaseLoader" not in text] == []
    arrays = [
        node for _, called, _, node in calls() if called in ("np.load", "np.lib.format.read_array")
    ]
    pickled = [
        ast.unparse(node) for node in arrays if "allow_pickle=False" not in ast.unparse(node)
    ]
    assert pickled == []


def test_xml_is_read_without_entities():
    found = {file for file, called, _, _ in calls() if called == "ET.fromstring"}
    assert found == {"odometry/bags/topics/robot_messages.py", "terrain/camera_files/values.py"}
    for file in found:
        assert '"<!ENTITY" in text' in (ROOT / file).read_text("utf-8")


def test_pages_are_put_together_in_one_file_which_escapes():
    """An end of an element in a text elsewhere would be a page, or a part of one, past it."""
    found = {
        file
        for file, node in nodes(ast.Constant)
        if isinstance(node.value, str) and ("</" in node.value or "<td" in node.value)
    }
    assert found == {"odometry/report/drawing/html.py"}


def test_the_program_that_writes_lines_is_known():
    found = {file for file, _, name, node in calls() if name == "open" and modes_of(node)}
    assert found == set(LINES), "LINES of this test says of each file why it writes no formula"
    assert {file for file, called, _, _ in calls() if called == "csv.writer"} == {
        "odometry/io/csv_table.py",
        "terrain/batch/batch.py",
    }


@pytest.mark.parametrize("file", ["odometry/io/csv_table.py", "terrain/batch/batch.py"])
def test_writers_of_texts_quote(file):
    assert "quoted_text(" in ast.unparse(trees()[file])
