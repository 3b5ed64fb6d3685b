"""Modes that the drive does not distinguish: their predictions are equal within their errors.

Errors of a model that last as long as a turn do not average out: two modes whose yaw rates differ
by less than that would be distinguished by these errors, with more confidence every second.
"""

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.mode_set import DWELL_S
from odometry.modes.modes_config import ModesConfig
from odometry.modes.response import BLOCK_S
from odometry.modes.signals import Signals
from odometry.modes.velocity import VelocityModes


def similar_modes(
    signals: Signals, modes: VelocityModes, leading: IntArray, config: ModesConfig | None = None
) -> BoolArray:
    """Modes (N, M) that the last DWELL_S do not distinguish from the leading one (N,).

    What is not measured, or does not depend on the modes, is not in the signals. Modes of one model
    are distinguished by their noise.
    """
    config = config or ModesConfig()
    gains = modes.steady_gains()[:, 1]
    asked = modes.steady_yaw_rates(signals.tread_speeds_m_s)
    asked[:-1] *= np.any(np.isfinite(signals.measured[1:]), axis=1, keepdims=True)
    means, lasts_s = _means(asked, signals.stamps_s)
    # the deviation of what lasts of errors in a mean over so long
    share = np.minimum(modes.errors_last_s / lasts_s, 1.0)[:, None]
    lasting = np.sqrt(modes.measurement_variance[:, 1] * share)
    rows, count = np.arange(len(means)), means.shape[1]
    alike = np.empty((len(means), count), dtype=np.bool_)
    for place in range(count):
        least = config.alike_sigmas * np.maximum(lasting, lasting[:, [place]])
        apart = np.abs(means - means[:, [place]]) > least
        last = np.maximum.accumulate(np.where(apart, rows[:, None], -1), axis=0)
        since_s = signals.stamps_s[:, None] - signals.stamps_s[last]
        recent = (last >= 0) & (since_s <= DWELL_S)
        one_model = (gains == gains[place]).all(axis=1)
        alike[leading == place] = ~(recent | one_model)[leading == place]
    return alike


def _means(values: FloatArray, stamps_s: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Means of values (N, M), in force from each stamp to the next, and over how long (N,).

    Over BLOCK_S before each stamp, or all there is.
    """
    steps_s = np.diff(stamps_s)[:, None]
    summed = np.cumsum(np.vstack([np.zeros(values.shape[1]), values[:-1] * steps_s]), axis=0)
    first = np.searchsorted(stamps_s, stamps_s - BLOCK_S)
    lasts_s = np.maximum(stamps_s - stamps_s[first], 1e-9)
    return (summed - summed[first]) / lasts_s[:, None], lasts_s
