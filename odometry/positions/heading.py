"""Runs whose positions were measured without yaw: the yaw is estimated from the positions.

Filters start all round, for the carrier as identified and for the corners of its uncertainty.
Their yaws are mixed; where one that the positions do not rule out lies far from the others, the
yaw cannot be estimated. Filters over the positions before and after each one share no position but
that: where they disagree by more than they state, the standard deviation is raised.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import OdometryError
from odometry.geometry.angles import wrap
from odometry.positions.carrier import Carrier, carrier_of
from odometry.positions.smoother import Filtered, Way, filtered, smoothed
from odometry.positions.timing import Timing, timings_of
from odometry.run import Run
from odometry.windows.measured_poses import YAW_FOUND, lacks_yaw
from odometry.windows.record import ODOMETRY_GAP

STARTS = 12  # headings all round
FAR_RAD = np.radians(20.0)  # of another yaw that leaves it undetermined
RULED_OUT = 1e-3  # share of the probability of the best, below which a start is ruled out
SURE_RAD = 0.35  # of both filters, where their disagreement counts
# Chosen on 19 recordings (`tests/studies/positions_yaw.py`), so that 95 % are within 2 of them:
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
    before, after = of.posterior[:, best, 2], backwards.posterior[::-1, other, 2]
    variances = np.stack(
        [of.posterior_of[:, best, 2, 2], backwards.posterior_of[::-1, other, 2, 2]]
    )
    sure = (variances < SURE_RAD**2).all(axis=0)
    if not sure.any():
        return np.nan
    off = wrap(before - after)[sure] ** 2 / variances.sum(axis=0)[sure]
    return float(np.sqrt(np.mean(off)))


NOISE_LENGTHS = 28.0  # a window so many times longer than the noise is off by 0.05 m per m for it


@dataclass(frozen=True)
class FoundHeading:
    """A run with found yaws, and how good they are.

    Attributes
    ----------
    run : Run
        pose.csv with a yaw in each row that has x and y within the time of odometry.csv, where
        the positions determine it, and a column YAW_FOUND with its standard deviation [rad]. Its
        positions are as they were.
    position_sigma_m : float
        Of a measured position, as the shapes of stretches show it.
    yaw_sigma_rad : float
        Median of the column. Errors of neighbouring yaws are correlated.
    by_gyroscope : bool
        Whether a gyroscope carried the yaw between positions, and not the treads.
    estimated_share : float
        Share of the positions at which the yaw could be estimated.
    positions_late_s : float
        How late positions are beside treads and gyroscope, which is undone while the yaw is found;
        the stamps of `run` are as they were.
    """

    run: Run
    position_sigma_m: float
    yaw_sigma_rad: float
    by_gyroscope: bool
    estimated_share: float = 1.0
    positions_late_s: float = 0.0

    @property
    def least_horizon_m(self) -> float:
        """Wheel travel over which the noise of positions is a small error per metre."""
        return NOISE_LENGTHS * self.position_sigma_m

    @property
    def words(self) -> str:
        """A sentence for a reader."""
        by = "by the gyroscope" if self.by_gyroscope else "by the treads alone"
        unknown = 1 - self.estimated_share
        except_for = (
            f"; at {100 * unknown:.1f} % of the positions it cannot be estimated" if unknown else ""
        )
        late_s = self.positions_late_s
        when = f"{abs(late_s):.2f} s {'late' if late_s > 0 else 'early'}"
        timing = f"; positions are {when} beside the gyroscope" if late_s else ""
        return (
            f"{self.run.folder}: yaw was not measured; it is found from positions with a noise of "
            f"{self.position_sigma_m:.2g} m, to about {np.degrees(self.yaw_sigma_rad):.2g} "
            f"degrees, and carried from one to the next {by}{except_for}{timing}"
        )


class Headed(NamedTuple):
    """Runs with a yaw, and the headings that were found for those that lacked one."""

    runs: tuple[Run, ...]
    found: tuple[FoundHeading, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """A sentence for each found heading."""
        return tuple(each.words for each in self.found)

    @property
    def least_horizon_m(self) -> float:
        """The longest of those of the found headings; 0 where none was found."""
        return max((each.least_horizon_m for each in self.found), default=0.0)


def headed(runs: Sequence[Run]) -> Headed:
    """Runs with a yaw: `found_heading` of those that lack one, all of one recorder.

    Raises
    ------
    OdometryError
        See `found_heading`.
    """
    lacking = [i for i, run in enumerate(runs) if needs_heading(run)]
    timings = timings_of([runs[i] for i in lacking])
    found = {i: found_heading(runs[i], timing) for i, timing in zip(lacking, timings, strict=True)}
    with_yaw = tuple(found[i].run if i in found else run for i, run in enumerate(runs))
    return Headed(with_yaw, tuple(found.values()))


def needs_heading(run: Run) -> bool:
    """Whether yaw is lacking and was not found."""
    return lacks_yaw(run) and (run.pose is None or YAW_FOUND not in run.pose)


def found_heading(run: Run, timing: Timing | None = None) -> FoundHeading:
    """Find the yaw of a run from its positions, and their timing where it is not given.

    A model identified on the shapes of stretches (`identification.from_positions`) or the
    gyroscope carries the robot between positions; smoothers put its pose among all of them.

    Raises
    ------
    OdometryError
        If there are too few positions for a model, they contradict the treads, or do not determine
        the yaw (`yaw_from_positions`).
    """
    if timing is None:
        (timing,) = timings_of([run])
    late_s = timing.positions_late_s
    carrier = carrier_of(timing.undone(run))
    found = yaw_at_positions(carrier)
    if run.pose is None:
        return FoundHeading(run, np.nan, np.nan, carrier.by_gyroscope)
    rows = np.searchsorted(run.pose.stamps_s - late_s, carrier.record.pose_s)
    yaw, sigma = np.full((2, len(run.pose)), np.nan)
    yaw[rows], sigma[rows] = found.yaw_rad, found.sigma_rad
    columns = {**run.pose.columns, "yaw": yaw, YAW_FOUND: sigma}
    return FoundHeading(
        replace(run, pose=replace(run.pose, columns=columns)),
        float(np.sqrt(carrier.position_variance_m2)),
        float(np.nanmedian(found.sigma_rad)),
        carrier.by_gyroscope,
        found.share,
        late_s,
    )
