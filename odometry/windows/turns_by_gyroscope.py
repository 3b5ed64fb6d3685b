"""Turns between poses by a gyroscope, where it agrees with turns that poses measured."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry.angles import wrap
from odometry.gyroscope import Gyroscope
from odometry.windows.close_pairs import POSE_RAD, ClosePairs
from odometry.windows.robust import slope, spread

SCALES = (0.8, 1.25)  # of a gyroscope that can be right
UNLIKE = 0.3  # of all turns measured: what one of these scales may leave
SCALE_OFF = 0.03  # by a rad turned: what is left open of its scale
DRIFT_RAD_S = 0.005  # of its bias over a run
SIGMAS = 3.0  # of what scatters
UNKNOWN_SCALE, UNKNOWN_BIAS_RAD_S = 0.1, 0.1  # off by, where close pairs determine neither; then
AGREES_FROM_RAD, LEAST_AGREEING, AGREEING = 1.0, 10, 0.8  # most turns must agree but for counts


@dataclass(frozen=True)
class _Calibration:
    """Bias and scale of a gyroscope, how far they may be off, and measured yaws.

    `unlike` is the share of measured turns that it did not measure.
    """

    bias_rad_s: float
    bias_off_rad_s: float
    scale: float
    scale_off: float
    pose_rad: float
    unlike: float


def turns_by_gyroscope(
    gyroscope: Gyroscope, pairs: ClosePairs, stamps_s: FloatArray, yaw_rad: FloatArray
) -> tuple[FloatArray, FloatArray] | None:
    """Turns and bounds; None of a gyroscope that turns another way than measured yaws."""
    turn, gross, off, silent_s = gyroscope.between(stamps_s[:-1], stamps_s[1:])
    known = _calibrated(gyroscope, pairs)
    if known is None:
        turned = (silent_s == 0) & (gross > AGREES_FROM_RAD)
        agrees = np.abs(wrap(turn - np.diff(yaw_rad)))[turned] < np.pi / 4
        if len(agrees) < LEAST_AGREEING or agrees.mean() < AGREEING:
            return None
        known = _Calibration(0.0, UNKNOWN_BIAS_RAD_S, 1.0, UNKNOWN_SCALE, POSE_RAD, 0.0)
    if known.unlike > UNLIKE or not SCALES[0] < known.scale < SCALES[1]:
        return None
    lasts_s = np.diff(stamps_s)
    bound = known.pose_rad + off + known.scale_off * gross + known.bias_off_rad_s * lasts_s
    return turn - known.bias_rad_s * lasts_s, np.where(silent_s > 0, np.inf, bound)


def _calibrated(gyroscope: Gyroscope, pairs: ClosePairs) -> _Calibration | None:
    """Scale and bias of a gyroscope by the pairs; None where they are few or turned too little."""
    turn, _, _, silent_s = gyroscope.between(pairs.begin_s, pairs.end_s)
    heard = pairs.where(silent_s == 0)
    if not heard.tell_a_scale:
        return None
    turn, turned, lasts_s = turn[silent_s == 0], heard.turned_rad, heard.end_s - heard.begin_s
    bias = slope(turn - turned, lasts_s)
    scale = slope(turned, turn - bias * lasts_s)
    errors = turn - bias * lasts_s - turned
    scattered_rad_s = spread((turn - turned) / lasts_s) / np.sqrt(len(turn))
    return _Calibration(
        bias,
        DRIFT_RAD_S + SIGMAS * scattered_rad_s,
        scale,
        abs(scale - 1) + SCALE_OFF,
        POSE_RAD + SIGMAS * spread(errors),
        float(np.abs(errors).sum() / np.abs(turned).sum()),
    )
