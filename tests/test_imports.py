"""Imports point one way, have no circles, and cost nothing until a name is used."""

import ast
import importlib
import pkgutil
import subprocess
import sys
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
HEAVY = ("cv2", "sklearn", "skimage", "matplotlib", "filterpy", "scipy")


def module_name(file):
    parts = file.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


FILES = {
    module_name(file): file
    for package in ("odometry", "terrain")
    for file in sorted((ROOT / package).rglob("*.py"))
}


def examples(file):
    """The lines of Python in docstrings of a file."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            for line in (ast.get_docstring(node) or "").splitlines():
                if line.lstrip().startswith((">>> ", "... ")):
                    yield line.lstrip()[4:].lstrip()


def imported(file):
    """Modules of ours that a file imports anywhere in it, functions included."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{alias.name}" for alias in node.names] + [node.module]
            assert node.level == 0, f"{file}: relative import"
        else:
            continue
        yield from (name for name in names if name in FILES)


@cache
def graph():
    """What each module imports of ours."""
    return {name: set(imported(file)) - {name} for name, file in FILES.items()}


def packages_only(names):
    return {name for name in names if "." not in name}


def test_there_is_no_circle_between_files():
    """Importing a name from a package's lazy __init__ would hide one: nobody does."""
    assert sum(map(len, graph().values())) > len(graph())
    TopologicalSorter(graph()).prepare()
    assert not any(packages_only(targets) for targets in graph().values())


def room_of(name):
    """The folder of a file, below its package; a file that is in no folder stands for itself."""
    return ".".join(name.split(".")[:2])


def test_there_is_no_circle_between_rooms():
    rooms = {}
    for name, targets in graph().items():
        rooms.setdefault(room_of(name), set()).update(map(room_of, targets))
    assert len(rooms) < len(graph()) / 5
    TopologicalSorter({room: others - {room} for room, others in rooms.items()}).prepare()


def test_odometry_never_imports_terrain():
    pointing_back = {
        name: target
        for name, targets in graph().items()
        for target in targets
        if name.split(".")[0] == "odometry" and target.split(".")[0] == "terrain"
    }
    assert pointing_back == {}


def test_models_do_not_import_what_uses_them():
    """What a model needs said of it, it says itself."""
    users = ("identification", "windows", "effects", "estimation", "comparison", "gap")
    models = {name: graph()[name] for name in graph() if name.startswith("odometry.models")}
    assert models
    for name, targets in models.items():
        rooms = {target.split(".")[1] for target in targets if target.startswith("odometry.")}
        assert not rooms & set(users), name


ROOMS_IN_ORDER = {
    "odometry.gap": ("prepare", "locate", "fit", "name", "answer", "show"),
    "odometry.checks": (
        *("findings", "statistics", "evidence", "turns", "parts", "treads", "imu", "units"),
        *("copies", "stamps", "poses", "settings", "unexplained"),
    ),
    "odometry.bags": ("files", "topics", "wheels", "rows"),
    "odometry.feel": ("recorded", "classifier", "assessment", "labels"),
    "odometry.windows": ("recorded", "travel", "dense", "stretches"),
    "odometry.modes": ("recorded", "models", "identify", "checks", "follow", "show"),
    "odometry.report": ("drawing", "icrs", "comparison", "gap", "modes"),
    "odometry.effects": ("interface", "commands", "motion", "measurement", "unknown"),
    "terrain.cli": ("texts", "verbs"),
    "terrain": ("camera", "region", "image_labels", "switch", "sources", "result", "live"),
}


@pytest.mark.parametrize("package", ROOMS_IN_ORDER)
def test_rooms_import_in_the_order_of_the_story(package):
    story = [f"{package}.{room}" for room in ROOMS_IN_ORDER[package]]
    for room in story:
        files = {name: graph()[name] for name in graph() if name.startswith(f"{room}.")}
        assert files, room
        later = story[story.index(room) + 1 :]
        for name, targets in files.items():
            back = {target for target in targets if target.rpartition(".")[0] in later}
            assert not back, name


@pytest.mark.parametrize("package", ["odometry.checks", "odometry.effects"])
def test_no_room_imports_the_files_that_join_the_rooms(package):
    joining = {name for name in graph() if name.rpartition(".")[0] == package}
    assert joining
    rooms = {name: graph()[name] for name in graph() if name.startswith(f"{package}.")}
    assert not [name for name in rooms.keys() - joining if rooms[name] & joining]


def test_only_the_command_line_imports_click_and_nobody_else_exits():
    for name, file in FILES.items():
        if not name.startswith("terrain.cli"):
            text = file.read_text(encoding="utf-8")
            assert "import click" not in text, name
            assert "sys.exit" not in text, name


@pytest.mark.parametrize("package", ["odometry", "terrain"])
def test_every_module_can_be_imported(package):
    root = importlib.import_module(package)
    names = [module.name for module in pkgutil.walk_packages(root.__path__, f"{package}.")]
    assert names
    for name in names:
        importlib.import_module(name)


@pytest.mark.parametrize("package", ["odometry", "terrain"])
def test_every_public_name_is_there(package):
    module = importlib.import_module(package)
    assert module.__all__
    for name in module.__all__:
        assert getattr(module, name) is not None


@pytest.mark.parametrize("package", ["odometry", "terrain"])
def test_no_file_has_the_name_of_a_public_name(package):
    """Python sets an imported file on its package: it would stand in place of the public name."""
    module = importlib.import_module(package)
    files = {file.name for file in pkgutil.iter_modules(module.__path__)}
    assert not files & set(module.__all__)


def loaded_with(modules, names):
    """Which of the names a new process has loaded once it has imported the modules."""
    code = f"import sys, {modules}\nprint([name for name in {names!r} if name in sys.modules])"
    finished = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=ROOT
    )
    return finished.stdout.strip()


def test_importing_the_packages_imports_nothing_heavy():
    assert loaded_with("terrain, odometry, terrain.cli.main", HEAVY) == "[]"


def test_what_needs_no_classifier_loads_none():
    """Scikit-learn, with pandas, takes as long to load as the rest of a check."""
    modules = "terrain.checks.recording, terrain.main_job, terrain.results"
    assert loaded_with(modules, ("sklearn", "pandas")) == "[]"


@pytest.mark.parametrize("name", [name for name in FILES if name.startswith("odometry")])
def test_examples_of_odometry_need_nothing_of_terrain(name):
    lines = examples(FILES[name])
    assert not [line for line in lines if line.startswith(("import terrain", "from terrain"))]
