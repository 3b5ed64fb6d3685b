"""The error of an odometer by parameters that its filter does not know, or not yet."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.transition import STATES, Y_LEFT
from odometry.evaluation.open_loop_errors import OpenLoopPath
from odometry.models.icr import icr_speed_matrix, icr_twist_jacobian
from odometry.replays.estimates import Replay


def learning_covariances(replay: Replay, path: OpenLoopPath) -> Iterator[FloatArray]:
    """Covariances (k, 3, 3) by which poses of the odometer are less sure than the run's usual.

    The noise of an odometer is measured over the whole run. Where the filter was less sure of a
    parameter than usual (the median of the run), as it is at first, the difference of the two
    variances acts along the path besides. Block by block.
    """
    states = [slice(state, state + 1) for state in range(Y_LEFT, STATES)]
    usual = np.array([np.median(np.square(replay.sigmas_of(of))) for of in states])
    return _of_variances_above(usual, replay, path)


def parameter_covariances(replay: Replay, path: OpenLoopPath) -> Iterator[FloatArray]:
    """Covariances (k, 3, 3) of the odometer's poses by all that its filter does not know.

    For a run in which no pose measured the odometer's noise. Block by block.
    """
    return _of_variances_above(np.zeros(STATES - Y_LEFT), replay, path)


def _of_variances_above(
    known: FloatArray, replay: Replay, path: OpenLoopPath
) -> Iterator[FloatArray]:
    """What variances of parameters above known ones (6,) do to the poses.

    The error of a parameter is taken to keep its sign while its variance changes, and those of
    different parameters to be independent.
    """
    stamps_s = replay.stamps_s

    def errors(steps: slice) -> FloatArray:
        variances = np.square(replay.sigmas_of(slice(Y_LEFT, STATES), steps))
        excess = np.sqrt(np.maximum(variances - known, 0.0))
        slopes = _twist_slopes(replay, steps)
        slopes *= excess[:, None, :]
        slopes *= np.diff(stamps_s[steps.start : steps.stop + 1])[:, None, None]
        return slopes

    for moved in path.moved_by(errors):
        found = np.zeros((len(moved), 3, 3))
        for by in np.moveaxis(moved, -1, 0):
            found += by[:, :, None] * by[:, None, :]
        yield found


def _twist_slopes(replay: Replay, steps: slice) -> FloatArray:
    """Derivatives (k, 3, 6) of some steps' twists by y_left, y_right, x_icr, bias, alphas."""
    means = replay.numbers("mean", steps, slice(Y_LEFT, STATES))
    yaw_rates = replay.numbers("believed_yaw_rate_rad_s", slice(steps.start + 1, steps.stop + 1))
    speeds = replay.numbers("tread_speeds_m_s", steps) + replay.numbers("added_speeds_m_s", steps)
    slopes = np.zeros((len(means), 3, STATES - Y_LEFT))
    _fill_slopes(slopes, means, np.nan_to_num(speeds), yaw_rates)
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
