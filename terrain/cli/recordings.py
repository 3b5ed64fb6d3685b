"""How the commands read run folders: the one place through which every recording comes."""

import math
from collections.abc import Callable, Sequence
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from odometry.checks.findings.finding import CheckReport
    from odometry.recording.run import Run
    from odometry.recording.run_span import Span


CHECKS = "terrain.checks"  # key of the reports in click's context


def span_options(command: Callable[..., None]) -> Callable[..., None]:
    """Add --from and --to, which cut every run that is read; the command gets them as `span`."""

    @click.option(
        "--from",
        "from_s",
        type=click.FloatRange(min=0),
        default=0.0,
        metavar="SECONDS",
        help="Use each run from here on, counted from its first stamp.  [default: its start]",
    )
    @click.option(
        "--to",
        "to_s",
        type=click.FloatRange(min=0, min_open=True),
        default=math.inf,
        metavar="SECONDS",
        help="Use each run up to here, counted from its first stamp.  [default: its end]",
    )
    @wraps(command)
    def with_span(*, from_s: float, to_s: float, **others: Any) -> None:
        from odometry.recording.run_span import Span

        if from_s >= to_s:
            raise click.UsageError(
                f"--from {from_s:g} --to {to_s:g}: expected an end after the start"
            )
        command(span=Span(from_s, to_s), **others)

    return with_span


def read_runs(folders: Sequence[Path], span: "Span") -> "list[Run]":
    """Read run folders in their order, each cut to the span and checked, at even stamps.

    Raises
    ------
    RunFolderError
        If a folder is not as the format says, cannot be used as it is, or nothing of it lies in
        the span.
    """
    return _at_even_stamps([read_run(folder, span) for folder in folders])


def _at_even_stamps(runs: "Sequence[Run]") -> "list[Run]":
    """Runs with even stamps of rows that came late by chance; says what was done."""
    from odometry.estimation.config import IcrEkfConfig
    from odometry.preparation.even_rows import with_even_rows

    found = [with_even_rows(run, IcrEkfConfig()) for run in runs]
    for run, events in found:
        for event in events:
            click.echo(f"Note: {run.folder}: {event.text}", err=True)
    return [run for run, _ in found]


def read_run(folder: Path, span: "Span", *, images: bool = False) -> "Run":
    """Read one run folder, cut to the span; say what its check finds, and remember it.

    Parameters
    ----------
    folder : Path
    span : Span
    images : bool
        Whether the camera and its images are checked as well.
    """
    from odometry.checks.findings.finding import Level
    from terrain.checks.recording import checked_run

    run, report = checked_run(folder, span, images=images)
    for finding in report.findings:
        said = "Warning" if finding.level is Level.WARNING else "Note"
        click.echo(f"{said}: {folder}: {finding.line.partition(': ')[2]}", err=True)
    context = click.get_current_context(silent=True)
    if context is not None:
        context.meta.setdefault(CHECKS, []).append(report)
    return run


def checks_made(folder: Path | None = None) -> "list[CheckReport]":
    """Reports of the runs that the command has read, or of the one in a folder."""
    found: list[CheckReport] = click.get_current_context().meta.get(CHECKS, [])
    return [report for report in found if folder in (None, report.folder)]


def with_turns(runs: "Sequence[Run]") -> "list[Run]":
    """Runs whose yaw was measured, or is found from positions and a gyroscope; says what was done.

    Their poses are those of the robot: a lever arm of `[sensors]` is undone, and stated no more.

    Positions without yaw are left out where velocity.csv alone measured how the robot turned.

    Raises
    ------
    RunFolderError
        If neither a yaw nor a yaw rate was measured on a run that has positions.
    """
    from odometry.effects.measurement.measured import robot_run

    return [robot_run(_with_turns(run), ()) for run in runs]


def with_yaw_rates(runs: "Sequence[Run]") -> "list[Run]":
    """The same for what compares yaw rates: positions that determine no yaw stay without one.

    A lever arm of `[sensors]` cannot be undone there, and such positions are not used.

    Raises
    ------
    RunFolderError
        See `with_turns`.
    """
    from odometry.effects.measurement.measured import robot_run

    return [robot_run(_with_yaw_rates(run), ()) for run in runs]


def _with_yaw_rates(run: "Run") -> "Run":
    from odometry.errors import OdometryError

    try:
        return _with_turns(run)
    except OdometryError as error:
        if run.yaw_rate is None:
            raise
        click.echo(
            f"Note: {error}. Yaw rates were measured, and velocity modes need no yaw: no heading "
            "confirms the gyroscope, and the forward speed is that of the treads",
            err=True,
        )
        return run


def _with_turns(run: "Run") -> "Run":
    from dataclasses import replace

    import numpy as np

    from odometry.errors import RunFolderError
    from odometry.positions.heading import found_heading, needs_heading

    if not needs_heading(run):
        return run
    if run.yaw_rate is not None:
        found = found_heading(run)
        click.echo(f"Note: {found.words}", err=True)
        return found.run
    if run.velocity is not None and np.isfinite(run.velocity["wz"]).any():
        click.echo(
            f"Note: {run.folder}: pose.csv has positions without yaw and is not used", err=True
        )
        return replace(run, pose=None)
    raise RunFolderError(
        f"{run.folder}: pose.csv has positions without yaw, and no yaw rate was measured: how the "
        "robot turned is not known; expected yaw in pose.csv, or gyro_z in imu.csv or odometry.csv"
    )
