"""Trajectories as TUM text: stamp x y z qx qy qz qw, which evo and others read."""

import math
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.io.files import atomic_write
from odometry.spatial_trajectory import SpatialTrajectory
from odometry.trajectory import Trajectory

COLUMNS = ("stamp", "x", "y", "z", "qx", "qy", "qz", "qw")
LENGTH_TOLERANCE = 0.01  # of a quaternion: files with three digits pass, mixed columns rarely do


def write_tum(file: str | Path, trajectory: Trajectory) -> None:
    """Write a plane trajectory as TUM text, z = 0 and rotation about z."""
    write_spatial_tum(file, SpatialTrajectory.from_plane(trajectory))


def write_spatial_tum(file: str | Path, trajectory: SpatialTrajectory) -> None:
    """Write a trajectory as TUM text, unit quaternions with qw not negative."""
    columns = zip(
        trajectory.stamps_s, trajectory.positions_m, trajectory.quaternions_wxyz, strict=True
    )
    with atomic_write(Path(file)) as part, part.open("w", encoding="ascii") as stream:
        for stamp_s, (x, y, z), (qw, qx, qy, qz) in columns:
            stream.write(
                f"{stamp_s:.9f} {x:.12f} {y:.12f} {z:.12f} "
                f"{qx:.15f} {qy:.15f} {qz:.15f} {qw:.15f}\n"
            )


def read_tum(file: str | Path) -> Trajectory:
    """Read TUM text as a plane trajectory: x, y and the yaw of the quaternion.

    Raises
    ------
    TrajectoryError
        As `read_spatial_tum`.
    """
    return read_spatial_tum(file).plane


def read_spatial_tum(file: str | Path) -> SpatialTrajectory:
    """Read TUM text; a line that starts with # is a comment.

    Raises
    ------
    TrajectoryError
        If the file cannot be read or holds no pose; naming file and row where a row has not
        eight finite numbers, no unit quaternion, or a stamp that does not increase.
    """
    try:
        lines = Path(file).read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise TrajectoryError(f"{file}: cannot be read: {error}") from error
    rows: list[list[float]] = []
    for line, text in enumerate(lines, start=1):
        if text.strip() and not text.startswith("#"):
            values = _numbers(text.split(), f"{file}: row {line}")
            if rows and values[0] <= rows[-1][0]:
                raise TrajectoryError(
                    f"{file}: row {line}: stamp {values[0]!r} after {rows[-1][0]!r}; stamps must "
                    "increase strictly"
                )
            rows.append(values)
    if not rows:
        raise TrajectoryError(f"{file}: there is no pose in it")
    table = np.array(rows)
    return SpatialTrajectory(table[:, 0], se3.pose(table[:, 1:4], _rotations(table[:, 4:])))


def _numbers(words: list[str], where: str) -> list[float]:
    if len(words) != len(COLUMNS):
        raise TrajectoryError(f"{where}: {len(words)} numbers, expected 8: {' '.join(COLUMNS)}")
    values = []
    for name, word in zip(COLUMNS, words, strict=True):
        try:
            values.append(float(word))
        except ValueError:
            raise TrajectoryError(f"{where}, {name}: {word!r} is not a number") from None
        if not math.isfinite(values[-1]):
            raise TrajectoryError(f"{where}, {name}: {word!r}, expected a finite number")
    length = math.hypot(*values[4:])
    if abs(length - 1) > LENGTH_TOLERANCE:
        raise TrajectoryError(f"{where}: a quaternion of length {length:.6g}, expected 1")
    return values


def _rotations(quaternions_xyzw: FloatArray) -> FloatArray:
    return se3.rotation_from_quaternion_wxyz(np.roll(quaternions_xyzw, 1, axis=-1))
