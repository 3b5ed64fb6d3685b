"""`terrain-odometry batch`: many runs, on the cores of one machine or of many."""

import sys
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from terrain.cli.options import OUTPUT, processes_option, scheduler_option
from terrain.cli.verbs.run import run_options

if TYPE_CHECKING:
    from terrain.batch.batch import Batch
    from terrain.batch.job import Job
    from terrain.run_options import RunOptions


def _prepared(command: Callable[..., None]) -> Callable[..., None]:
    """Let a process import what replays need before this one does, which takes them both long."""

    @wraps(command)
    def early(*, folders: tuple[Path, ...], processes: int | None, **others: Any) -> None:
        from terrain.batch.batch import prepare

        if len(folders) > 1 and processes != 1 and others["scheduler"] is None:
            prepare()
        command(folders=folders, processes=processes, **others)

    return early


@click.command()
@click.argument(
    "folders", metavar="RUN...", nargs=-1, required=True, type=click.Path(path_type=Path)
)
@click.option("--out", required=True, metavar="DIR", type=OUTPUT, help="Folder for the results.")
@_prepared
@run_options
@processes_option
@scheduler_option
def batch(
    folders: tuple[Path, ...],
    *,
    out: Path,
    options: "RunOptions",
    processes: int | None,
    scheduler: str | None,
) -> None:
    """Replay many run folders RUN, each into its own folder of DIR as `run` would.

    Writes batch.csv with a row for each run, one page over all of them, and learned.toml, what
    they learned by terrain. A run that fails is a row that says why, and the exit code is then 1.
    The same command continues after an interrupt: finished runs are not replayed again. With
    --scheduler the runs and DIR have to lie on a path that all workers can read.

    \b
    Example:
      terrain-odometry batch recordings/* --parameters set.toml --out results
      terrain-odometry batch recordings/* --out /shared/results --scheduler tcp://host:8786
    """
    from joblib import cpu_count

    from odometry.outputs.manifest import check_finished
    from odometry.outputs.provenance import Input
    from odometry.parameters import ParameterSet, read_parameters
    from terrain.batch.batch import run_batch
    from terrain.cli.outputs import asked, require_apart

    said = asked(click.get_current_context())
    require_apart(out, (Input.of(role, path) for role, path in said.inputs))
    for file in options.files:
        check_finished(file)
    jobs = _jobs(_each_once(folders), out, options)
    done = run_batch(
        jobs,
        said,
        out,
        read_parameters(options.parameters) if options.parameters else ParameterSet(),
        processes=min(processes or cpu_count(), len(jobs)),
        scheduler=scheduler,
        show_progress=True,
    )
    _print(done, out)
    if any(row.error for row in done.rows):
        sys.exit(1)


def _each_once(folders: tuple[Path, ...]) -> list[Path]:
    """The folders without those that are given again: what they learned would count twice."""
    unique: dict[Path, Path] = {}
    for folder in folders:
        first = unique.setdefault(folder.resolve(), folder)
        if first is not folder:
            click.echo(f"Note: {folder} is given twice, and replayed once", err=True)
    return list(unique.values())


def _jobs(folders: list[Path], out: Path, options: "RunOptions") -> "list[Job]":
    from terrain.batch.batch import FILES
    from terrain.batch.job import Job
    from terrain.cli.outputs import asked, folder_names

    names = folder_names(folders, FILES)
    return [
        Job(name, folder.absolute(), (out / name).absolute(), asked(_of_run(folder)), far)
        for name, folder in zip(names, folders, strict=True)
        for far in [options.absolute()]
    ]


def _of_run(folder: Path) -> click.Context:
    """The command `run` with the options of this one, on one folder."""
    from terrain.cli.verbs.run import run

    given = click.get_current_context()
    context = click.Context(run)
    for parameter in run.params:
        name = str(parameter.name)
        is_folder = name == "run_folder"
        context.params[name] = folder if is_folder else given.params[name]
        source = given.get_parameter_source("folders" if is_folder else name)
        if source is not None:
            context.set_parameter_source(name, source)
    return context


def _print(done: "Batch", out: Path) -> None:
    from terrain.batch.words import cost, not_of_these, summary
    from terrain.cli.results import print_written

    for outcome in done.outcomes:
        if outcome.said and outcome.state != "failed":
            click.echo(f"Note: {outcome.job.name} is replayed again: {outcome.said}", err=True)
        if outcome.left_out:
            click.echo(f"Warning: {outcome.job.name}: {outcome.left_out}", err=True)
    for row in done.rows:
        if row.error:
            click.echo(f"{row.name}: failed: {row.error}")
    names = [row.name for row in done.rows]
    for sentence in (*summary(done), *cost(done), *done.learned.sentences):
        click.echo(sentence)
    for sentence in not_of_these(out, names):
        click.echo(f"Note: {sentence}", err=True)
    print_written(out)
    click.echo(f"Next: open {out / 'report.html'}, which links to the page of each run")
    if done.learned.terrains:
        click.echo(f"Next time: --parameters {out / 'learned.toml'} starts from what was learned")
