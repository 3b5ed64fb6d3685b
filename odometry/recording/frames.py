"""The files of a run merged in time order: frames."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from odometry.arrays import ByteImage, FloatArray, IntArray
from odometry.blocks import blocks_of
from odometry.recording.sensors import Gyroscope
from odometry.tables.table import Table

POSE_COLUMNS = ("x", "y", "yaw")
VELOCITY_COLUMNS = ("vx", "vy", "wz")


@dataclass(frozen=True)
class Frame:
    """All measurements of a run at one stamp.

    Attributes
    ----------
    stamp_s : float
    tread_speeds_m_s : (2,)
        (left, right), in force from this stamp to the next; NaN before the first row of
        odometry and after its last has run out.
    odometry_row : int
        Row of `Run.odometry` in force, -1 before the first.
    pose : (3,) or None
        Measured x, y, yaw in the reference frame at this stamp; NaN for what was not measured.
    image : Path, (H, W) or (H, W, 3) of uint8, or None
        The image taken at this stamp: a file, which is opened only where it is needed, or grey or
        RGB pixels.
    in_gap : bool
        Whether the speeds that led to this frame are not known: odometry.csv has a gap there.
    yaw_rate_rad_s : float
        Mean of the gyroscope's yaw rate since the frame before; NaN where not measured.
    velocity : (3,) or None
        Measured v_x, v_y [m/s], omega [rad/s] at this stamp; NaN for what was not measured.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> first = next(run.frames())
    >>> first.stamp_s, first.image.name, first.pose.shape
    (0.0, '000000.jpg', (3,))
    """

    stamp_s: float
    tread_speeds_m_s: FloatArray
    odometry_row: int
    pose: FloatArray | None
    image: Path | ByteImage | None
    in_gap: bool = False
    yaw_rate_rad_s: float = math.nan
    velocity: FloatArray | None = None


def merged_frames(
    odometry: Table,
    pose: Table | None,
    velocity: Table | None,
    images: Table | None,
    *,
    gyroscope: Gyroscope | None,
    folder: Path,
) -> Iterator[Frame]:
    """Merge the stamps of odometry, pose, velocity and images in time order.

    Equal stamps make one frame. A tread speed holds until the next stamp; the last one holds for
    the median odometry period, whose end is a frame of its own where other stamps lie beyond.
    The gyroscope is integrated from frame to frame; its stamps make no frames.
    """
    odometry_s = odometry.stamps_s
    period_s = float(np.median(np.diff(odometry_s))) if len(odometry_s) > 1 else 0.0
    pose_s, poses = _stamps_and_values(pose, POSE_COLUMNS)
    velocity_s, velocities = _stamps_and_values(velocity, VELOCITY_COLUMNS)
    image_s = images.stamps_s if images is not None else np.empty(0)
    end_s = odometry_s[-1] + period_s
    stamps_s = np.unique(np.concatenate([odometry_s, pose_s, velocity_s, image_s]))
    if stamps_s[-1] > end_s:
        stamps_s = np.unique(np.append(stamps_s, end_s))
    unknown = np.full(2, math.nan)
    for some in blocks_of(len(stamps_s)):
        here_s = stamps_s[some]
        odometry_row = np.searchsorted(odometry_s, here_s, side="right") - 1
        speeds = np.column_stack([odometry[n][odometry_row] for n in ("v_left", "v_right")])
        pose_row, velocity_row, image_row = (
            _row_at(table_s, here_s) for table_s in (pose_s, velocity_s, image_s)
        )
        yaw_rates = np.full(len(here_s), math.nan)
        if gyroscope is not None:
            from_s = stamps_s[max(some.start - 1, 0) : some.stop]
            yaw_rates = gyroscope.mean_rates_rad_s(from_s)[-len(here_s) :]
        for i, stamp_s in enumerate(here_s.tolist()):
            row = int(odometry_row[i])
            image = None
            if images is not None and image_row[i] >= 0:
                image = folder / str(images["file"][image_row[i]])
            yield Frame(
                stamp_s=stamp_s,
                tread_speeds_m_s=speeds[i] if row >= 0 and stamp_s < end_s else unknown,
                odometry_row=row,
                pose=poses[pose_row[i]] if pose_row[i] >= 0 else None,
                image=image,
                yaw_rate_rad_s=float(yaw_rates[i]),
                velocity=velocities[velocity_row[i]] if velocity_row[i] >= 0 else None,
            )


def _stamps_and_values(
    table: Table | None, names: tuple[str, ...]
) -> tuple[FloatArray, FloatArray]:
    if table is None:
        return np.empty(0), np.empty((0, len(names)))
    return table.stamps_s, table.stack(*names)


def _row_at(table_s: FloatArray, stamps_s: FloatArray) -> IntArray:
    """Row of a table at exactly each stamp, -1 where it has none."""
    if not len(table_s):
        return np.full(len(stamps_s), -1)
    rows = np.minimum(np.searchsorted(table_s, stamps_s), len(table_s) - 1)
    return np.where(table_s[rows] == stamps_s, rows, -1)
