"""The yaw at positions that were measured without it.

Filters start all round, for the carrier as identified and for the corners of its uncertainty.
Their yaws are mixed; where one that the positions do not rule out lies far from the others, the
yaw cannot be estimated. Filters over the positions before and after each one share no position but
that: where they disagree by more than they state, the standard deviation is raised.
"""

from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import OdometryError
from odometry.geometry.angles import wrap
from odometry.positions.carrier import Carrier
from odometry.positions.smoother import Filtered, Way, filtered, smoothed
from odometry.windows.recorded.record import ODOMETRY_GAP

STARTS = 12  # headings all round
FAR_RAD = np.radians(20.0)  # of another yaw that leaves it undetermined
RULED_OUT = 1e-3  # share of the probability of the best, below which a start is ruled out
SURE_RAD = 0.35  # of both filters, where their disagreement counts
# 95 % are within 2 of them on 19 recordings (tests/studies/identification/positions_yaw.py).
LASTING = 2.5  # slip lasts, so that the error of yaw is so many of the filter's standard deviations
LEAST_RAD = np.radians(3.0)
LARGEST_RAD = np.radians(30.0)  # a larger one is of no use
LEAST_SHARE = 0.5  # of the positions, at which the yaw must be estimated


class PositionsYaw(NamedTuple):
    """Yaw (M,) at each position and its standard deviation (M,) [rad]; NaN where not estimated.

    `disagreement` is the root mean square difference of the yaws by earlier and by later positions
    alone, in units of what they state; NaN where neither is ever sure.
    """

    yaw_rad: FloatArray
    sigma_rad: FloatArray
    disagreement: float

    @property
    def share(self) -> float:
        """Share of the positions at which the yaw is estimated."""
        return float(np.isfinite(self.yaw_rad).mean())


def yaw_at_positions(carrier: Carrier) -> PositionsYaw:
    """Yaw at the positions that a carrier moves between.

    Raises
    ------
    OdometryError
        If the yaw is estimated at fewer than LEAST_SHARE of the positions.
    """
    starts_rad = carrier.first_yaw_rad + np.arange(STARTS) * 2 * np.pi / STARTS
    way = _way(carrier, np.repeat(carrier.steps, STARTS, axis=0))
    forwards = filtered(way, np.tile(starts_rad, len(carrier.steps)))
    poses, covariances = smoothed(forwards)
    weights = _weights(forwards)
    yaws_rad, variances = poses[..., 2], covariances[..., 2, 2]
    mean_rad = np.angle(np.exp(1j * yaws_rad) @ weights)
    away_rad = np.abs(wrap(yaws_rad - mean_rad[:, None]))
    possible = weights > RULED_OUT * weights.max()
    sigma_rad = np.sqrt((away_rad**2 + variances) @ weights)
    best = int(np.argmax(forwards.log_likelihoods[:STARTS]))
    disagreement = _disagreement(carrier, forwards, best, float(yaws_rad[-1, best]))
    sigma_rad = np.hypot(LASTING * np.fmax(1.0, disagreement) * sigma_rad, LEAST_RAD)
    known = (away_rad[:, possible].max(axis=1) < FAR_RAD) & (sigma_rad < LARGEST_RAD)
    found = PositionsYaw(
        np.where(known, mean_rad, np.nan), np.where(known, sigma_rad, np.nan), disagreement
    )
    if np.isnan(disagreement) or found.share < LEAST_SHARE:
        raise OdometryError(
            f"{carrier.record.run.folder}: yaw was not measured, and the positions (noise "
            f"{np.sqrt(carrier.position_variance_m2):.2g} m) do not determine it: at "
            f"{100 * (1 - found.share):.0f} % of them, headings more than "
            f"{np.degrees(FAR_RAD):.0f} degrees apart agree with them, or none is known well; "
            "expected a measured yaw, better positions, or longer drives between turns"
        )
    return found


def _way(carrier: Carrier, steps: FloatArray) -> Way:
    return Way(
        carrier.record.poses[:, :2],
        steps,
        carrier.step_variances,
        carrier.drifts,
        carrier.drift_sigmas,
        carrier.position_variance_m2,
        carrier.record.breaks == ODOMETRY_GAP,
    )


def _weights(of: Filtered) -> FloatArray:
    """Probability (H,) of each filter: all carriers the same, the starts of one by likelihood.

    Positions with large residuals have less information: the likelihood is lowered by that.
    """
    by_carrier = of.log_likelihoods.reshape(-1, STARTS)
    surprise = max(1.0, float(of.surprise[np.argmax(by_carrier[0])]))
    weights = np.exp((by_carrier - by_carrier.max(axis=1, keepdims=True)) / surprise)
    weights /= weights.sum(axis=1, keepdims=True)
    return np.asarray(weights.ravel() / len(weights))


def _disagreement(carrier: Carrier, of: Filtered, best: int, last_yaw_rad: float) -> float:
    back = _way(carrier, np.repeat(carrier.steps[:1], STARTS, axis=0)).backwards()
    backwards = filtered(back, last_yaw_rad + np.arange(STARTS) * 2 * np.pi / STARTS)
    other = int(np.argmax(backwards.log_likelihoods))
    before, after = of.states[:, best, 2], backwards.states[::-1, other, 2]
    variances = np.stack([of.covariances[:, best, 2, 2], backwards.covariances[::-1, other, 2, 2]])
    sure = (variances < SURE_RAD**2).all(axis=0)
    if not sure.any():
        return np.nan
    off = wrap(before - after)[sure] ** 2 / variances.sum(axis=0)[sure]
    return float(np.sqrt(np.mean(off)))
