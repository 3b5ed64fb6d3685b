"""How the commands read run folders: the one place through which every recording comes."""

import math
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from odometry.checks.finding import CheckReport
    from odometry.run import Run
    from odometry.run_span import Span

CHECKS = "terrain.checks"  # key of the reports in click's context


def span_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add --from and --to, which cut every run that is read; the command gets them as `span`."""

    @click.option(
        "--from",
        "from_s",
        type=click.FloatRange(min=0),
        default=0.0,
        metavar="SECONDS",
        help="Leave out what each run holds before, from its first stamp.  [default: its start]",
    )
    @click.option(
        "--to",
        "to_s",
        type=click.FloatRange(min=0, min_open=True),
        default=math.inf,
        metavar="SECONDS",
        help="Leave out what each run holds after.  [default: its end]",
    )
    @wraps(command)
    def with_span(*, from_s: float, to_s: float, **others: Any) -> None:
        from odometry.run_span import Span

        if from_s >= to_s:
            raise click.UsageError(
                f"--from {from_s:g} --to {to_s:g}: expected an end after the start"
            )
        command(span=Span(from_s, to_s), **others)

    return with_span


def read_runs(folders: Sequence[Path], span: "Span") -> "list[Run]":
    """Read run folders in their order, each cut to the span and checked.

    Raises
    ------
    RunFolderError
        If a folder is not as the format says, cannot be used as it is, or nothing of it lies in
        the span.
    """
    return [read_run(folder, span) for folder in folders]


def read_run(folder: Path, span: "Span", *, images: bool = False) -> "Run":
    """Read one run folder, cut to the span; say what its check finds, and remember it.

    Parameters
    ----------
    folder : Path
    span : Span
    images : bool
        Whether the camera and its images are checked as well.
    """
    from odometry.checks.finding import Level
    from terrain.checks.checked_run import checked_run

    run, report = checked_run(folder, span, images=images)
    for finding in report.findings:
        said = "Warning" if finding.level is Level.WARNING else "Note"
        click.echo(f"{said}: {folder}: {finding.line.partition(': ')[2]}", err=True)
    context = click.get_current_context(silent=True)
    if context is not None:
        context.meta.setdefault(CHECKS, []).append(report)
    return run


def checks_made() -> "list[CheckReport]":
    """Reports of the runs that the command has read."""
    found: list[CheckReport] = click.get_current_context().meta.get(CHECKS, [])
    return found
