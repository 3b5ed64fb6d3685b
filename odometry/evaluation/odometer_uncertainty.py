"""How far the open-loop odometer of a replay may be off, as measured on its own run."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.estimates import Replay
from odometry.estimation.transition import STATES, Y_LEFT
from odometry.evaluation.odometer_noise import USUAL_NOISE, OdometerNoise, measured_noise
from odometry.evaluation.open_loop_consistency import (
    DISTANCES_M,
    OpenLoopConsistency,
    consistency_by_halves,
    open_loop_consistency,
)
from odometry.evaluation.open_loop_errors import TOGETHER, OpenLoopPath
from odometry.geometry import se2
from odometry.models.icr import icr_speed_matrix, icr_twist_jacobian
from odometry.run import Run
from odometry.trajectory import Trajectory


@dataclass(frozen=True)
class OdometerUncertainty:
    """Covariance of an odometer, where it comes from, and whether it was found right.

    Attributes
    ----------
    covariances : (N, 3, 3)
        Of x, y [m], yaw [rad] in the frame of the odometer, at each pose; the first is that of
        the pose at which the odometer starts.
    sigmas : dict of float to (3,)
        Standard deviations after so many metres of wheel travel.
    noise : OdometerNoise or None
        None where the filter took in no pose: then the covariance is the filter's own.
    source : str
        Where the covariance comes from, in words.
    checks : tuple of OpenLoopConsistency
        NEES by distance against the truth, or of each half of the run by the noise of the other;
        empty where there is no reference.
    own_checks : tuple of OpenLoopConsistency
        Without a truth, NEES against the poses between which the noise was measured: it says
        whether the sources can describe the run, not whether they foretell another one.
    """

    covariances: FloatArray
    sigmas: dict[float, FloatArray]
    noise: OdometerNoise | None
    source: str
    checks: tuple[OpenLoopConsistency, ...] = ()
    own_checks: tuple[OpenLoopConsistency, ...] = ()


def odometer_uncertainty(
    run: Run, replay: Replay, truth: Trajectory | None = None
) -> OdometerUncertainty:
    """The covariance of the odometer along a replay, and its check.

    The noise of the odometer is measured between the poses that the filter accepted. It is
    checked against the truth where there is one, else each half of the run against its poses by
    the noise of the other half.

    Parameters
    ----------
    run : Run
        That was replayed.
    replay : Replay
    truth : Trajectory, optional
        Of truth.csv; it checks, and nothing is measured by it.
    """
    path = path_of(replay)
    rows, poses = accepted_poses(run, replay)
    if not len(rows):
        covariances = replay.pose_covariances
        return OdometerUncertainty(
            covariances,
            _after(path, covariances),
            None,
            "that of the filter, which took in no pose: its noise settings and what is known of "
            "the parameters",
        )
    noise = measured_noise(path, rows, poses)
    if noise is None:
        noise = USUAL_NOISE
        source = "usual values of other recordings: the run is too short to measure its own"
    else:
        source = (
            f"measured on {noise.stretches} stretches of up to {noise.longest_m:g} m between the "
            "poses of the run"
        )
    covariances = path.carried(replay.estimates[0].covariance[:3, :3], noise.variances)
    covariances += learning_covariances(replay, path)
    own = []
    if truth is not None:
        checks = open_loop_consistency(path, *_true_poses(replay, truth), noise.without_reference())
    else:
        checks = consistency_by_halves(path, rows, poses)
        own = open_loop_consistency(path, rows, poses, noise) if noise.stretches else []
    return OdometerUncertainty(
        covariances, _after(path, covariances), noise, source, tuple(checks), tuple(own)
    )


def path_of(replay: Replay) -> OpenLoopPath:
    """The odometer of a replay with the travel of its treads."""
    speeds = np.nan_to_num(replay.tread_speeds_m_s)[:-1]
    steps_s = np.diff(replay.stamps_s)
    travel, signed = (
        np.append(0.0, np.cumsum(each.mean(axis=1) * steps_s)) for each in (np.abs(speeds), speeds)
    )
    return OpenLoopPath(replay.odometer().poses, travel, signed)


def accepted_poses(run: Run, replay: Replay) -> tuple[IntArray, FloatArray]:
    """Frames (M,) of a replay whose pose the filter accepted, and these poses (M, 3).

    A yaw that was not measured is the filter's; the place is the robot's, not the antenna's.
    """
    accepted = replay.accepted
    if run.pose is None or not accepted.any():
        return np.empty(0, dtype=np.int64), np.empty((0, 3))
    rows = np.flatnonzero(accepted)
    rows = rows[np.isin(replay.stamps_s[rows], run.pose.stamps_s)]
    at = np.searchsorted(run.pose.stamps_s, replay.stamps_s[rows])
    poses = run.pose.stack("x", "y", "yaw")[at]
    poses[:, 2] = np.where(np.isfinite(poses[:, 2]), poses[:, 2], replay.means[rows, 2])
    if run.sensors.pose_m is not None:
        lever_m = np.array(run.sensors.pose_m[:2])
        poses[:, :2] += poses[:, :2] - se2.transform(poses, lever_m)
    placed = np.isfinite(poses).all(axis=1)
    return rows[placed], poses[placed]


def _true_poses(replay: Replay, truth: Trajectory) -> tuple[IntArray, FloatArray]:
    rows = np.flatnonzero(truth.covers(replay.stamps_s))
    poses = truth.at(replay.stamps_s[rows]).poses
    known = np.isfinite(poses).all(axis=1)
    return rows[known], poses[known]


def _after(path: OpenLoopPath, covariances: FloatArray) -> dict[float, FloatArray]:
    """Standard deviations (3,) of x, y, yaw after each distance that the path holds."""
    rows = {distance_m: np.searchsorted(path.travel_m, distance_m) for distance_m in DISTANCES_M}
    return {
        distance_m: np.sqrt(np.diag(covariances[row]))
        for distance_m, row in rows.items()
        if row < len(covariances)
    }


def learning_covariances(replay: Replay, path: OpenLoopPath) -> FloatArray:
    """Covariances (N, 3, 3) by which poses of the odometer are less sure than the run's usual.

    The noise of an odometer is measured over the whole run. Where the filter was less sure of a
    parameter than usual (the median of the run), as it is at first, the difference of the two
    variances acts along the path besides. The error of a parameter is taken to keep its sign
    while it shrinks, and those of different parameters to be independent.
    """
    variances = np.square(replay.sigmas[:, Y_LEFT:])
    excess = np.sqrt(np.maximum(variances - np.median(variances, axis=0), 0.0))[:-1]
    steps_s = np.diff(replay.stamps_s)
    slopes = _twist_slopes(replay)
    slopes *= excess[:, None, :]
    slopes *= steps_s[:, None, None]
    found = np.zeros((len(variances), 3, 3))
    for parameter in range(slopes.shape[-1]):
        moved = path.moved_by(slopes[..., parameter])
        for some in (slice(at, at + TOGETHER) for at in range(0, len(moved), TOGETHER)):
            found[some] += moved[some, :, None] * moved[some, None, :]
    return found


def _twist_slopes(replay: Replay) -> FloatArray:
    """Derivatives (N - 1, 3, 6) of twists by y_left, y_right, x_icr, bias, alphas."""
    means, yaw_rates = replay.means[:-1, Y_LEFT:], replay.believed_yaw_rates_rad_s
    speeds = np.nan_to_num((replay.tread_speeds_m_s + replay.added_speeds_m_s)[:-1])
    slopes = np.zeros((len(speeds), 3, STATES - Y_LEFT))
    for some in (slice(at, at + TOGETHER) for at in range(0, len(speeds), TOGETHER)):
        _fill_slopes(slopes[some], means[some], speeds[some], yaw_rates[some])
    return slopes


def _fill_slopes(
    slopes: FloatArray, means: FloatArray, speeds: FloatArray, yaw_rates: FloatArray
) -> None:
    """Put the derivatives of some twists in place, by the gyroscope where it turned the robot."""
    icrs, bias, alphas = np.split(means, [3, 4], axis=1)
    slopes[..., :3] = icr_twist_jacobian(icrs, alphas * speeds)
    slopes[..., 4:] = icr_speed_matrix(icrs) * speeds[:, None, :]
    known = np.isfinite(yaw_rates)
    omega = (yaw_rates - bias[:, 0])[known]
    by_gyroscope = np.zeros((len(omega), 3, STATES - Y_LEFT))
    by_gyroscope[:, 0, 0] = by_gyroscope[:, 0, 1] = omega / 2
    by_gyroscope[:, 1, 2] = -omega
    by_gyroscope[:, 0, 3] = -icrs[known, :2].sum(axis=1) / 2
    by_gyroscope[:, 1, 3] = icrs[known, 2]
    by_gyroscope[:, 2, 3] = -1.0
    by_gyroscope[:, 0, 4:] = speeds[known] / 2
    slopes[known] = by_gyroscope
