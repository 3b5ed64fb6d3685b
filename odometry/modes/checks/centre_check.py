"""Whether the robot turns about the point that the most probable traction mode states.

A wheel that slips turns the robot by as much as another set of wheels does, about another point.
How far that point is off on drives that a mode was not identified from, `identify-modes` has
measured (`centre_spread`, `centre_noise`).
"""

import numpy as np

from odometry.arrays import BoolArray, IntArray
from odometry.modes.models.traction import TractionModes, twists_of
from odometry.modes.models.turning_centres import centres, mean_centre_m, predicted_steps
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals
from odometry.modes.recorded.measured_steps import EVERY_S, LEAST_STEPS, step_windows
from odometry.modes.recorded.pose_steps import pose_steps

# Chosen in development (tests/studies/modes.md): windows of 4 s as well cost clean runs a point.
WINDOWS_S = (8.0, 16.0)
# What the last seconds do not show by half any more was of a change that the filters saw late.
RECENT_S, STILL = 4.0, 0.5
TOLERANCE_M = 0.005  # no centre is identified better


def centre_check(
    signals: Signals, modes: TractionModes, leading: IntArray, config: ModesConfig | None = None
) -> BoolArray | None:
    """Where (N,) the turning centre of the most probable mode (N,) is off by more than its spread.

    None of a set that does not state how far its centres are off, and of too few poses.
    """
    config, stamps_s = config or ModesConfig(), signals.stamps_s
    steps = pose_steps(stamps_s, signals.measured[:, :3], signals.gaps_s)
    if modes.centre_spread is None or modes.centre_noise is None or len(steps) < LEAST_STEPS:
        return None
    off = np.zeros(len(signals), dtype=np.bool_)
    begin, end = (np.searchsorted(stamps_s, of) for of in (steps.begin_s, steps.end_s))
    for mode in np.unique(leading):
        leads = leading == mode
        twists = twists_of(modes.gains[mode], signals.tread_speeds_m_s, modes.track_width)
        predicted = predicted_steps(steps, stamps_s, twists, float(modes.lag_s[mode]))
        centre_m = mean_centre_m(modes.gains[mode], modes.track_width)
        counts = leads[begin] & leads[end]  # what another mode left says nothing of this one
        recent_m = np.full((len(signals), 2), np.nan)
        for window_s in (RECENT_S, *WINDOWS_S):
            windows = step_windows(steps.begin_s, steps.end_s, window_s)
            if not len(windows):
                continue
            off_m, variances = centres(steps, predicted, centre_m, windows, counts)
            last, holds = windows.in_force(stamps_s, EVERY_S)
            rows, last = leads & holds, last[leads & holds]
            if window_s == RECENT_S:
                recent_m[rows] = off_m[last]
                continue
            squares = modes.centre_spread[mode] ** 2 + modes.centre_noise[mode] * variances
            beyond = np.abs(off_m) > config.centre_sigmas * np.sqrt(squares + TOLERANCE_M**2)
            # where the last seconds determine nothing they take nothing back
            over = recent_m[rows] * np.sign(off_m[last]) < STILL * np.abs(off_m[last])
            off[rows] |= (beyond[last] & ~over).any(axis=1)
    return off
