"""The odometer and the estimate of a result as trajectory files of other programs."""

from pathlib import Path

from odometry.export.source import ExportSource
from odometry.io.trajectory_files import write_trajectory
from odometry.trajectory import SpatialTrajectory

NAMES = ("odometer", "estimate")


def write(source: ExportSource, folder: Path, named: str) -> None:
    """Write both trajectories in a format of `odometry.io.trajectory_files`."""
    for name in NAMES:
        trajectory = SpatialTrajectory.from_plane(source.trajectory(name))
        write_trajectory(folder, name, trajectory, named)
