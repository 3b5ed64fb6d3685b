"""The inputs of a model from a recorded run."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.models.inputs import Inputs
from odometry.recording.repeated_speeds import between_new_values
from odometry.recording.run import Run
from odometry.recording.run_terrains import row_terrains
from odometry.tables.table import fill_gaps, level_where_missing
from odometry.windows.recorded.measured_poses import measured_poses, positions_at
from odometry.windows.recorded.turns import continuous_yaw


def inputs_of(run: Run) -> Inputs:
    """Inputs of a model at each row (N,) of odometry.csv.

    Empty cells of roll, pitch and accelerations are interpolated in time and held at the ends.
    Roll and pitch are level where they were not recorded; accelerations are None unless both
    were.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> odometry.inputs_of(run).tread_speeds_m_s.shape
    (1085, 2)
    """
    return inputs_with_poses(run, _heading(run), _position(run))


def inputs_with_poses(
    run: Run, heading_rad: FloatArray | None, position_m: FloatArray | None
) -> Inputs:
    """As `inputs_of`, with headings (N,) and positions (N, 2) that were found before, if any."""
    speeds = run.odometry.stack("v_left", "v_right")
    stamps_s = run.odometry.stamps_s
    return Inputs(
        speeds,
        *attitude_of(run),
        _accelerations(run),
        stamps_s - stamps_s[0],
        row_terrains(run),
        heading_rad,
        _wheel_angles(run),
        position_m=position_m,
        unrepeated_m_s=between_new_values(stamps_s, speeds),
    )


def attitude_of(run: Run) -> tuple[FloatArray, FloatArray]:
    """Roll and pitch (N,) at each row of odometry.csv, as `inputs_of` fills them."""
    roll, pitch = (
        level_where_missing(run.odometry.stamps_s, run.odometry.columns.get(name))
        for name in ("roll", "pitch")
    )
    return roll, pitch


def _accelerations(run: Run) -> FloatArray | None:
    columns = [run.odometry.columns.get(name) for name in ("accel_x", "accel_y")]
    recorded = [column for column in columns if column is not None and not np.isnan(column).all()]
    if len(recorded) < len(columns):
        return None
    return np.stack([fill_gaps(run.odometry.stamps_s, column) for column in recorded], axis=-1)


def _heading(run: Run) -> FloatArray | None:
    if run.pose is None:
        return None
    yaw = continuous_yaw(run)
    measured = np.isfinite(yaw)
    if not measured.any():
        return None
    return np.interp(run.odometry.stamps_s, run.pose.stamps_s[measured], yaw[measured])


def _position(run: Run) -> FloatArray | None:
    stamps_s, poses, _ = measured_poses(run)
    return positions_at(run.odometry.stamps_s, stamps_s, poses) if len(stamps_s) else None


def _wheel_angles(run: Run) -> FloatArray | None:
    radius = run.robot.wheel_radius
    if radius is None:
        return None
    speeds = run.odometry.stack("v_left", "v_right")
    steps_s = np.diff(run.odometry.stamps_s)[:, None]
    travel_m = np.concatenate([np.zeros((1, 2)), np.cumsum(speeds[:-1] * steps_s, axis=0)])
    return np.asarray(travel_m / radius)
