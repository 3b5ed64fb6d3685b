"""Trajectories as TUM text: stamp x y z qx qy qz qw, which evo and others read."""

from itertools import islice
from pathlib import Path

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.errors import TrajectoryError
from odometry.geometry import se3
from odometry.io.csv_columns import LARGEST, LARGEST_BY_NAME
from odometry.io.files import atomic_write
from odometry.io.input_file import opened_lines
from odometry.spatial_trajectory import SpatialTrajectory
from odometry.trajectory import Trajectory

COLUMNS = ("stamp", "x", "y", "z", "qx", "qy", "qz", "qw")
LARGEST_VALUES = [LARGEST_BY_NAME[name] for name in ("t", "x", "y", "z")] + 4 * [LARGEST]
BLOCK_ROWS = 1000
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
    file = Path(file)
    with opened_lines(file, TrajectoryError) as texts:
        poses = ((row, text.split()) for row, text in enumerate(texts, 1) if _is_pose(text))
        parts = []
        while block := list(islice(poses, BLOCK_ROWS)):
            parts.append(_block(block, file))
    if not parts:
        raise TrajectoryError(f"{file}: there is no pose in it")
    rows, table = (np.concatenate(part) for part in zip(*parts, strict=True))
    _check_increasing(table[:, 0], rows, file)
    return SpatialTrajectory(table[:, 0], se3.pose(table[:, 1:4], _rotations(table[:, 4:])))


def _is_pose(text: str) -> bool:
    return bool(text.strip()) and not text.startswith("#")


def _block(block: list[tuple[int, list[str]]], file: Path) -> tuple[IntArray, FloatArray]:
    """Rows (N,) of the file and their numbers (N, 8), checked."""
    for row, words in block:
        if len(words) != len(COLUMNS):
            raise TrajectoryError(
                f"{file}: row {row}: {len(words)} numbers, expected 8: {' '.join(COLUMNS)}"
            )
    try:
        table = np.array([list(map(float, words)) for _, words in block])
    except ValueError:
        _refuse_words(block, file)
        raise
    wrong = ~(np.abs(table) <= LARGEST_VALUES)
    if wrong.any():
        first, column = np.argwhere(wrong)[0]
        row, words = block[first]
        raise TrajectoryError(
            f"{file}: row {row}, {COLUMNS[column]}: {words[column]!r}, expected a finite number, "
            f"at most {LARGEST_VALUES[column]:g} in size"
        )
    lengths = np.linalg.norm(table[:, 4:], axis=1)
    off = np.flatnonzero(np.abs(lengths - 1) > LENGTH_TOLERANCE)
    if off.size:
        raise TrajectoryError(
            f"{file}: row {block[off[0]][0]}: a quaternion of length {lengths[off[0]]:.6g}, "
            "expected 1"
        )
    return np.array([row for row, _ in block]), table


def _refuse_words(block: list[tuple[int, list[str]]], file: Path) -> None:
    for row, words in block:
        for name, word in zip(COLUMNS, words, strict=True):
            try:
                float(word)
            except ValueError:
                raise TrajectoryError(
                    f"{file}: row {row}, {name}: {word!r} is not a number"
                ) from None


def _check_increasing(stamps_s: FloatArray, rows: IntArray, file: Path) -> None:
    back = np.flatnonzero(np.diff(stamps_s) <= 0)
    if back.size:
        before, after = float(stamps_s[back[0]]), float(stamps_s[back[0] + 1])
        raise TrajectoryError(
            f"{file}: row {rows[back[0] + 1]}: stamp {after!r} after {before!r}; stamps must "
            "increase strictly"
        )


def _rotations(quaternions_xyzw: FloatArray) -> FloatArray:
    return se3.rotation_from_quaternion_wxyz(np.roll(quaternions_xyzw, 1, axis=-1))
