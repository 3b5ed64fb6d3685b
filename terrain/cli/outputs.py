"""Where the commands write: claimed before any work, with what made it."""

import shlex
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from terrain.cli.recordings import checks_made

if TYPE_CHECKING:
    from odometry.outputs.output_folder import OutputFolder
    from odometry.outputs.provenance import Asked, Input, Made


def folder_names(folders: Sequence[Path], taken: Iterable[str] = ()) -> list[str]:
    """Name each after its run; a name that comes again, or is taken, gets a number."""
    used, names = set(taken), []
    for folder in folders:
        first = folder.resolve().name
        name, count = first, 1
        while name in used:
            count += 1
            name = f"{first}_{count}"
        used.add(name)
        names.append(name)
    return names


WHOLE: list[Path] = []  # folders and files that this process has written to their end
OUTPUTS = ("out", "picture", "ros")  # options that name what a command writes
NO_MATTER = (*OUTPUTS, "processes", "scheduler")  # where it is written, and who computes it


def claim_folder(out: Path, *, reads_images: bool = False) -> "OutputFolder":
    """Claim the folder `--out` for the command that runs; see `odometry.outputs`.

    Raises
    ------
    OutputError
        If `--out` is or holds an input, or holds what another program or command made, or an
        input is unfinished.
    """
    from odometry.outputs.output_folder import claim_folder as claim

    inputs = _inputs(click.get_current_context())
    require_apart(out, inputs)
    claimed = claim(out, made_by(inputs, reads_images=reads_images))
    return replace(claimed, when_whole=WHOLE.append)


def require_apart(out: Path, inputs: "Iterable[Input]") -> None:
    """Raise OutputError if `--out` is or holds an input."""
    from odometry.errors import OutputError

    place = out.resolve()
    for one in inputs:
        folders = {file.parent.resolve() for file in (*one.files, *one.images, one.path)}
        named = {one.path.resolve(), *folders}
        if any(place == path or place in path.parents for path in named):
            raise OutputError(
                f"--out {out} is or holds the input {one.path}; choose another folder"
            )


def claim_file(out: Path, is_own: Callable[[Path], bool]) -> "Made":
    """Claim the file `--out` for the command that runs; what made it is returned.

    Raises
    ------
    OutputError
        If `--out` is an input or a file of one, or is there and `is_own` denies it, or an input
        is unfinished.
    """
    from odometry.errors import OutputError
    from odometry.outputs.output_file import claim_file as claim

    context = click.get_current_context()
    inputs = _inputs(context)
    place = out.resolve()
    for one in inputs:
        if any(place == file.resolve() for file in (one.path, *one.files)):
            raise OutputError(
                f"--out {out} is the input {one.path}, or a file of it; choose another file"
            )
    claim(out, is_own, _verb(context))
    return made_by(inputs)


def claim_picture(picture: Path) -> None:
    """Claim the file `--picture` for the command that runs.

    Raises
    ------
    OutputError
        If it is there and the same command did not draw it.
    """
    from odometry.outputs.output_file import claim_file as claim
    from odometry.outputs.output_file import is_picture_of

    verb = _verb(click.get_current_context())
    claim(picture, is_picture_of(verb), verb)


def about(made: "Made", folder: Path | None = None) -> dict[str, Any]:
    """What the commands add to a result file: what made it, and what its runs' checks found.

    Parameters
    ----------
    made : Made
    folder : Path, optional
        The one run of the result; else it is of all that were read.
    """
    from odometry.outputs.provenance import about_result

    return about_result(made, [report.to_table() for report in checks_made(folder)])


def comment(made: "Made") -> str:
    """The same as comment lines of TOML, warnings of the check alone."""
    from odometry.checks.findings.finding import Level

    lines = [
        f"# check of {report.name}: {' '.join(finding.line.split())}\n"
        for report in checks_made()
        for finding in report.at(Level.WARNING)
    ]
    return made.to_comment() + "".join(lines)


def made_by(inputs: "list[Input]", *, reads_images: bool = False) -> "Made":
    """Verb, command and settings of the command that runs, and the sums of its inputs."""
    from odometry.outputs.provenance import Made, installed_packages

    said = asked(click.get_current_context())
    sums = [(i.role, str(i.path), i.sha256(with_images=reads_images)) for i in inputs]
    return Made(said.verb, said.command, said.settings, tuple(sums), installed_packages())


def asked(context: click.Context) -> "Asked":
    """Verb, command, settings and named inputs of a command."""
    from odometry.outputs.provenance import Asked

    parameters = [p for p in context.command.params if p.name not in NO_MATTER]
    settings = {
        str(parameter.name): [v for v in _values(context, parameter) if _path(v) is None]
        for parameter in parameters
    }
    inputs = [
        (_role(parameter), path)
        for parameter in parameters
        for path in map(_path, _values(context, parameter))
        if path is not None
    ]
    return Asked(_verb(context), _command(context), settings, tuple(inputs), Path.cwd())


def _verb(context: click.Context) -> str:
    return str(context.command.name)


def _inputs(context: click.Context) -> "list[Input]":
    """Files and folders that the command names, of no unfinished output."""
    from odometry.outputs.manifest import check_finished
    from odometry.outputs.provenance import Input

    named = asked(context).inputs
    for _, path in named:
        check_finished(path)
    return [Input.of(role, path) for role, path in named]


def _path(value: object) -> Path | None:
    """The path that a value names, None where it is a name or a number."""
    if isinstance(value, Path):
        return value
    if isinstance(value, str) and value.endswith(".toml"):
        return Path(value)
    return None


def _values(context: click.Context, parameter: click.Parameter) -> list[Any]:
    value = context.params.get(str(parameter.name))
    if value is None:
        return []
    return list(value) if isinstance(value, tuple) else [value]


def _role(parameter: click.Parameter) -> str:
    if isinstance(parameter, click.Option):
        return parameter.opts[-1]
    return (parameter.metavar or str(parameter.name)).rstrip(".")


def _command(context: click.Context) -> str:
    """The command as it was given, outputs left out."""
    words = ["terrain-odometry", _verb(context)]
    for parameter in context.command.params:
        given = context.get_parameter_source(str(parameter.name)) == ParameterSource.COMMANDLINE
        if given and parameter.name not in NO_MATTER:
            words += _words(parameter, _values(context, parameter))
    return shlex.join(words)


def _words(parameter: click.Parameter, values: list[Any]) -> Iterator[str]:
    said = [str(value) for value in values]
    if not isinstance(parameter, click.Option):
        yield from said
    elif parameter.is_flag:
        yield parameter.opts[-1]
    elif parameter.multiple:
        for value in said:
            yield from (parameter.opts[-1], value)
    else:  # one word, or as many as the option takes; of COLSxROWS both numbers in one
        words = said if parameter.nargs > 1 else ["x".join(said)]
        yield from (parameter.opts[-1], *words)
