"""What a bank of filters is fed with: inputs that hold from stamp to stamp, and measurements."""

from dataclasses import dataclass, field

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import RunFolderError
from odometry.modes.recorded.heading_check import HeadingCheck, heading_check
from odometry.modes.recorded.held_rates import held_rates
from odometry.modes.recorded.measured_steps import (
    MeasuredTravel,
    MeasuredTurn,
    measured_travel,
    measured_turn,
)
from odometry.modes.recorded.turning_points import TurningPoints, turning_points
from odometry.recording.run import Run
from odometry.recording.run_terrains import row_terrains
from odometry.windows.recorded.blocked_turns import blocked_spans
from odometry.windows.recorded.gaps import odometry_gaps
from odometry.windows.recorded.turns import continuous_yaw

AROUND_S = 0.15  # on either side: over which a speed is read from poses
STANDING_M_S = 0.01  # of a tread, or less
BEFORE_S = 0.2  # over which treads speed up
BIAS_SIGMA_RAD_S = 0.005  # of a gyroscope that was set to zero at rest: 0.3 degrees a second
BIAS_WALK_RAD2_S3 = 1e-8  # variance that a second adds to it
NO_YAW = "no pose with yaw within the time of odometry.csv; traction modes need x, y and yaw"


@dataclass(frozen=True)
class Signals:
    """Inputs and measurements at N stamps.

    Attributes
    ----------
    stamps_s : (N,)
    tread_speeds_m_s : (N, 2)
        Left and right, in force from each stamp to the next.
    measured : (N, m)
        NaN where an entry was not measured.
    labels : (N,) of str
        Terrain or mode that the run names, for identification and scoring.
    gaps_s : (G, 2)
        Between which stamps the speeds in force are not known.
    heading_check : HeadingCheck or None
        The gyroscope against measured headings, where these are no measurement of the filters.
    travel : MeasuredTravel or None
        Measured positions, where they are no measurement of the filters.
    turn : MeasuredTurn or None
        Measured headings beside the gyroscope, where they are no measurement of the filters.
    blocked_s : (B, 2)
        Between which stamps the treads turn on the spot and the robot does not.
    turning_points : TurningPoints or None
        About which point the robot turns, where poses are no measurement of the filters.
    """

    stamps_s: FloatArray
    tread_speeds_m_s: FloatArray
    measured: FloatArray
    labels: AnyArray
    gaps_s: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    heading_check: HeadingCheck | None = None
    travel: MeasuredTravel | None = None
    turn: MeasuredTurn | None = None
    blocked_s: FloatArray = field(default_factory=lambda: np.empty((0, 2)))
    turning_points: TurningPoints | None = None

    def __len__(self) -> int:
        return len(self.stamps_s)

    def after(self, row: int) -> "Signals":
        """The signals from a row on."""
        later = slice(row, None)
        return Signals(
            self.stamps_s[later],
            self.tread_speeds_m_s[later],
            self.measured[later],
            self.labels[later],
            self.gaps_s[self.gaps_s[:, 0] >= self.stamps_s[row]],
            self.heading_check,
            self.travel,
            self.turn,
            self.blocked_s,
            self.turning_points,
        )

    @property
    def accelerations_m_s2(self) -> FloatArray:
        """How fast (N,) the speed of that tread changed that changed more."""
        return accelerations_m_s2(self.stamps_s, self.tread_speeds_m_s)


def velocity_signals(run: Run) -> Signals:
    """Speed and yaw rate (N, 2) at the stamps of odometry.csv.

    The yaw rate is that of the gyroscope, or wz of velocity.csv, where it is not one reading held;
    the speed is vx of velocity.csv, and else not measured: that of the wheels is the input.

    Raises
    ------
    RunFolderError
        If the run has no yaw rate.
    """
    stamps_s = run.odometry.stamps_s
    omega = yaw_rates_of(run)
    if omega is None and run.velocity is not None and np.isfinite(run.velocity["wz"]).any():
        omega = _nearest(run.velocity.stamps_s, run.velocity["wz"], stamps_s)
    if omega is None:
        raise RunFolderError(
            f"{run.folder}: no yaw rate; expected gyro_z in odometry.csv or imu.csv, or wz in "
            "velocity.csv"
        )
    speed = np.full(len(stamps_s), np.nan)
    if run.velocity is not None:
        speed = _nearest(run.velocity.stamps_s, run.velocity["vx"], stamps_s)
    speeds = run.odometry.stack("v_left", "v_right")
    measured = np.column_stack([speed, np.where(held_rates(omega, speeds), np.nan, omega)])
    gaps_s = odometry_gaps(run).spans_s
    checks = heading_check(run), measured_travel(run), measured_turn(run)
    blocked_s = blocked_spans(stamps_s, speeds, omega, run.robot.track_width)
    of_poses = (*checks, blocked_s, turning_points(run))
    return Signals(stamps_s, speeds, measured, row_terrains(run), gaps_s, *of_poses)


def pose_signals(run: Run) -> Signals:
    """Pose and yaw rate (N, 4) at the stamps of odometry.csv and pose.csv, merged.

    The yaw rate is that of the gyroscope, where there is one.

    Raises
    ------
    RunFolderError
        If the run has no poses with yaw within the time of its odometry.
    """
    odometry_s = run.odometry.stamps_s
    if run.pose is None:
        raise RunFolderError(f"{run.folder}: no pose.csv; expected measured poses")
    pose_s = run.pose.stamps_s
    inside = (pose_s >= odometry_s[0]) & (pose_s <= odometry_s[-1])
    poses = run.pose.stack("x", "y", "yaw")[inside]
    if not len(poses):
        raise RunFolderError(f"{run.folder}: no pose lies within the time of odometry.csv")
    if not np.isfinite(poses).all(axis=1).any():
        raise RunFolderError(f"{run.folder}: {NO_YAW}")
    stamps_s = np.union1d(odometry_s, pose_s[inside])
    rows = np.searchsorted(odometry_s, stamps_s, side="right") - 1
    measured = np.full((len(stamps_s), 4), np.nan)
    measured[np.searchsorted(stamps_s, pose_s[inside]), :3] = poses
    yaw_rates = yaw_rates_of(run)
    if yaw_rates is not None:
        measured[np.searchsorted(stamps_s, odometry_s), 3] = yaw_rates
    speeds = run.odometry.stack("v_left", "v_right")[rows]
    gaps_s = odometry_gaps(run).spans_s
    labels, check = row_terrains(run)[rows], heading_check(run)
    return Signals(stamps_s, speeds, measured, labels, gaps_s, check)


def yaw_rates_of(run: Run) -> FloatArray | None:
    """Measured yaw rates (N,) [rad/s] at the stamps of odometry.csv, NaN where there is none near.

    Those of `Run.yaw_rate`; None without.
    """
    found = run.yaw_rate
    if found is None:
        return None
    if found.file == "odometry.csv":
        return np.asarray(run.odometry["gyro_z"])
    return _nearest(found.stamps_s, found.yaw_rate_rad_s, run.odometry.stamps_s)


def accelerations_m_s2(stamps_s: FloatArray, tread_speeds_m_s: FloatArray) -> FloatArray:
    """How fast (N,) the speed of that tread (N, 2) changed that changed more, over BEFORE_S."""
    rows = np.searchsorted(stamps_s, stamps_s - BEFORE_S + 1e-6, side="right") - 1
    changes = np.abs(tread_speeds_m_s - tread_speeds_m_s[np.maximum(rows, 0)]).max(axis=1)
    return np.asarray(changes / BEFORE_S)


def forward_speed_m_s(run: Run) -> FloatArray | None:
    """Measured forward speed (N,) at the stamps of odometry.csv: vx, else from the poses.

    None where neither was measured; positions without yaw do not say what is forward.
    """
    stamps_s = run.odometry.stamps_s
    if run.velocity is not None and np.isfinite(run.velocity["vx"]).any():
        rows = np.flatnonzero(np.isfinite(run.velocity["vx"]))
        return np.interp(stamps_s, run.velocity.stamps_s[rows], run.velocity["vx"][rows])
    if run.pose is None:
        return None
    poses = run.pose.stack("x", "y", "yaw")
    known = np.isfinite(poses).all(axis=1)
    if not known.any():
        return None
    pose_s, poses = run.pose.stamps_s[known], poses[known]
    poses[:, 2] = continuous_yaw(run)[known]
    before, here, after = (
        np.column_stack([np.interp(stamps_s + shift, pose_s, column) for column in poses.T])
        for shift in (-AROUND_S, 0.0, AROUND_S)
    )
    dx, dy = (after - before)[:, :2].T
    lasts_s = np.clip(stamps_s + AROUND_S, *pose_s[[0, -1]])
    lasts_s = lasts_s - np.clip(stamps_s - AROUND_S, *pose_s[[0, -1]])
    ahead = np.cos(here[:, 2]) * dx + np.sin(here[:, 2]) * dy
    return np.where(lasts_s > 0, ahead / np.where(lasts_s > 0, lasts_s, 1.0), np.nan)


def _nearest(measured_s: FloatArray, measured: FloatArray, stamps_s: FloatArray) -> FloatArray:
    """Values (N,) of the nearest measured ones (M,); NaN where none is within half a period."""
    values = np.full(len(stamps_s), np.nan)
    period_s = float(np.median(np.diff(stamps_s))) if len(stamps_s) > 1 else 0.0
    rows = np.searchsorted(measured_s, stamps_s)
    for shift in (-1, 0):
        near = np.clip(rows + shift, 0, len(measured_s) - 1)
        far_s: FloatArray = np.abs(measured_s[near] - stamps_s)
        fill = np.flatnonzero(np.isnan(values) & (far_s <= period_s / 2))
        values[fill] = measured[near[fill]]
    return values
