"""Build the pages of the public names and of the command line, into `site` or another folder.

    python -m tests.make_docs [FOLDER]

A warning, or a reference in a docstring that points to nothing, is an error.
"""

import importlib
import inspect
import re
import shutil
import sys
import tempfile
import typing
import warnings
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from html import unescape
from pathlib import Path
from types import FunctionType
from unittest.mock import patch

import click
import pdoc
from numpy.typing import ArrayLike
from pdoc.doc_types import resolve_annotations

from odometry import arrays
from terrain.cli.main import VERBS, cli
from tests.public_names import PUBLIC
from tests.site_first_page import PICTURE, first_page

ROOT = Path(__file__).parents[1]
TEMPLATES = ROOT / "tests" / "page_templates"
PACKAGES = ("odometry", "terrain")
COLUMNS = 88  # of the help of a verb
spelled_out = inspect.formatannotation
ARRAYS = {  # as signatures spell them out, and what the packages call them
    spelled_out(value): name
    for name, value in vars(arrays).items()
    if typing.get_origin(value) is not None
} | {spelled_out(ArrayLike): "ArrayLike"}


def is_ours(value: object) -> bool:
    return str(getattr(value, "__module__", "")).split(".")[0] in PACKAGES


def classes_in(annotation: object) -> Iterator[type]:
    """Our classes that an annotation names."""
    if inspect.isclass(annotation) and is_ours(annotation):
        yield annotation
    parts = annotation if isinstance(annotation, list) else typing.get_args(annotation)
    for part in parts:
        yield from classes_in(part)


def functions_of(value: object) -> Iterator[FunctionType]:
    """A function itself; of a class its constructor, public methods and properties."""
    if inspect.isfunction(value):
        yield value
    elif inspect.isclass(value):
        for name, member in vars(value).items():
            plain = getattr(member, "fget", None) or getattr(member, "__func__", member)
            if inspect.isfunction(plain) and (not name.startswith("_") or name == "__init__"):
                yield plain


def named_by(value: object) -> Iterator[type]:
    """Our classes that its signature, its fields or its bases name."""
    annotated = [*functions_of(value), *([value] if inspect.isclass(value) else [])]
    for each in annotated:
        given, module = inspect.get_annotations(each), sys.modules[each.__module__]
        for annotation in resolve_annotations(given, module, None, each.__qualname__).values():
            yield from classes_in(annotation)
    if inspect.isclass(value):
        yield from filter(is_ours, value.__mro__[1:])


def pages() -> list[str]:
    """Modules with a page: the public ones, and those of all that public names lead to."""
    waiting: list[object] = [
        getattr(importlib.import_module(module), name)
        for module, names in PUBLIC.items()
        for name in names
    ]
    reached: set[type] = set()
    while waiting:
        new = set(named_by(waiting.pop())) - reached
        reached |= new
        waiting += new
    return sorted({*PUBLIC, *(each.__module__ for each in reached)})


def helps() -> Iterator[tuple[str, str]]:
    """Every verb and the text of its `--help`."""
    for verb in VERBS:
        command = cli.get_command(click.Context(cli), verb)
        if command is None:
            raise click.UsageError(f"the verb {verb!r} has no command")
        context = click.Context(
            command, info_name=f"terrain-odometry {verb}", terminal_width=COLUMNS
        )
        yield verb, command.get_help(context)


def command_line() -> str:
    """The page of the command line, in Markdown."""
    top = cli.get_help(click.Context(cli, info_name="terrain-odometry", terminal_width=COLUMNS))
    texts = [("terrain-odometry", top), *helps()]
    return "The command `terrain-odometry`.\n\n" + "\n".join(
        f"## {name}\n```\n{text}\n```\n" for name, text in texts
    )


def short_annotation(annotation: object) -> str:
    text = spelled_out(annotation)
    for spelled, name in ARRAYS.items():
        text = text.replace(spelled, name)
    return text


def broken_references(folder: Path) -> set[str]:
    """Links to pages or places that are not there, and names in docstrings that do not exist."""
    texts = {page: without_scripts(page) for page in folder.rglob("*.html")}
    places = {page: set(re.findall(r'\bid="([^"]+)"', text)) for page, text in texts.items()}
    found = set()
    for page, text in texts.items():
        for link in re.findall(r'href="([^":]*)"', text):
            name, _, place = unescape(link).partition("#")
            target = (page.parent / name).resolve() if name else page
            if target not in texts or (place and place not in places[target]):
                found.add(f"{page.relative_to(folder)}: {link}")
        unlinked = re.findall(r"<code>((?:odometry|terrain)(?:\.\w+)+)</code>", text)
        found |= {f"{page.relative_to(folder)}: {name}" for name in missing(unlinked)}
    return found


def without_scripts(page: Path) -> str:
    return re.sub(r"<script.*?</script>", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)


def missing(names: Iterable[str]) -> set[str]:
    """Dotted names that are neither a file of a run folder nor to be found."""
    files = (".csv", ".toml", ".model")
    return {name for name in set(names) if not name.endswith(files) and not exists(name)}


def exists(name: str) -> bool:
    owner, _, last = name.rpartition(".")
    try:
        importlib.import_module(name)
    except ImportError:
        return bool(owner) and exists(owner) and hasattr(importlib.import_module(owner), last)
    return True


def make_docs(folder: Path) -> None:
    """Write the site; an error names what points to nothing."""
    modules = pages()
    pdoc.render.configure(docformat="numpy", show_source=False, template_directory=TEMPLATES)
    pdoc.render.env.globals["first_page"] = first_page()
    with ExitStack() as stack:
        scratch = stack.enter_context(tempfile.TemporaryDirectory())
        stack.enter_context(warnings.catch_warnings())
        warnings.simplefilter("error")
        stack.enter_context(patch("inspect.formatannotation", short_annotation))
        stack.enter_context(patch("pdoc.doc.formatannotation", short_annotation))
        reference = Path(scratch) / "command_line.py"
        reference.write_text(f"{command_line()!r}\n", encoding="utf-8")
        pdoc.pdoc(*modules, str(reference), output_directory=folder)
    shutil.copy(ROOT / PICTURE, folder)
    broken = broken_references(folder.resolve())
    if broken:
        raise ValueError("references to nothing:\n" + "\n".join(sorted(broken)))


if __name__ == "__main__":
    make_docs(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "site")
