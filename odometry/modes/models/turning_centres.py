"""About which point a robot turns, by its poses, against the point that a traction mode states.

Displacement and turn are both taken between the same two poses, so that the point, v_x / omega to
the left and -v_y / omega ahead, is the same for poses that are late and for a yaw rate that follows
late. What the treads predict is shifted by how late speed and turn are, each found by itself, and
sideways speed is compared at the mode's own mean centre, where it is small at any yaw rate. What
drifts in one direction of the world, as on a slope, by the time or by how far the treads skid in a
turn, is fitted as well: over a whole turn it is no centre.
"""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.models.response import lagged
from odometry.modes.models.traction import TURNS, twists_of
from odometry.modes.recorded.measured_steps import StepWindows, during
from odometry.modes.recorded.pose_steps import AHEAD, ASIDE, TURN, PoseSteps
from odometry.modes.recorded.turning_points import DRIFT_M_S, STEP_M

LATE_S = np.arange(-1, 9) * 0.1  # of poses, of speed and of turn against the treads
# Prior deviation of a drift by the turn. Chosen in development (tests/studies/modes.md): without it
# slopes lose 1.5 points of right names instead of 0.7.
SLIDE_M = 0.02
TURNING_RAD_S, TURNING_S = 0.05, 2.0  # in a window: less is no turn
FREE_M = 1e3  # of a centre: any
UNKNOWNS = 6  # of a window: centre to the left and ahead, both drifts in x and y


def predicted_steps(
    steps: PoseSteps, stamps_s: FloatArray, twists: FloatArray, lag_s: float
) -> FloatArray:
    """What twists (..., N, 3) that treads command move in each step (L, ..., K, 3).

    For poses that are LATE_S (L,). Turn and sideways motion follow by the lag of a mode.
    """
    rates = np.moveaxis(twists, -1, 0).copy()
    for row in (ASIDE, TURN):
        columns = rates[row].reshape(-1, len(stamps_s))
        followed = [lagged(column, stamps_s, lag_s) for column in columns]
        rates[row] = np.reshape(followed, rates[row].shape)
    moved = [during(steps.begin_s - of, steps.end_s - of, stamps_s, rates) for of in LATE_S]
    return np.moveaxis(np.stack(moved), 1, -1)


def mean_centre_m(gains: FloatArray, track_width: float) -> float:
    """How far ahead of the robot's origin a mode (2, 3, 5) turns in the mean over TURNS."""
    twists = twists_of(gains, TURNS, track_width)
    return float(-(twists[:, ASIDE] @ twists[:, TURN]) / (twists[:, TURN] @ twists[:, TURN]))


def centres(
    steps: PoseSteps,
    predicted: FloatArray,
    centre_m: float,
    windows: StepWindows,
    counts: BoolArray,
) -> tuple[FloatArray, FloatArray]:
    """By how much the centre is off (W, 2) in windows: least squares of it and of drifts.

    To the left, and ahead, of where the mode states it [m], and the variances (W, 2) by what the
    window leaves, as if errors of steps that overlap were one; NaN where it determines none.
    `predicted` (L, K, 3) is for poses that are LATE_S, `counts` (K,) says which steps count.
    """
    late_ahead = _late(steps.moved[:, AHEAD], predicted[..., AHEAD], windows, counts)
    late_turn = _late(steps.moved[:, TURN], predicted[..., TURN], windows, counts)
    turn, lasts_s, none = steps.moved[:, TURN], steps.lasts_s, np.zeros(len(steps))
    cosine, sine = np.cos(steps.heading_rad), np.sin(steps.heading_rad)
    drifts = [(by * cosine, by * sine) for by in (lasts_s, np.abs(turn))]
    of_ahead = np.stack([turn, none, *(one for x, y in drifts for one in (x, y))]) * counts
    of_aside = np.stack([none, -turn, *(one for x, y in drifts for one in (-y, x))]) * counts
    ahead = steps.moved[:, AHEAD] - predicted[..., AHEAD]
    at_centre = steps.moved[:, ASIDE] + centre_m * turn
    aside = at_centre - predicted[..., ASIDE] - centre_m * predicted[..., TURN]
    rows = np.arange(len(windows))
    right, squares = (
        windows.sums(by_ahead)[late_ahead, ..., rows] + windows.sums(by_aside)[late_turn, ..., rows]
        for by_ahead, by_aside in (
            (of_ahead * ahead[:, None], of_aside * aside[:, None]),
            (counts * ahead**2, counts * aside**2),
        )
    )
    products = of_ahead[:, None] * of_ahead + of_aside[:, None] * of_aside
    prior = STEP_M**2 / np.square([FREE_M, FREE_M, DRIFT_M_S, DRIFT_M_S, SLIDE_M, SLIDE_M])
    inverse = np.linalg.inv(np.moveaxis(windows.sums(products), -1, 0) + np.diag(prior))
    found = (inverse @ right[..., None])[..., 0]
    left = np.maximum(squares - np.einsum("wi,wi->w", found, right), 0.0)
    freedom = 2 * windows.sums(counts.astype(np.float64)) - UNKNOWNS * steps.overlapping
    turning = counts & (np.abs(turn) > TURNING_RAD_S * lasts_s)
    turned_s = windows.sums(turning * lasts_s) / steps.overlapping
    known = ((turned_s > TURNING_S) & (freedom > 0))[:, None]
    scale = steps.overlapping * left / np.where(freedom > 0, freedom, 1.0)
    variances = scale[:, None] * np.diagonal(inverse, axis1=1, axis2=2)[:, :2]
    return np.where(known, found[:, :2], np.nan), np.where(known, variances, np.nan)


def _late(
    measured: FloatArray, predicted: FloatArray, windows: StepWindows, counts: BoolArray
) -> FloatArray:
    """Place in LATE_S (W,) at which predicted (L, K), times any gain, explains most of measured."""
    product = windows.sums(counts * predicted * measured)
    squares = windows.sums(counts * predicted**2)
    explained = np.maximum(product, 0.0) ** 2 / np.maximum(squares, 1e-12)
    return np.asarray(explained.argmax(axis=0))
