"""What contradicts the most probable mode: equal modes, turns and travel."""

from typing import Any

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.checks.between_modes import between_modes
from odometry.modes.checks.centre_check import centre_check
from odometry.modes.checks.gain_check import gain_check
from odometry.modes.checks.one_bias_check import one_bias_check
from odometry.modes.checks.place_drift import place_drifts
from odometry.modes.checks.pose_scatter import pose_scatter
from odometry.modes.checks.travel_check import travel_check
from odometry.modes.checks.turn_agreement import turns_disagree
from odometry.modes.checks.turn_gain_check import turn_gain_check
from odometry.modes.checks.turning_point_check import turning_point_check
from odometry.modes.models.innovation_test import (
    LONG_CLIP,
    LONG_WINDOW_S,
    WINDOW_S,
    Innovations,
    windowed,
)
from odometry.modes.models.mode_set import DWELL_S, ModeSet
from odometry.modes.models.response import BLOCK_S
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals

WINDOWS_S = (6.0, 12.0)
CLIP = 3.0  # of one innovation
LEAST_RAD_S = 0.05  # predicted: less is no turn
STAY_S = 4.0  # of a terrain, of traction modes; of velocity modes wrong names are not worth it


def contradictions(
    signals: Signals,
    mode_set: ModeSet,
    left: Innovations,
    bias: tuple[FloatArray, FloatArray],
    config: ModesConfig,
) -> dict[str, Any]:
    """Fields of `ModeTrack`: what speaks against the most probable mode, as its filters allow.

    `bias` is that of the filters (N,) and its standard deviation (N,).

    Of modes that measure velocities: equal modes, turns, travel, turns between two modes, headings
    at odds and the point about which the robot turns. Of those that measure poses: turns between
    two modes, gains and turning centres that are off, drifts of places, where one was contradicted
    not long ago, and how far poses scatter.
    """
    modes, biases_rad_s = mode_set.modes, bias[0]
    believed = biases_rad_s, left.independent, config
    if not isinstance(modes, VelocityModes):
        return {
            "between": between_modes(signals, modes, *believed, stay_s=STAY_S),
            "contradicted": contradicted_lately(left, config),
            "gain": gain_check(signals, modes, left.leading, biases_rad_s, config),
            "centre": centre_check(signals, modes, left.leading, config),
            "drifts": place_drifts(left, config),
            "scatter": pose_scatter(left),
        }
    predicted = modes.steady_yaw_rates(signals.tread_speeds_m_s)
    before = np.vstack([np.zeros(predicted.shape[1]), predicted[:-1]])
    off = turns_are_off(left, before, config)
    off |= one_bias_check(signals, modes, left.leading, (*bias, left.independent), config)
    gains_are_off = turn_gain_check(signals, modes, left.leading, biases_rad_s, config)
    return {
        "alike": similar_modes(signals, modes, left.leading, config),
        "turns_are_off": off if gains_are_off is None else off | gains_are_off,
        "travel": travel_check(signals, modes, config),
        "between": between_modes(signals, modes, *believed),
        "headings_disagree": turns_disagree(signals, modes, left.leading, bias, config),
        "centre": turning_point_check(signals, modes, config),
    }


def turns_are_off(
    innovations: Innovations, predicted_rad_s: FloatArray, config: ModesConfig | None = None
) -> BoolArray:
    """Where (N,) turns contradict the most probable mode.

    Parameters
    ----------
    innovations : Innovations
        The yaw rate is the last measured entry.
    asked_rad_s : (N, M)
        Steady yaw rate of each mode for the speeds in force before each stamp.
    config : ModesConfig, optional
        `turn_sigmas` were chosen on seeds 50, 51 and 60 to 63 of
        `tests/studies/modes/modes_faults.py`: of 18 clean runs 3 have a sum beyond 3.5 somewhere.
    """
    config = config or ModesConfig()
    # while the robot stands nothing takes back what its turns contradicted
    measured = np.isfinite(innovations.of_leading[:, -1])
    driven_s = np.cumsum(np.diff(innovations.stamps_s, prepend=innovations.stamps_s[0]) * measured)
    sums = [turn_sums(innovations, predicted_rad_s, window_s) for window_s in WINDOWS_S]
    off = np.asarray((np.abs(sums) > config.turn_sigmas).any(axis=(0, 2)))
    last = np.maximum.accumulate(np.where(off, np.arange(len(off)), -1))
    since_s = driven_s - driven_s[last]
    return np.asarray((last >= 0) & (since_s <= config.turn_holds_s))


def contradicted_lately(innovations: Innovations, config: ModesConfig | None = None) -> BoolArray:
    """Where (N,) the most probable mode was contradicted over six seconds not long ago.

    By mode and by driven time: another mode may be named, and rest takes nothing back.

    Parameters
    ----------
    innovations : Innovations
    config : ModesConfig, optional
        It holds for `turn_holds_s`, as the test of turns of velocity modes does.
    """
    config = config or ModesConfig()
    stamps_s, of_leading = innovations.stamps_s, innovations.of_leading
    recent, _ = innovations.summed(of_leading, WINDOW_S, CLIP)
    measured = np.isfinite(recent).any(axis=1)
    driven_s = np.cumsum(np.diff(stamps_s, prepend=stamps_s[0]) * measured)
    found = np.zeros(len(stamps_s), dtype=np.bool_)
    for mode in np.unique(innovations.leading):
        leads = innovations.leading == mode
        # what contradicted the mode before a change says nothing against the one after it
        its_own = np.where(leads[:, None], of_leading, np.nan)
        lasting, _ = innovations.summed(its_own, LONG_WINDOW_S, LONG_CLIP)
        off = leads & np.asarray((np.abs(lasting) > config.long_sigmas).any(axis=1))
        last = np.maximum.accumulate(np.where(off, np.arange(len(off)), -1))
        since_s = driven_s - driven_s[last]
        found |= leads & (last >= 0) & (since_s <= config.turn_holds_s)
    return found


def turn_sums(innovations: Innovations, predicted_rad_s: FloatArray, window_s: float) -> FloatArray:
    """Sums (N, 3) over left turns, right turns and both in a window up to each stamp.

    In their standard deviations if the mode is true; positive: more was turned than it says.
    """
    rows = np.arange(len(innovations.leading))
    predicted = predicted_rad_s[rows, innovations.leading]
    left_over = innovations.of_leading[:, -1]
    known = np.isfinite(left_over)
    clipped = np.where(known, np.clip(np.nan_to_num(left_over), -CLIP, CLIP), 0.0)
    sides = []
    for side in (1, -1):
        weights = np.where(known & (side * predicted > LEAST_RAD_S), predicted, 0.0)
        columns = np.column_stack([weights * clipped, weights**2, np.abs(weights)])
        summed, squares, sizes = windowed(columns, innovations.stamps_s, window_s).T
        variances = np.minimum(squares / innovations.independent, sizes**2)
        sides.append(summed / np.sqrt(np.maximum(variances, 1e-9)))
    left, right = sides
    return np.column_stack([left, right, (left + right) / np.sqrt(2.0)])


def similar_modes(
    signals: Signals, modes: VelocityModes, leading: IntArray, config: ModesConfig | None = None
) -> BoolArray:
    """Modes (N, M) that the last DWELL_S do not distinguish from the leading one (N,).

    What is not measured, or does not depend on the modes, is not in the signals. Modes of one model
    are distinguished by their noise.
    """
    config = config or ModesConfig()
    gains = modes.steady_gains()[:, 1]
    predicted = modes.steady_yaw_rates(signals.tread_speeds_m_s)
    predicted[:-1] *= np.any(np.isfinite(signals.measured[1:]), axis=1, keepdims=True)
    means, lasts_s = _means(predicted, signals.stamps_s)
    # the deviation of what lasts of errors in a mean over so long
    share = np.minimum(modes.errors_last_s / lasts_s, 1.0)[:, None]
    of_turns = modes.lasting_share() * np.abs(means)
    lasting = np.sqrt(modes.measurement_variance[:, 1] * share + of_turns**2)
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
