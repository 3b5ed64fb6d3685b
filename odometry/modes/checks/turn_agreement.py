"""Whether gyroscope and headings agree on turns, by the measure of what distinguishes the modes.

A gyroscope that reads less in fast turns, or whose scale has drifted, is another terrain to a mode.
Headings say how far it is off: where that is more than a third of what the most probable mode and
its neighbour differ by over the same drive, the gyroscope does not say which of the two it is.
"""

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals
from odometry.modes.recorded.measured_steps import MeasuredTurn, StepWindows, during, step_windows

WINDOWS_S = (5.0, 10.0, 20.0, 40.0, 80.0)  # in the long ones slow robots turn as well
GYROSCOPE_RAD = 0.01  # by which a gyroscope is off in a window for other reasons
MOST_SIGMAS = 6.0  # of a step, beside as much as it turns: more is a spike, and no scale
HOLDS_S = 5.0  # what a window says, where no later one does
"""`headings_share` and `headings_sigmas` of `ModesConfig` were chosen on seeds 62 to 65 of
`tests/studies/modes/modes_faults.py`: with a half instead of a third modes on a gyroscope with a
soft limit are wrong for 2 % of the time instead of 0.5 %, with three deviations clean runs lose
another 1.3 points. Without GYROSCOPE_RAD half of the windows of a real Warthog contradict the true
mode."""


def turns_disagree(
    signals: Signals,
    modes: VelocityModes,
    leading: IntArray,
    bias: tuple[FloatArray, FloatArray],
    config: ModesConfig | None = None,
) -> BoolArray | None:
    """Where (N,) headings contradict what the gyroscope turned; None without both.

    Parameters
    ----------
    signals : Signals
    modes : VelocityModes
    leading : (N,)
        The most probable mode.
    bias : (N,), (N,)
        Of the filters, and its standard deviation [rad/s].
    config : ModesConfig, optional
    """
    config = config or ModesConfig()
    turn = signals.turn
    if turn is None or len(modes.names) < 2:
        return None
    disagree = np.zeros(len(signals), dtype=np.bool_)
    said = during(
        turn.begin_s,
        turn.end_s,
        signals.stamps_s,
        modes.steady_yaw_rates(signals.tread_speeds_m_s).T,
    )
    biases, sigmas = during(turn.begin_s, turn.end_s, signals.stamps_s, np.array(bias))
    for window_s in WINDOWS_S:
        windows = step_windows(turn.begin_s, turn.end_s, window_s)
        if len(windows):
            last, known = windows.in_force(signals.stamps_s, HOLDS_S)
            off = _off(turn, windows, (said, biases, sigmas), config)
            disagree |= known & off[leading, last]
    return disagree


def _off(
    turn: MeasuredTurn,
    windows: StepWindows,
    steps: tuple[FloatArray, FloatArray, FloatArray],
    config: ModesConfig,
) -> BoolArray:
    """Windows (M, W) in which the gyroscope is too far off.

    Steps (M, K), (K,), (K,): what each mode turns, what the bias does, and its deviation [rad].
    """
    said, biases, sigmas = steps
    side = np.sign(said.mean(axis=0))
    # stamps of poses err where a chain begins and ends: a window with a break says nothing
    breaks = np.append(False, turn.begin_s[1:] > turn.end_s[:-1])
    read = np.where(breaks, np.nan, turn.gyroscope_rad - biases)
    most_rad = np.abs(turn.heading_rad) + MOST_SIGMAS * np.sqrt(2.0) * turn.noise_rad
    apart = windows.sums(side * np.clip(read - turn.heading_rad, -most_rad, most_rad))
    late = _lateness(windows, read, turn.heading_rad)
    apart = np.abs(np.nan_to_num(apart[late, np.arange(len(windows))]))
    turns_back = windows.sums(np.append(0.0, side[1:] != side[:-1]))
    # the bias is one: what it is off by in turns to one side is taken back in those to the other
    of_bias = np.hypot(windows.sums(side * sigmas), GYROSCOPE_RAD)
    noise = np.hypot(turn.noise_rad * np.sqrt(2 * (1 + turns_back)), of_bias)
    turned = windows.sums(side * said)
    between = np.abs(turned[:, None] - turned)
    between[np.arange(len(said)), np.arange(len(said))] = np.inf
    least = config.headings_share * between.min(axis=1)
    return np.asarray(apart > np.maximum(least, config.headings_sigmas * noise))


def _lateness(windows: StepWindows, read: FloatArray, headings: FloatArray) -> IntArray:
    """Place (W,) of the lateness of headings (K,) at which they go best with what was read (L, K).

    The one of the largest correlation, which does not depend on the scale.
    """
    products, squares = windows.sums(read * headings), windows.sums(read**2)
    together = products / np.sqrt(np.maximum(squares, 1e-12))
    return np.asarray(np.nan_to_num(together, nan=-np.inf).argmax(axis=0))
