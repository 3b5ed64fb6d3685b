"""Stamps of one file that step against those of the others: a clock that was set."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import stamps_moved
from odometry.checks.stamps.late_stamps import CLEARLY
from odometry.checks.stamps.latencies import changing
from odometry.checks.stamps.rates_by_delay import (
    PARTS,
    left_by_any_growing,
    moment_of,
    two_delays,
)
from odometry.checks.stamps.set_clocks import left_by_delays
from odometry.checks.stamps.timing import headings_by_sensor
from odometry.checks.statistics.latency_course import STEP
from odometry.checks.statistics.measured_between import gaps_between

DELAYS_S = np.arange(-2.5, 2.51, 0.05)
LEAST_S = 0.2  # of the step
# Share of the squares that two delays leave of what one leaves: 0.61 and more in 31 real
# recordings (0.87 where poses are one of the pair), 0.31 where a clock was set by 1.7 s.
HALF = 0.5
DIFFER = 0.02  # share of the turns not explained, below which two sensors agree as they are
# Share of the turns explained by the two, and the smaller lag: a clock is right before it is set
# or after. A gyroscope turned over half way seemed to be late by 0.95 s and then early by 2.05 s,
# with 0.83; where clocks were set it was 0.92 and more, and 0.05 s and less.
HELD, ON_TIME_S = 0.87, 0.2
GROWTHS_S = np.linspace(-2.5, 2.5, 21)  # of a lag that grows over the recording
NEAR_PARTS = 2.0  # of the time, within which the moment of a step is known


@dataclass(frozen=True)
class Step:
    """A lag of the first sensor of a pair behind the second that changes at a stamp."""

    pair: tuple[str, str]
    at_s: float
    before_s: float
    after_s: float

    def of(self, file: str, files: dict[str, str]) -> float:
        """By how much the stamps of one of the two files step ahead."""
        change_s = self.after_s - self.before_s
        return change_s if files[self.pair[0]] == file else -change_s


def stepping_clocks(evidence: Evidence) -> Iterator[Finding]:
    """A lag between two files that is one before a moment and another after it.

    Lags that grow, and turns that differ otherwise, are not explained by one step. Nor are
    those of which pieces of the recording show another course.
    """
    change = changing(evidence)
    if change is not None and change.course.kind != STEP:
        return
    files = {"pose": "pose.csv", "gyroscope": evidence.gyroscope_file, "treads": "odometry.csv"}
    pairs = [pair for pair in _apart(evidence) if files[pair[0]] != files[pair[1]]]
    steps = [step for pair in pairs if (step := _step(evidence, pair)) is not None]
    if not steps:
        return
    stepping = [{files[name] for name in step.pair} for step in steps]
    common = sorted(set.intersection(*stepping), key=list(files.values()).index)
    if not common:
        return
    file, step = common[0], steps[0]
    by_s = step.of(file, files)
    against = sorted(set.union(*stepping) - {file})
    either = "" if len(common) == 1 else f" or of {common[1]}"
    table = file.removesuffix(".csv")
    at_s = _at_a_gap(evidence, getattr(evidence.run, table).stamps_s, step.at_s)
    moment_s = evidence.run_time_s(at_s)
    yield Finding(
        "clock_set",
        Level.WARNING,
        f"stamps of {file} step by {by_s:+.2f} s against those of {' and '.join(against)} at about "
        f"{moment_s:.0f} s of run time",
        f"The clock of {file}{either} was set while recording; or rows were lost there, and the "
        "stamps of the others made up",
        f"Subtract {by_s:.2f} s from the later stamps of {file}, or cut with --from and --to",
        ((moment_s, moment_s),),
        mend=stamps_moved(table, at_s, -by_s),
    )


def _at_a_gap(evidence: Evidence, stamps_s: FloatArray, at_s: float) -> float:
    """The last stamp (N,) before a gap near a moment: a clock that is set ahead leaves one."""
    begins_s = gaps_between(stamps_s)[:, 0]
    near_s = begins_s[np.abs(begins_s - at_s) < NEAR_PARTS * evidence.duration_s / PARTS]
    return float(near_s[np.argmin(np.abs(near_s - at_s))]) if len(near_s) else at_s


def _apart(evidence: Evidence) -> Iterator[tuple[str, str]]:
    """Pairs of `headings_by_sensor` whose turns differ."""
    relations = {
        ("pose", "gyroscope"): evidence.pose_turn_by_gyroscope,
        ("pose", "treads"): evidence.pose_turn_by_treads,
        ("gyroscope", "treads"): evidence.gyroscope_by_treads,
    }
    known = headings_by_sensor(evidence)
    for pair, found in relations.items():
        agree = found is not None and 1 - found.explained < DIFFER
        if not agree and known.keys() >= set(pair):
            yield pair


def _step(evidence: Evidence, pair: tuple[str, str]) -> Step | None:
    found = left_by_delays(evidence, pair, DELAYS_S)
    if found is None:
        return None
    at_s, squares, whole = found
    left, before, after, share = two_delays(squares)
    before_s, after_s = float(DELAYS_S[before]), float(DELAYS_S[after])
    if min(abs(before_s), abs(after_s)) > ON_TIME_S:
        return None
    one = float(squares.sum(axis=1).min())
    if left > HALF * one or left > (1 - HELD) * whole or abs(after_s - before_s) < LEAST_S:
        return None
    along = np.linspace(-0.5, 0.5, len(at_s)) / (DELAYS_S[1] - DELAYS_S[0])
    growths = (np.round(of_s * along).astype(int) for of_s in GROWTHS_S)
    if left > CLEARLY * left_by_any_growing(squares, growths):
        return None
    return Step(pair, moment_of(at_s, share), before_s, after_s)
