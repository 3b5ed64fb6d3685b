"""The pages of public names and of the command line: whole, and without a reference to nothing."""

import ast
import importlib
import inspect
from pathlib import Path

import click
import pytest

from terrain.cli.main import VERBS, cli
from tests.make_docs import broken_references, helps, make_docs
from tests.public_names import PUBLIC
from tests.site_first_page import PICTURE

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    make_docs(folder)
    return folder


@pytest.mark.slow
def test_every_public_name_has_its_place(site: Path) -> None:
    for module, names in PUBLIC.items():
        page = (site / f"{module.replace('.', '/')}.html").read_text(encoding="utf-8")
        assert {name for name in names if f'id="{name}"' not in page} == set()


def test_every_verb_has_its_help_on_the_page(site: Path) -> None:
    page = (site / "command_line.html").read_text(encoding="utf-8")
    for verb in VERBS:
        assert f"Usage: terrain-odometry {verb} " in page
    assert {"run", "gap", "import"} <= {verb for verb, _ in helps()}


def test_the_first_page_says_what_it_is_and_leads_to_all_others(site: Path) -> None:
    page = (site / "index.html").read_text(encoding="utf-8")
    assert "A skid-steer robot turns by dragging its treads" in page
    assert "BSD-3-Clause" in page  # of the picture
    assert (site / Path(PICTURE).name).is_file()
    pages = {f"{module.replace('.', '/')}.html" for module in PUBLIC}
    wanted = {*pages, *(f"command_line.html#{verb}" for verb in VERBS)}
    assert {link for link in wanted if page.count(f'href="{link}"') == 0} == set()


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_is_documented(verb: str) -> None:
    """A sentence, an example, words for every option, and a line in a README."""
    command = cli.get_command(click.Context(cli), verb)
    assert command is not None
    assert "Example" in (command.help or "")
    options = [one for one in command.params if isinstance(one, click.Option)]
    assert [one.name for one in options if not one.help] == []
    readmes = [*ROOT.glob("README.md"), *ROOT.glob("*/README.md")]
    assert any(f"`{verb} " in file.read_text(encoding="utf-8") for file in readmes)


def options_of(study: ast.Module) -> list[str]:
    """Options that the parser of a study takes."""
    calls = (node for node in ast.walk(study) if isinstance(node, ast.Call) and node.args)
    added = (call.args[0] for call in calls if ast.unparse(call.func).endswith(".add_argument"))
    return [a.value for a in added if isinstance(a, ast.Constant) and str(a.value).startswith("-")]


STUDIES = sorted((ROOT / "tests" / "studies").glob("*/*.py"))


@pytest.mark.parametrize("file", STUDIES, ids=lambda file: file.stem)
def test_a_study_begins_with_its_options(file: Path) -> None:
    study = ast.parse(file.read_text(encoding="utf-8"))
    words = ast.get_docstring(study) or ""
    assert [option for option in options_of(study) if option not in words] == []


@pytest.mark.parametrize("file", STUDIES, ids=lambda file: file.stem)
def test_a_program_says_its_first_lines_as_help(file: Path) -> None:
    text = file.read_text(encoding="utf-8")
    assert "__main__" not in text or "__doc__" in text


@pytest.mark.parametrize("module", PUBLIC)
def test_every_public_name_is_described(module: str) -> None:
    package = importlib.import_module(module)
    values = {name: getattr(package, name) for name in PUBLIC[module]}
    described = {name: value for name, value in values.items() if callable(value)}
    assert [name for name, value in described.items() if not inspect.getdoc(value)] == []


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ('<a href="b.html">b</a>', "a.html: b.html"),
        ('<a href="a.html#there">a</a>', "a.html: a.html#there"),
        ("<code>odometry.recording.frames.Film</code>", "a.html: odometry.recording.frames.Film"),
    ],
)
def test_a_reference_to_nothing_is_found(tmp_path: Path, broken: str, said: str) -> None:
    (tmp_path / "a.html").write_text(broken, encoding="utf-8")
    assert broken_references(tmp_path) == {said}


def test_a_reference_to_something_is_none(tmp_path: Path) -> None:
    whole = '<p id="here"><a href="#here">a</a> <code>odometry.recording.frames.Frame</code></p>'
    (tmp_path / "a.html").write_text(whole + "<code>odometry.csv</code>", encoding="utf-8")
    assert broken_references(tmp_path) == set()
