"""Trajectories as EuRoC tables: nanoseconds, position, quaternion w first, comma separated.

`state_groundtruth_estimate0/data.csv` of that data set has velocities and biases after these
eight columns (Burri et al. 2016, IJRR 35(10)); they are left out. A stamp becomes the nearest
float64 of seconds: up to 97 days from zero each nanosecond is another number, and stamps counted
from 1970 keep 240 ns. Written is the whole nanosecond nearest to that number.
"""

from decimal import Decimal
from pathlib import Path

from odometry.io.csv_columns import LARGEST, LARGEST_BY_NAME
from odometry.io.files import atomic_write
from odometry.io.number_rows import Column, poses_of, read_rows, require_increasing
from odometry.trajectory import SpatialTrajectory

NANOSECONDS = 10**9  # in a second


def seconds(word: str) -> float:
    """The float64 nearest to a whole number of nanoseconds; ValueError for any other word."""
    return int(word) / NANOSECONDS  # Python's division of integers rounds once


def nanoseconds(stamp_s: float) -> int:
    """The whole number of nanoseconds nearest to a stamp."""
    return int((Decimal(stamp_s) * NANOSECONDS).to_integral_value())


HEADER = (
    "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], "
    "q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z []"
)


COLUMNS = (
    Column("timestamp", LARGEST_BY_NAME["t"] / NANOSECONDS, seconds),
    *(Column(f"p_{name}", LARGEST_BY_NAME[name]) for name in ("x", "y", "z")),
    *(Column(f"q_{name}", LARGEST) for name in ("w", "x", "y", "z")),
)


def read_euroc(file: str | Path) -> SpatialTrajectory:
    """Read an EuRoC table; a line that starts with # is a comment.

    Raises
    ------
    TrajectoryError
        If the file cannot be read or holds no pose; naming file and row where a row has not eight
        finite numbers, a stamp that is no whole number of nanoseconds or does not increase, or no
        unit quaternion.
    """
    file = Path(file)
    rows, table = read_rows(file, COLUMNS, ",", more=True)
    poses = poses_of(table[:, 1:4], table[:, 4:], rows, file)
    require_increasing(table[:, 0], rows, file)
    return SpatialTrajectory(table[:, 0], poses)


def write_euroc(file: str | Path, trajectory: SpatialTrajectory) -> None:
    """Write a trajectory as an EuRoC table, unit quaternions with w not negative."""
    columns = zip(
        trajectory.stamps_s.tolist(),
        trajectory.positions_m,
        trajectory.quaternions_wxyz,
        strict=True,
    )
    with atomic_write(Path(file)) as part, part.open("w", encoding="ascii") as stream:
        stream.write(f"{HEADER}\n")
        for stamp_s, position, quaternion in columns:
            numbers = [f"{value:.12f}" for value in position]
            numbers += [f"{value:.15f}" for value in quaternion]
            stream.write(f"{nanoseconds(stamp_s)},{','.join(numbers)}\n")
