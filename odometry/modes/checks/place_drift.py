"""Whether the robot drifts in one direction of the world: a slope or a push, and no mode.

What is wrong with a mode turns with the robot, so that in the frame of the poses it changes its
direction with every turn. What slides down a slope goes on in one direction, by too little in six
seconds to contradict a mode, and moves the robot in a turn as another set of wheels does.
"""

import numpy as np

from odometry.arrays import BoolArray
from odometry.modes.models.innovation_test import LONG_CLIP, Innovations, windowed
from odometry.modes.modes_config import ModesConfig

PLACE = slice(0, 2)  # x and y among what traction modes measure
# One direction in all parts: innovations that last for a part are no drift, however large.
PART_S, PARTS = 2.0, 7


def place_drifts(innovations: Innovations, config: ModesConfig | None = None) -> BoolArray:
    """Where (N,) what is left of the places goes in one direction over the last PARTS.

    By the deviation of the parts among each other, or 1 where that is less. The innovations are
    those of traction modes.
    """
    config, stamps_s = config or ModesConfig(), innovations.stamps_s
    places = innovations.of_leading[:, PLACE]
    known = np.isfinite(places).all(axis=1, keepdims=True)
    clipped = np.clip(np.nan_to_num(places), -LONG_CLIP, LONG_CLIP)
    sums = windowed(np.hstack([known, clipped * known]), stamps_s, PART_S)
    counts, normalised = sums[:, 0], sums[:, 1:] / np.sqrt(np.maximum(sums[:, :1], 1.0))
    begins_s = stamps_s - PART_S * np.arange(PARTS)[:, None]
    ends = np.searchsorted(stamps_s, begins_s, side="right") - 1
    complete = ((ends >= 0) & (counts[ends] > 0)).all(axis=0)
    parts = normalised[ends]
    mean = parts.mean(axis=0)
    variance = np.square(parts - mean).sum(axis=(0, 2)) / (2 * (PARTS - 1))
    size = np.hypot(*mean.T) * np.sqrt(PARTS / np.maximum(variance, 1.0))
    return np.asarray(complete & (size > config.drift_sigmas))
