"""Slip factors that change faster than they are expected to: wheels slip for a while.

A short patch of ice, mud or gravel moves them by many standard deviations within seconds. What
comes after may be another change, so that for a while they may walk faster.
"""

import math
from typing import NamedTuple

from odometry.estimation.measurement import Gaussian
from odometry.estimation.transition import ALPHA_LEFT, ALPHA_RIGHT

SPAN_S, SIGMAS = 3.0, 4.0  # a change within so long, in standard deviations of before
LASTS_S, WALK = 20.0, 10.0  # after it, and the factor on the noise of the random walk


class SlipWatch(NamedTuple):
    """What is remembered of the slip factors.

    Attributes
    ----------
    since_s : float
        Stamp at which they were these.
    terrain : str
        In force then.
    left, right, sigma_left, sigma_right : float
        Both factors and their standard deviations then.
    until_s : float
        Stamp until which they may walk faster.
    """

    since_s: float
    terrain: str
    left: float
    right: float
    sigma_left: float
    sigma_right: float
    until_s: float = -math.inf

    def walk(self, stamp_s: float) -> float:
        """Factor on the noise of their random walk."""
        return WALK if stamp_s < self.until_s else 1.0


def watched(watch: SlipWatch | None, belief: Gaussian, stamp_s: float, terrain: str) -> SlipWatch:
    """The watch after a pose, by the state estimate (9,), (9, 9); on another terrain anew."""
    mean, covariance = belief
    left, right = mean[ALPHA_LEFT:].tolist()
    until_s = -math.inf
    if watch is not None and terrain == watch.terrain:
        if stamp_s - watch.since_s <= SPAN_S:
            changed = abs(left - watch.left) > SIGMAS * watch.sigma_left
            changed |= abs(right - watch.right) > SIGMAS * watch.sigma_right
            return watch._replace(until_s=stamp_s + LASTS_S) if changed else watch
        until_s = watch.until_s
    sigma_left = math.sqrt(max(covariance[ALPHA_LEFT, ALPHA_LEFT], 0.0))
    sigma_right = math.sqrt(max(covariance[ALPHA_RIGHT, ALPHA_RIGHT], 0.0))
    return SlipWatch(stamp_s, terrain, left, right, sigma_left, sigma_right, until_s)
