"""Trajectories as TUM text: stamp x y z qx qy qz qw, which evo and others read."""

import math
from pathlib import Path

import numpy as np

from odometry.errors import TrajectoryError
from odometry.io.files import atomic_write
from odometry.trajectory import Trajectory


def write_tum(file: str | Path, trajectory: Trajectory) -> None:
    """Write a plane trajectory as TUM text, z = 0 and rotation about z."""
    half = trajectory.poses[:, 2] / 2
    with atomic_write(Path(file)) as part, part.open("w", encoding="ascii") as stream:
        for stamp_s, pose, angle in zip(trajectory.stamps_s, trajectory.poses, half, strict=True):
            stream.write(
                f"{stamp_s:.9f} {pose[0]:.12f} {pose[1]:.12f} 0 0 0 "
                f"{math.sin(angle):.15f} {math.cos(angle):.15f}\n"
            )


def read_tum(file: str | Path) -> Trajectory:
    """Read TUM text as a plane trajectory: x, y and the yaw of the quaternion.

    Raises
    ------
    TrajectoryError
        If the file cannot be read; naming file and row where a row has not eight numbers.
    """
    try:
        lines = Path(file).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise TrajectoryError(f"{file}: cannot be read: {error}") from error
    rows = []
    for line, text in enumerate(lines, start=1):
        if not text.strip() or text.startswith("#"):
            continue
        try:
            values = [float(word) for word in text.split()]
        except ValueError as error:
            raise TrajectoryError(f"{file}: row {line}: {error}") from None
        if len(values) != 8:
            raise TrajectoryError(f"{file}: row {line}: {len(values)} numbers, expected 8")
        rows.append(values)
    if not rows:
        raise TrajectoryError(f"{file}: there is no pose in it")
    table = np.array(rows)
    qx, qy, qz, qw = table[:, 4:].T
    yaw = np.arctan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy**2 + qz**2))
    return Trajectory(table[:, 0], np.column_stack([table[:, 1:3], yaw]))
