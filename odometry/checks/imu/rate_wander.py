"""Headings of gyroscope and poses that part at a rate which changes slowly."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from odometry.arrays import FloatArray, IntArray, median
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import Mend, changed, in_turn
from odometry.checks.imu.gyroscope_by_poses import headings_apart
from odometry.checks.statistics.relation import relation
from odometry.checks.turns.heading_spans import HeadingSpans, heading_spans
from odometry.geometry.se3 import rotation_from_roll_pitch_yaw
from odometry.recording.run import Run
from odometry.recording.sensors import GYRO_AXES

SPANS_S = (5.0, 1.5)  # over which both are compared
ENDS = 0.1, 0.9  # quantiles of the rates that are compared
PART_S = 10.0  # of one rate: short against a minute, long against a turn
FEWEST = 8  # parts
# Between these quantiles. A bias that warms up by 0.004 rad/s has 0.006 with noise; real recordings
# as they are pass it by noise, which differs from part to part.
LEAST_RAD_S = 0.01
# How slowly they change, in standard deviations of noise, times their spread by their own noise. Of
# 13 real recordings and 60 simulated drives as they are it is 1.3 at most.
SURELY = 3.0
TURNS_LEAVE = 0.4  # of the squares of the rates, where turns explain them
# Share of the wander that the treads find in the gyroscope, and not in the poses: 1 where it alone
# is wrong, 0 where the poses alone are.
ALONE, CERTAIN = 0.35, 3.0


@dataclass(frozen=True)
class RateWander:
    """What the gyroscope turns beside the poses in K parts, and whose fault it is.

    Attributes
    ----------
    stamps_s, rates_rad_s : (K,)
        Middles of the parts, and the rates there.
    share, sigma : float
        Of the wander that is in the gyroscope by the treads, and its standard deviation.
    """

    stamps_s: FloatArray
    rates_rad_s: FloatArray
    share: float
    sigma: float

    @property
    def by_gyroscope(self) -> bool:
        """Whether treads and poses agree against the gyroscope."""
        return abs(self.share - 1) < ALONE and self.share - CERTAIN * self.sigma > 0.5

    @property
    def by_poses(self) -> bool:
        """Whether treads and gyroscope agree against the poses."""
        return abs(self.share) < ALONE and self.share + CERTAIN * self.sigma < 0.5


def headings_wander(evidence: Evidence) -> Iterator[Finding]:
    """A gyroscope whose bias wanders, or poses whose heading does; treads say which, or neither."""
    found = rate_wander(evidence)
    if found is None:
        return
    lowest, highest = np.quantile(found.rates_rad_s, ENDS)
    seen = (
        f"gyro_z turns by {lowest:+.3f} to {highest:+.3f} rad/s more than measured yaw, which "
        f"changes slowly (parts of {PART_S:g} s)"
    )
    bias = "bias of the gyroscope wanders (it warms up, or shakes)"
    yaw = "heading of the poses drifts (a map, or an inertial heading that was not corrected)"
    remedy = "Compare gyro_z at rest, at several times: what changes there is of the gyroscope"
    if found.by_gyroscope:
        large = bool(headings_apart(evidence))
        yield Finding(
            "headings_wander",
            Level.WARNING if large else Level.NOTE,
            f"{seen}; the treads turn as the poses do",
            f"The {bias}",
            "One constant does not correct it: `run` follows it while poses have a yaw, and is too "
            "sure of its heading where they are missing for half a minute",
            mend=_with_rates_undone(found) if large else None,
        )
    elif found.by_poses:
        seen = f"{seen}; the treads turn as the gyroscope does"
        yield Finding("headings_wander", Level.NOTE, seen, f"The {yaw}", remedy)
    else:
        cause = f"Either the {bias}; or the {yaw}: the treads do not say which"
        yield Finding("headings_wander", Level.NOTE, seen, cause, remedy)


@once
def rate_wander(evidence: Evidence) -> RateWander | None:
    """The wander of gyroscope against poses; None where it is small, noise, or constant."""
    spans, fit = heading_spans(evidence, *SPANS_S), evidence.pose_turn_by_gyroscope
    if spans is None or fit is None:
        return None
    apart = fit.slope * spans.gyroscope_rad - spans.pose_rad
    parts = _parts(evidence, spans)
    rates = np.array([np.median(apart[rows] / spans.lasts_s[rows]) for _, rows in parts])
    if len(rates) < FEWEST or np.ptp(np.quantile(rates, ENDS)) < LEAST_RAD_S:
        return None
    if _goes_with_turns(rates, spans, parts):
        return None
    numbers = np.array([number for number, _ in parts])
    if not _goes_on(numbers, rates, _noise(spans, apart / spans.lasts_s, parts)):
        return None
    stamps_s = evidence.stamps_s[0] + PART_S * (numbers + 0.5)
    return RateWander(stamps_s, rates, *_share(evidence, spans, parts, rates))


Parts = list[tuple[int, IntArray]]


def _parts(evidence: Evidence, spans: HeadingSpans) -> Parts:
    """Numbers of the parts, and rows of the spans whose middles are in each, of enough time."""
    middle_s = (spans.start_s + spans.end_s) / 2
    number = ((middle_s - evidence.stamps_s[0]) / PART_S).astype(int)
    order = np.argsort(number, kind="stable")
    present, first = np.unique(number[order], return_index=True)
    rows = zip(present.tolist(), np.split(order, first[1:]), strict=True)
    step_s = median(np.diff(spans.start_s))
    return [(part, of) for part, of in rows if _independent(spans, of, step_s) >= 1]


def _independent(spans: HeadingSpans, rows: IntArray, step_s: float) -> float:
    """How many of the spans do not overlap; one begins so long after another."""
    return min(len(rows) * step_s, PART_S) / median(spans.lasts_s[rows])


def _noise(spans: HeadingSpans, rates: FloatArray, parts: Parts) -> float:
    """Standard deviation of the rate of a part, by how spans within it differ."""
    step_s = median(np.diff(spans.start_s))
    squares = [
        np.median(np.abs(rates[rows] - np.median(rates[rows]))) ** 2
        / _independent(spans, rows, step_s)
        for _, rows in parts
    ]
    return 1.4826 * float(np.sqrt(np.mean(squares)))


def _goes_on(numbers: FloatArray, rates: FloatArray, noise: float) -> bool:
    """Whether rates (K,) change slowly from part to part, and by more than their noise.

    The ratio of von Neumann (1941): 2 of noise, with a standard deviation of two over the root of
    K; less of what takes minutes.
    """
    variance = float(np.var(rates))
    steps = np.diff(rates)[np.diff(numbers) == 1]
    if len(steps) < FEWEST - 1:
        return False
    slowly = (2 - float(np.mean(steps**2)) / variance) * np.sqrt(len(rates)) / 2
    return bool(slowly * np.sqrt(variance) / max(noise, 1e-9) > SURELY)


def _goes_with_turns(rates: FloatArray, spans: HeadingSpans, parts: Parts) -> bool:
    """Whether turns explain the rates (K,): a scale, of turns to one side or to both."""
    turning = spans.gyroscope_rad / spans.lasts_s
    by = np.array([[np.mean(turning[rows]), np.mean(np.abs(turning[rows]))] for _, rows in parts])
    rates, by = rates - rates.mean(), by - by.mean(axis=0)
    left = rates - by @ np.linalg.lstsq(by, rates, rcond=None)[0]
    return bool(left @ left < TURNS_LEAVE * (rates @ rates))


def _share(
    evidence: Evidence, spans: HeadingSpans, parts: Parts, rates: FloatArray
) -> tuple[float, float]:
    """Share of the wander that is in what the gyroscope turns beside the treads; its sigma."""
    left_m, right_m = (
        of(spans.end_s) - of(spans.start_s)
        for of in (evidence.integrals.left_m, evidence.integrals.right_m)
    )
    by_treads = relation(spans.gyroscope_rad, left_m, right_m, spans.lasts_s)
    if by_treads is None:
        return 0.5, np.inf
    beside = by_treads.residuals / spans.lasts_s
    beside = np.array([np.median(beside[rows]) for _, rows in parts])
    rates, beside = rates - rates.mean(), beside - beside.mean()
    square = float(rates @ rates)
    share = float(rates @ beside) / square
    left = beside - share * rates
    return share, float(np.sqrt(left @ left / (len(rates) - 2) / square))


def _with_rates_undone(found: RateWander) -> Mend:
    """The rates taken off what the robot turns about its z, in the axes of the sensor."""

    def mend(run: Run) -> Run:
        measured = run.yaw_rate
        by_imu = measured is not None and measured.file == "imu.csv"
        table = "imu" if by_imu else "odometry"
        beside = np.interp(getattr(run, table).stamps_s, found.stamps_s, found.rates_rad_s)
        attitude = np.array(run.sensors.imu_rad or (0.0, 0.0, 0.0)) if by_imu else np.zeros(3)
        parts = dict(zip(GYRO_AXES, rotation_from_roll_pitch_yaw(attitude)[2], strict=True))
        mends = [
            changed(table, name, partial(_less, part * beside))
            for name, part in parts.items()
            if part
        ]
        return in_turn(*mends)(run)

    return mend


def _less(beside: FloatArray, rates: FloatArray) -> FloatArray:
    return rates - beside
