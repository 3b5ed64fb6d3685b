"""Latencies that change within a recording: between which sensors, how, and of which of them."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once
from odometry.checks.stamps.rates_by_delay import GRID_S, rate, width_s
from odometry.checks.stamps.timing import (
    MOST_LAG_S,
    headings_by_sensor,
    lags_of,
    pose_period_s,
)
from odometry.checks.statistics.lag import LEAST_PIECE_S, Lags, Signal, lags_in_pieces
from odometry.checks.statistics.latency_course import STEP, LatencyCourse, fitted, latency_course

PAIRS = (("pose", "gyroscope"), ("pose", "treads"), ("treads", "gyroscope"))
SURE = 10.0  # of Schwarz's criterion: "very strong" evidence (Kass and Raftery 1995)
LEAST_S, OF_TREADS_S = 0.1, 0.2  # of the change: slip delays turns as well
EDGE_S = 0.3  # from the largest lag that is searched for: the course may go on beyond it
FEWEST_SHARED = 4  # pieces
HALF, SIGMAS = 0.5, 2.0  # of a change, that another pair surely shares, or surely does not


@dataclass(frozen=True)
class Changing:
    """A latency of the first of two sensors behind the second that changes.

    `odd` is the sensor whose stamps change; "" where that cannot be determined.
    """

    pair: tuple[str, str]
    course: LatencyCourse
    odd: str

    @property
    def suspects(self) -> tuple[str, ...]:
        """The odd one, or both of the pair."""
        return (self.odd,) if self.odd else self.pair

    @property
    def sensor(self) -> str:
        """The odd one, or the first where that cannot be determined."""
        return self.suspects[0]

    def late_s(self, stamps_s: FloatArray) -> FloatArray:
        """How late the stamps (N,) of the sensor are, against the other one of the pair."""
        sign = 1.0 if self.sensor == self.pair[0] else -1.0
        return sign * self.course.at(stamps_s)


@once
def changing(evidence: Evidence) -> Changing | None:
    """The surest latency that changes, that of poses behind the gyroscope before others."""
    signals = headings_by_sensor(evidence)
    lags = {pair: _lags(evidence, pair, signals) for pair in PAIRS if signals.keys() >= set(pair)}
    courses = {
        pair: course
        for pair, of in lags.items()
        if (course := latency_course(of)) is not None and _changes(evidence, pair, of, course)
    }
    if not courses:
        return None
    pair = max(courses, key=lambda of: (of == PAIRS[0], courses[of].gain))
    course = courses[pair]
    if course.kind == STEP:
        course = replace(course, moment_s=_moment_s(evidence, pair, course))
    return Changing(pair, course, _odd(lags, pair, course))


def _lags(evidence: Evidence, pair: tuple[str, str], signals: dict[str, Signal]) -> Lags:
    begin_s, end_s = evidence.stamps_s[[0, -1]]
    edges_s = np.linspace(begin_s, end_s, int((end_s - begin_s) / LEAST_PIECE_S) + 2)
    late, early = (partial(rate, signals[name]) for name in pair)
    return lags_in_pieces(late, early, edges_s, width_s(evidence, pair), MOST_LAG_S)


def _changes(evidence: Evidence, pair: tuple[str, str], lags: Lags, course: LatencyCourse) -> bool:
    """Whether it surely does, by what matters, within the lags that are searched for."""
    period_s = pose_period_s(evidence) if "pose" in pair else evidence.period_s
    least_s = max(OF_TREADS_S if "treads" in pair else LEAST_S, period_s)
    whole = lags_of(evidence).get(pair)
    grows_s = abs(whole.drift) * evidence.duration_s if whole is not None else 0.0
    inside = max(grows_s, np.abs(lags.lags_s).max()) < MOST_LAG_S - EDGE_S
    return bool(course.gain > SURE and course.extent_s > least_s and inside)


def _moment_s(evidence: Evidence, pair: tuple[str, str], course: LatencyCourse) -> float:
    """The stamp between two pieces at which one delay explains the turns no more, but the other."""
    late, early = (headings_by_sensor(evidence)[name] for name in pair)
    over_s = width_s(evidence, pair)
    at_s = np.arange(course.moment_s - LEAST_PIECE_S, course.moment_s + LEAST_PIECE_S, GRID_S)
    before, after = (
        np.nan_to_num(rate(late, at_s, over_s) - rate(early, at_s - delay_s, over_s)) ** 2
        for delay_s in course.seconds[[0, -1]]
    )
    return float(at_s[int(np.argmin(np.cumsum(before - after)))])


def _odd(lags: dict[tuple[str, str], Lags], pair: tuple[str, str], course: LatencyCourse) -> str:
    """The sensor whose lag behind a third one changes as well, and that of the other does not."""
    (third,) = {name for of in PAIRS for name in of} - set(pair)
    shares = {name: _share(lags, (name, third), course) for name in pair}
    for name, other in (pair, pair[::-1]):
        (share, sigma), (left, left_sigma) = shares[name], shares[other]
        share, left = np.abs([share, left])
        moves = share - SIGMAS * sigma > HALF
        stays = left + SIGMAS * left_sigma < HALF
        if (moves or stays) and share > HALF > left:
            return name
    return ""


def _share(
    lags: dict[tuple[str, str], Lags], pair: tuple[str, str], course: LatencyCourse
) -> tuple[float, float]:
    """How much of the course a pair has, and its standard deviation: HALF and 1 where not known."""
    found = lags.get(pair, lags.get(pair[::-1]))
    if found is None or len(found.lags_s) < FEWEST_SHARED:
        return HALF, 1.0
    by_s = course.at(found.middles_s)
    if np.ptp(by_s) < HALF * course.extent_s:
        return HALF, 1.0
    of, covariance, chi2 = fitted(found, np.stack([np.ones(len(by_s)), by_s], axis=1))
    return float(of[1]), float(np.sqrt(covariance[1, 1] * chi2 / (len(by_s) - 2)))
