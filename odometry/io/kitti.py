"""Trajectories as KITTI text: twelve numbers a line, the first three rows of a 4 x 4 matrix.

The poses have no stamps: KITTI keeps them in a second file, `times.txt`, one number of seconds a
line (Geiger et al. 2012, CVPR, and the development kit of the odometry benchmark).
"""

from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.io.csv_columns import LARGEST, LARGEST_BY_NAME
from odometry.io.files import atomic_write
from odometry.io.number_rows import Column, read_rows, require_increasing
from odometry.trajectory import SpatialTrajectory

COLUMNS = tuple(
    Column(f"r{row}{column}", LARGEST) if column < 4 else Column(f"t{row}", LARGEST_BY_NAME["x"])
    for row in (1, 2, 3)
    for column in (1, 2, 3, 4)
)
TIMES = (Column("time", LARGEST_BY_NAME["t"]),)
ROTATION_TOLERANCE = 0.01  # of R R^T from the identity, as of the length of a quaternion


def read_kitti(file: str | Path, times: str | Path) -> SpatialTrajectory:
    """Read poses and the file of their stamps, in the axes that the file has.

    Raises
    ------
    TrajectoryError
        If a file cannot be read or is empty, or they have not as many rows; naming file and row
        where numbers are missing or not finite, a stamp does not increase, or a matrix is no
        rotation.
    """
    file, times = Path(file), Path(times)
    rows, table = read_rows(file, COLUMNS)
    time_rows, stamps_s = read_rows(times, TIMES)
    if len(stamps_s) != len(table):
        raise TrajectoryError(
            f"{times}: {len(stamps_s)} stamps, but {file} has {len(table)} poses; expected one a "
            "pose"
        )
    require_increasing(stamps_s[:, 0], time_rows, times)
    matrices = table.reshape(-1, 3, 4)
    rotations = _rotations(matrices[:, :, :3], rows, file)
    return SpatialTrajectory(stamps_s[:, 0], se3.pose(matrices[:, :, 3], rotations))


def write_kitti(file: str | Path, times: str | Path, trajectory: SpatialTrajectory) -> None:
    """Write poses, in the axes that they have, and the file of their stamps."""
    matrices = trajectory.poses[:, :3].reshape(-1, 12)
    _write_rows(Path(file), matrices, ".17g")
    _write_rows(Path(times), trajectory.stamps_s[:, None], ".9f")


def _rotations(matrices: FloatArray, rows: IntArray, file: Path) -> FloatArray:
    """The rotations (N, 3, 3) nearest to matrices that are rotations but for rounding."""
    off = np.abs(matrices @ np.swapaxes(matrices, 1, 2) - np.eye(3)).max(axis=(1, 2))
    wrong = np.flatnonzero((off > ROTATION_TOLERANCE) | (np.linalg.det(matrices) < 0))
    if wrong.size:
        raise TrajectoryError(
            f"{file}: row {rows[wrong[0]]}: r11 to r33 are no rotation matrix; expected the first "
            "three rows of a 4 x 4 pose"
        )
    u, _, v_transposed = np.linalg.svd(matrices)
    return np.asarray(u @ v_transposed)


def _write_rows(file: Path, table: FloatArray, digits: str) -> None:
    with atomic_write(file) as part, part.open("w", encoding="ascii") as stream:
        for row in table.tolist():
            stream.write(" ".join(format(number, digits) for number in row) + "\n")
