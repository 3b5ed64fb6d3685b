"""Whether the robot turns about a point that it turned about when its modes were identified.

A load that shifts is another terrain in the yaw rate for given treads: by both the robot turns more
or less. It also moves the point about which the robot turns, farther than terrains do.
"""

import numpy as np

from odometry.arrays import BoolArray
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import Signals

TOLERANCE = 0.03  # of the track width: no point is identified better
HOLDS_S = 16.0  # what a window says, where no later one turns enough to say


def turning_point_check(
    signals: Signals, modes: VelocityModes, config: ModesConfig | None = None
) -> BoolArray | None:
    """Where (N,) the robot turns about another point, by windows of 16 s; None without poses.

    None of a set that does not state the points either.
    """
    config, points = config or ModesConfig(), signals.turning_points
    if points is None or not len(points.ends_s) or not np.isfinite(modes.turning_most_m):
        return None
    bound_m = config.point_sigmas * points.sigma_m + TOLERANCE * modes.track_width
    ahead_m = points.ahead_m
    off = ahead_m > modes.turning_most_m + bound_m
    off |= ahead_m < modes.turning_least_m - bound_m
    last = np.searchsorted(points.ends_s, signals.stamps_s, side="right") - 1
    holds = (last >= 0) & (signals.stamps_s - points.ends_s[last] <= HOLDS_S)
    return np.asarray(holds & off[last])
