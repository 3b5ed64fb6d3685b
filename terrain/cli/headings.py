"""Runs without measured yaw, for the verbs that watch how the robot turns."""

from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from collections.abc import Sequence

    from odometry.run import Run


def with_turns(runs: "Sequence[Run]") -> "list[Run]":
    """Runs with a yaw, found from positions where a gyroscope measured the turns; says so.

    Raises
    ------
    RunFolderError
        If neither a yaw nor a yaw rate was measured on a run that has positions.
    """
    from odometry.errors import RunFolderError
    from odometry.positions.heading import headed, needs_heading

    for run in runs:
        if needs_heading(run) and run.yaw_rate is None:
            raise RunFolderError(
                f"{run.folder}: pose.csv has positions without yaw, and there is no gyroscope: how "
                "the robot turned was not measured; expected yaw in pose.csv, or gyro_z in imu.csv "
                "or odometry.csv"
            )
    found = headed(runs)
    for note in found.notes:
        click.echo(f"Note: {note}", err=True)
    return list(found.runs)
