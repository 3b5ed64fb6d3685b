"""How far measured yaw rates are from those of the modes, counting what lasts."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.grounds import terrains_of
from odometry.modes.response import block_powers
from odometry.modes.stretches import stretches_by_label
from odometry.modes.traction import lagged, twists_of
from odometry.run import Run

NOT_MEASURED = 1.0  # [rad^2/s^2] where no run has a gyroscope: it says next to nothing


def yaw_rate_variance(
    runs: Sequence[Run],
    names: Sequence[str],
    fits: Sequence[tuple[FloatArray, float]],
    track_width: float,
) -> float:
    """Variance of white noise with the power that the errors have at low frequency.

    `fits` are gains and lag of each mode.

    Errors of gains that are not exact last for seconds; taken as noise of the variance that they
    have at each sample, fifty samples a second would say too much.
    """
    powers, steps_s = [], []
    for run in runs:
        if "gyro_z" not in run.odometry:
            continue
        stamps_s, speeds = run.odometry.stamps_s, run.odometry.stack("v_left", "v_right")
        for name, rows in stretches_by_label(stamps_s, terrains_of(run)):
            if len(rows) < 2:
                continue
            gains, lag_s = fits[list(names).index(name)]
            asked = twists_of(gains, speeds[rows], track_width)[:, 2]
            errors = run.odometry["gyro_z"][rows] - lagged(asked, stamps_s[rows], lag_s)
            step_s = float(np.median(np.diff(stamps_s)))
            powers.append(block_powers(errors[np.isfinite(errors)], step_s))
            steps_s.append(step_s)
    if not powers or not len(np.concatenate(powers)):
        return NOT_MEASURED
    return float(np.concatenate(powers).mean() / np.median(steps_s))
