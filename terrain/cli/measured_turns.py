"""Runs without measured yaw, for the verbs that watch how the robot turns."""

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from collections.abc import Sequence

    from odometry.run import Run


def with_turns(runs: "Sequence[Run]") -> "list[Run]":
    """Runs whose yaw was measured, or is found from positions and a gyroscope; says what was done.

    Their poses are those of the robot: a lever arm of `[sensors]` is undone, and stated no more.

    Positions without yaw are left out where velocity.csv alone measured how the robot turned.

    Raises
    ------
    RunFolderError
        If neither a yaw nor a yaw rate was measured on a run that has positions.
    """
    from odometry.effects.measured import robot_run

    return [robot_run(_with_turns(run), ()) for run in runs]


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
