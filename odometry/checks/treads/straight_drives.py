"""Straight drives that curve by what the treads say: one tread reads more than the other."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion, turns_both_ways
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.statistics.relation import relation

# Of 31 real recordings the lower bounds are at most 0.046 (a Husky on deflated tyres), and 0.025 of
# all but that one.
MORE = 0.06
FAR_MORE = 40.0  # %: no robot pulls so much to one side, and no tyre or gear is off by it
SURE = 3.0  # standard deviations of a lower bound
STRAIGHT = 0.3  # share of the faster tread by which both differ at most
MOVING = 0.2  # of the ordinary fastest speed
HELD = 0.9  # share of the turns explained: else slip prevails
LEAST_WINDOWS = 15  # on straight stretches
MEDIAN = 1.2533  # standard deviation of a median, in those of a mean (of a normal distribution)


@dataclass(frozen=True)
class Excess:
    """By what share of its own the left tread reads more than the right one (less if negative).

    `all` and `straight` are of all windows and of the straight ones, each with one standard
    deviation; `windows` counts the straight ones.
    """

    of: str
    all: float
    all_sigma: float
    straight: float
    straight_sigma: float
    windows: int

    @property
    def least(self) -> float:
        """Lower bound of its size; 0 where both estimates do not have one sign."""
        if self.all * self.straight <= 0:
            return 0.0
        pairs = ((self.all, self.all_sigma), (self.straight, self.straight_sigma))
        return max(min(abs(size) - SURE * sigma for size, sigma in pairs), 0.0)


def straight_drives(evidence: Evidence) -> Iterator[Finding]:
    """A note where gyroscope or poses say that straight drives are none by the treads.

    A tread that reads too much and a robot that pulls to one side have the same effect; far more
    than either makes has no known cause.
    """
    found = list(_excesses(evidence))
    if (
        not found
        or not turns_both_ways(evidence.uniform)
        or any(one.least < MORE or one.all * found[0].all < 0 for one in found)
    ):
        return
    more = float(np.mean([one.straight for one in found]))
    side, other = ("left", "right") if more > 0 else ("right", "left")
    percent = 100 * ((1 + abs(more) / 2) / (1 - abs(more) / 2) - 1)
    sigma = 100 * max(one.straight_sigma for one in found)
    seen = (
        f"on straight stretches ({min(one.windows for one in found)} windows) the {side} tread "
        f"reads {percent:.1f} +- {sigma:.1f} % more than the {other} one, by the turns of "
        f"{' and '.join(one.of for one in found)}"
    )
    if percent > FAR_MORE:
        yield disagreement(seen)
        return
    yield Finding(
        "straight_drives",
        Level.NOTE,
        seen,
        "The treads have different scales (wheel size, ticks per turn, gear, a tyre's pressure), "
        "or the robot itself pulls to one side (its load, its tracks, a slope across its way): "
        "both are possible",
        "Lift the robot, turn each wheel ten times and compare the columns; where they are equal "
        "it is the robot, which a model of two sides (icr) has",
    )


def _excesses(evidence: Evidence) -> Iterator[Excess]:
    """By what one tread reads more, by each sensor of turns that determines it."""
    found = []
    if evidence.yaw_rate is not None:
        m = evidence.uniform
        found.append(_excess("the gyroscope", m, m.gyroscope_rad, (m.lasts_s,), evidence))
    if evidence.yaw_measured:
        m = evidence.motion
        found.append(_excess("the poses", m, evidence.pose_turn_rad, (), evidence))
    yield from (one for one in found if one is not None)


def _excess(
    name: str, m: Motion, turns: FloatArray, bias: tuple[FloatArray, ...], evidence: Evidence
) -> Excess | None:
    """`turn = slope (right - left + excess mean) + bias`; None where it is not determined."""
    fit = relation(turns, m.difference_m, m.mean_m, *bias)
    if fit is None or fit.explained < HELD or not fit.certain() or fit.slope < 0:
        return None
    faster = np.maximum(np.abs(m.left_m), np.abs(m.right_m))
    straight = np.isfinite(turns) & (np.abs(m.difference_m) < STRAIGHT * faster)
    straight &= faster > MOVING * evidence.fastest_m_s * m.lasts_s
    if straight.sum() < LEAST_WINDOWS:
        return None
    rate = fit.coefficients[2] if bias else 0.0
    turned = (turns - rate * m.lasts_s)[straight] / fit.slope - m.difference_m[straight]
    by_window = turned / m.mean_m[straight]
    middle = float(np.median(by_window))
    spread = 1.4826 * float(np.median(np.abs(by_window - middle)))
    return Excess(
        name,
        float(fit.coefficients[1] / fit.slope),
        float(fit.sigmas[1] / fit.slope),
        middle,
        MEDIAN * spread / float(np.sqrt(straight.sum())),
        int(straight.sum()),
    )
