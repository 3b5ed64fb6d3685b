"""Trajectories as TUM text: stamp x y z qx qy qz qw, which evo and others read."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from odometry.blocks import blocks_of
from odometry.io.csv_columns import LARGEST, LARGEST_BY_NAME
from odometry.io.files import atomic_write
from odometry.io.number_rows import Column, poses_of, read_rows, require_increasing
from odometry.trajectory import SpatialTrajectory, Trajectory

COLUMNS = (
    Column("stamp", LARGEST_BY_NAME["t"]),
    *(Column(name, LARGEST_BY_NAME[name]) for name in ("x", "y", "z")),
    *(Column(name, LARGEST) for name in ("qx", "qy", "qz", "qw")),
)


def write_tum(file: str | Path, trajectory: Trajectory) -> None:
    """Write a plane trajectory as TUM text, z = 0 and rotation about z.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import numpy as np
    >>> import odometry
    >>> poses = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.1]])
    >>> path = odometry.Trajectory(np.array([0.0, 1.0]), poses)
    >>> with TemporaryDirectory() as folder:
    ...     odometry.write_tum(f"{folder}/path.tum", path)
    ...     print(len(odometry.read_tum(f"{folder}/path.tum")))
    2
    """
    _write(
        file,
        (
            SpatialTrajectory.from_plane(trajectory.rows(rows))
            for rows in blocks_of(len(trajectory))
        ),
    )


def write_spatial_tum(file: str | Path, trajectory: SpatialTrajectory) -> None:
    """Write a trajectory as TUM text, unit quaternions with qw not negative.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import numpy as np
    >>> import odometry
    >>> still = odometry.SpatialTrajectory(np.array([0.0]), np.eye(4)[None])
    >>> with TemporaryDirectory() as folder:
    ...     odometry.write_spatial_tum(f"{folder}/path.tum", still)
    ...     print(odometry.read_spatial_tum(f"{folder}/path.tum").poses[0, 3])
    [0. 0. 0. 1.]
    """
    _write(file, [trajectory])


def _write(file: str | Path, parts: Iterable[SpatialTrajectory]) -> None:
    with atomic_write(Path(file)) as part, part.open("w", encoding="ascii") as stream:
        for of in parts:
            columns = of.stamps_s, of.positions_m, of.quaternions_wxyz
            rows = zip(*(column.tolist() for column in columns), strict=True)
            for stamp_s, (x, y, z), (qw, qx, qy, qz) in rows:
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

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import numpy as np
    >>> import odometry
    >>> poses = np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.1]])
    >>> path = odometry.Trajectory(np.array([0.0, 1.0]), poses)
    >>> with TemporaryDirectory() as folder:
    ...     odometry.write_tum(f"{folder}/path.tum", path)
    ...     print(odometry.read_tum(f"{folder}/path.tum").poses.round(6).tolist())
    [[0.0, 0.0, 0.0], [0.5, 0.0, 0.1]]
    """
    return read_spatial_tum(file).plane


def read_spatial_tum(file: str | Path) -> SpatialTrajectory:
    """Read TUM text; a line that starts with # is a comment.

    Raises
    ------
    TrajectoryError
        If the file cannot be read or holds no pose; naming file and row where a row has not
        eight finite numbers, no unit quaternion, or a stamp that does not increase.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import numpy as np
    >>> import odometry
    >>> still = odometry.Trajectory(np.zeros(1), np.ones((1, 3)))
    >>> with TemporaryDirectory() as folder:
    ...     odometry.write_tum(f"{folder}/path.tum", still)
    ...     print(odometry.read_spatial_tum(f"{folder}/path.tum").poses[0, :3, 3])  # x, y, z [m]
    [1. 1. 0.]
    """
    file = Path(file)
    rows, table = read_rows(file, COLUMNS)
    poses = poses_of(table[:, 1:4], np.roll(table[:, 4:], 1, axis=1), rows, file)
    require_increasing(table[:, 0], rows, file)
    return SpatialTrajectory(table[:, 0], poses)
