"""Mutation testing: which small changes of the code does no test notice?

    pip install cosmic-ray==8.7.0
    python -m tests.studies.speed.mutants texture region --sample 30 --seed 0

For each room of `[tool.mutants]` in pyproject.toml: cosmic-ray's operators give every small change
(an operator, a number, a comparison, a condition) of its files; a sample of them, drawn from a
seed, is tried one by one on a copy of the tree, with the room's own tests until the first that
fails. Printed: the share that tests noticed, and each change that none did.
"""

import argparse
import importlib
import os
import resource
import shutil
import signal
import sys
import tempfile
import time
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from cosmic_ray import plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code

ROOT = Path(__file__).parents[3]
COPIED = ("odometry", "terrain", "tests", "data", "pyproject.toml", "README.md")
PRELOADED = ("scipy.optimize", "scipy.spatial", "scipy.stats", "sklearn.neighbors", "cv2")
BINARY = ("Add_Sub", "Sub_Add", "Mul_Div", "Div_Mul", "Pow_Mul", "BitAnd_BitOr", "BitOr_BitAnd")
COMPARISONS = ("Lt_LtE", "LtE_Lt", "Gt_GtE", "GtE_Gt", "Lt_Gt", "Gt_Lt", "Eq_NotEq", "NotEq_Eq")
OTHERS = (
    "AddNot",
    "NumberReplacer",
    "ReplaceAndWithOr",
    "ReplaceOrWithAnd",
    "ReplaceFalseWithTrue",
)
OPERATORS = (  # slips of a programmer: most of the others are errors of types, which mypy notices
    *(f"core/ReplaceBinaryOperator_{name}" for name in BINARY),
    *(f"core/ReplaceComparisonOperator_{name}" for name in COMPARISONS),
    *(f"core/ReplaceUnaryOperator_{name}" for name in ("Delete_Not", "Delete_USub")),
    *(f"core/{name}" for name in (*OTHERS, "ReplaceTrueWithFalse", "ReplaceContinueWithBreak")),
)
TESTS_CPU_S = 120  # what takes longer has lost its way


@dataclass(frozen=True)
class Mutant:
    """One occurrence of one operator in one file."""

    file: str
    operator: str
    occurrence: int
    line: int


def main() -> None:
    """Try the sample of every room that is named, or of all."""
    rooms = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["mutants"]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("rooms", nargs="*", help=f"of {', '.join(rooms)}; all if none is named")
    parser.add_argument("--sample", type=int, default=30)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    for name in PRELOADED:
        importlib.import_module(name)
    with tempfile.TemporaryDirectory() as scratch:
        copy = Path(scratch)
        for name in COPIED:
            take = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
            take(ROOT / name, copy / name)
        for name in arguments.rooms or rooms:
            rng = np.random.default_rng(arguments.seed)
            try_room(copy, name, rooms[name], arguments.sample, rng)


def try_room(
    copy: Path, name: str, room: dict[str, list[str]], sample: int, rng: np.random.Generator
) -> None:
    """Print what the tests of one room notice."""
    if not passes(copy, room["tests"]):
        sys.exit(f"{name}: its tests fail without any change")
    every = [
        m for pattern in room["files"] for f in sorted(copy.glob(pattern)) for m in of(copy, f)
    ]
    chosen = rng.choice(len(every), min(sample, len(every)), replace=False)
    survivors = []
    for number in sorted(chosen):
        mutant = every[number]
        file = copy / mutant.file
        text = file.read_text(encoding="utf-8")
        operator = plugins.get_operator(mutant.operator)()
        changed = mutate_code(text, operator, mutant.occurrence)
        file.write_text(changed, encoding="utf-8")
        start = time.monotonic()
        survived = passes(copy, nearest_first(copy, mutant.file, room["tests"]))
        file.write_text(text, encoding="utf-8")
        if survived:
            survivors.append(mutant)
        word = "SURVIVED" if survived else "noticed"
        new = changed.splitlines()[mutant.line - 1].strip()
        print(
            f"{word} {mutant.file}:{mutant.line} {time.monotonic() - start:.0f} s: {new}",
            flush=True,
        )
    print(f"{name}: {len(chosen) - len(survivors)} of {len(chosen)} noticed, {len(every)} in all")


def of(copy: Path, file: Path) -> list[Mutant]:
    """Every mutant of a file."""
    tree = get_ast(file.read_text(encoding="utf-8"))
    lines = file.read_text(encoding="utf-8").splitlines()
    found = []
    for name in OPERATORS:
        operator = plugins.get_operator(name)()
        places = [
            start for node in ast_nodes(tree) for start, _ in operator.mutation_positions(node)
        ]
        found += [
            Mutant(str(file.relative_to(copy)), name, number, line)
            for number, (line, column) in enumerate(places)
            if runs(lines[line - 1], column)
        ]
    return found


def runs(line: str, column: int) -> bool:
    """Whether a change of a line changes what is computed: no `|` of a hint, no decorator."""
    hint = line[column] == "|" and ("->" in line or ":" in line[:column])
    return not hint and not line.lstrip().startswith("@")


def nearest_first(copy: Path, file: str, tests: list[str]) -> list[str]:
    """The tests of a room, those named like the changed file first."""
    named = f"test_{Path(file).stem}.py"
    found = [path for test in tests for path in sorted((copy / test).rglob(named))]
    return [str(path.relative_to(copy)) for path in found] + tests


def passes(copy: Path, tests: list[str]) -> bool:
    """Run tests in a process of their own, which has the large packages already."""
    child = os.fork()
    if child == 0:
        run_tests(copy, tests)
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status) == 0


def run_tests(copy: Path, tests: list[str]) -> None:
    """The child: ends with pytest's exit code, or is ended where it takes too long."""
    resource.setrlimit(resource.RLIMIT_CPU, (TESTS_CPU_S, TESTS_CPU_S))
    signal.signal(signal.SIGXCPU, signal.SIG_DFL)
    silent = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silent, 1)
    os.dup2(silent, 2)
    os.chdir(copy)
    own = {"tests", "odometry", "terrain"}
    for name in [name for name in sys.modules if name.partition(".")[0] in own]:
        del sys.modules[name]
    sys.path = [str(copy), *(path for path in sys.path if Path(path or ".").resolve() != ROOT)]
    sys.dont_write_bytecode = True  # two changes within a second would have the same stamp
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # which `tests/conftest.py` would undo
    code = pytest.main(["-x", "-q", "-n", "0", "-p", "no:cacheprovider", *tests])
    os._exit(int(code))


if __name__ == "__main__":
    main()
