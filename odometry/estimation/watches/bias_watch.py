"""A bias of the gyroscope that steps or drifts faster than the filter follows."""

import math
from typing import NamedTuple

import numpy as np

from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian
from odometry.estimation.transition import GYRO_BIAS

SPAN_S = 1.0  # over which gyroscope and poses are compared
SPANS = 48  # that are remembered
LEAST_SPANS, LEAST_RUNS = 10, 3  # from which on the scatter of runs of spans is known
RUNS = (4, 8)  # numbers of last spans from which a bias is determined
SIGMAS, LEAST_RAD = (
    6.0,
    0.08,
)  # by which its turn over these must differ from the estimated one
TREADS_SHARE = 0.4  # of the difference that the treads must show too: else the poses are off
OPEN_SHARE = 0.25  # of a change, by which it may be off: it began in the midst of a span
POSE_S = 0.5  # since the last pose; the estimated yaw is of use only so long


class Rates(NamedTuple):
    """Yaw rates over a step [rad/s]: NaN where not known."""

    by_gyroscope: float
    by_poses: float
    by_treads: float


class BiasWatch(NamedTuple):
    """Evidence of poses and gyroscope on its bias.

    Attributes
    ----------
    turned_rad, past_treads_rad, lasts_s : float
        How much more than the estimate, and than the treads, the gyroscope turned in the span
        that is not over yet.
    biases_rad_s, by_treads_rad_s : tuple of float
        The same by time over the last spans.
    since : int
        How many of them belong to the present bias.
    posed_s : float
        Stamp of the last pose that was accepted.
    walk : float
        Factor on the noise of the bias's random walk: above 1 once a drift was found.
    """

    turned_rad: float = 0.0
    past_treads_rad: float = 0.0
    lasts_s: float = 0.0
    biases_rad_s: tuple[float, ...] = ()
    by_treads_rad_s: tuple[float, ...] = ()
    since: int = 0
    posed_s: float = -math.inf
    walk: float = 1.0


def watched(
    watch: BiasWatch, rates_rad_s: Rates, step_s: float, stamp_s: float, *, posed: bool
) -> BiasWatch:
    """The watch after a step.

    Parameters
    ----------
    watch : BiasWatch
    rates_rad_s : Rates
        Over the step.
    step_s, stamp_s : float
        Its duration and its end.
    posed : bool
        Whether a pose was accepted at its end.
    """
    turned_rad, past_treads_rad, lasts_s, biases, by_treads, since, posed_s, walk = watch
    posed_s = stamp_s if posed else posed_s
    by_gyroscope, by_poses, of_treads = rates_rad_s
    if math.isnan(by_gyroscope + of_treads) or stamp_s - posed_s > POSE_S:
        return BiasWatch(0.0, 0.0, 0.0, biases, by_treads, since, posed_s, walk)
    turned_rad += (by_gyroscope - by_poses) * step_s
    past_treads_rad += (by_gyroscope - of_treads) * step_s
    lasts_s += step_s
    if lasts_s < SPAN_S:
        sums = turned_rad, past_treads_rad, lasts_s
        return BiasWatch(*sums, biases, by_treads, since, posed_s, walk)
    return BiasWatch(
        biases_rad_s=(*biases, turned_rad / lasts_s)[-SPANS:],
        by_treads_rad_s=(*by_treads, past_treads_rad / lasts_s)[-SPANS:],
        since=min(since + 1, SPANS),
        posed_s=posed_s,
        walk=walk,
    )


def changed_bias(watch: BiasWatch, estimated_rad_s: float) -> tuple[float, float] | None:
    """The bias of the last spans where it is another, and its standard deviation [rad/s].

    Runs of spans that follow each other give the error of the mean of one: by noise of poses,
    delays and the gyroscope's scale, which differ by the recording.
    """
    biases = np.array(watch.biases_rad_s)
    if len(biases) < LEAST_SPANS:
        return None
    sums = np.append(0.0, np.cumsum(biases))
    for count in RUNS:
        if count > watch.since or len(biases) < LEAST_RUNS * count:
            return None
        least = LEAST_RAD / (count * SPAN_S)
        halves = biases[-count:].reshape(2, -1).mean(axis=1) - estimated_rad_s
        if np.abs(halves).min() <= least / 2:
            continue  # as a rule; the median takes longer
        means = (sums[count:] - sums[:-count]) / count
        apart = np.abs(means[count:] - means[:-count])
        sigma = 1.4826 * float(np.median(apart)) * math.sqrt(1 / 2)
        bias = float(means[-1])
        least = max(SIGMAS * sigma, least)
        sure = abs(halves.sum()) > 2 * least and np.abs(halves).min() > least / 2
        if sure and halves.prod() > 0 and treads_agree(watch, count, bias, estimated_rad_s):
            return bias, sigma
    return None


def treads_agree(watch: BiasWatch, count: int, bias_rad_s: float, estimated_rad_s: float) -> bool:
    """Whether the treads show in the last spans that the bias is another than the estimated one."""
    past_treads = sum(watch.by_treads_rad_s[-count:]) / count
    return (past_treads - estimated_rad_s) / (bias_rad_s - estimated_rad_s) > TREADS_SHARE


def changed(belief: Gaussian, bias_rad_s: tuple[float, float]) -> Gaussian:
    """The state estimate with another bias, uncorrelated with the rest."""
    mean, covariance = belief[0].copy(), belief[1].copy()
    mean[GYRO_BIAS] = bias_rad_s[0]
    covariance[GYRO_BIAS], covariance[:, GYRO_BIAS] = 0.0, 0.0
    change = (bias_rad_s[0] - float(belief[0][GYRO_BIAS])) * OPEN_SHARE
    covariance[GYRO_BIAS, GYRO_BIAS] = bias_rad_s[1] ** 2 + change**2
    return mean, covariance


def change_event(estimated_rad_s: float, bias_rad_s: float, stamp_s: float) -> FilterEvent:
    """The event of a bias that is another."""
    text = (
        f"the estimated bias of the gyroscope was corrected from {estimated_rad_s:.4f} to "
        f"{bias_rad_s:.4f} rad/s, by the poses"
    )
    return FilterEvent("gyroscope_bias_changed", stamp_s, stamp_s, text, (bias_rad_s,))
