"""What `camera` doubts of a mount that somebody stated: its units, signs and axes."""

import click

from odometry.checks.finding import Level
from odometry.run import Run
from terrain.calibration.mount_sources import MountSource
from terrain.checks.region_ahead import no_mount, region_ahead


def print_doubts(run: Run, source: MountSource) -> None:
    """Say what the check of a run would say of this mount, before it is in run.toml."""
    if source.fit is not None:
        return
    for finding in region_ahead(run, source.camera.to_table()):
        if finding.level is Level.WARNING:
            click.echo(f"Warning: {finding.line.partition(': ')[2]}", err=True)


def is_no_mount(source: MountSource) -> bool:
    """Whether the mount is one that no camera for the terrain has: degrees, mm, a look upwards."""
    return source.fit is None and no_mount(source.camera.to_table())
