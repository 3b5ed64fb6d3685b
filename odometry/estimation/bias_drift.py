"""A bias of the gyroscope that drifts, too slowly for a step and faster than the filter follows."""

import math
from typing import NamedTuple

import numpy as np

from odometry.estimation.bias_watch import SPANS, BiasWatch

COUNT = 16  # last spans, of which either half must show a drift, ...
SIGMAS, LEAST_RAD_S = 4.0, 0.003  # ... by so much in the mean, and half of it in either half
NOISY_RAD_S, MOST_WALK = 0.05, 10.0  # scatter at which the walk stays as given; largest factor
STILL_OF_IT = COUNT // 2  # spans that belong to the bias of the later half


class Drift(NamedTuple):
    """A drift that was found.

    Attributes
    ----------
    told : (float, float)
        The bias of the last spans and its standard deviation [rad/s].
    walk : float
        Factor on the noise of the bias's random walk from now on.
    """

    told: tuple[float, float]
    walk: float


def drifted_bias(watch: BiasWatch, believed_rad_s: float) -> Drift | None:
    """The bias where the last spans show a drift.

    The scatter of all spans about a line tells how far the mean of some is off, as if it had no
    memory. Treads are not asked: what is learned of them follows a slow drift. A reference whose
    own yaw drifts by so much is taken for the gyroscope's. Count and sigmas were chosen on the 19
    recordings of data/motion that are not among the seven by which the odometer is judged: no
    clean one shows a drift.
    """
    biases = np.array(watch.biases_rad_s)
    if len(biases) < SPANS or watch.since < COUNT:
        return None
    moments = np.arange(len(biases)) - (len(biases) - 1) / 2
    slope = float(moments @ biases) / float(moments @ moments)
    scatter = float((biases - slope * moments).std())
    halves = biases[-COUNT:].reshape(2, -1).mean(axis=1) - believed_rad_s
    mean = float(halves.mean())
    least = max(SIGMAS * scatter / math.sqrt(COUNT), LEAST_RAD_S)
    if abs(mean) < least or halves.prod() < 0 or np.abs(halves).min() < least / 2:
        return None
    told = believed_rad_s + float(halves[1]), scatter / math.sqrt(STILL_OF_IT)
    return Drift(told, min(max(NOISY_RAD_S / scatter, 1.0), MOST_WALK) if scatter else MOST_WALK)
