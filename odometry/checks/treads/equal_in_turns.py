"""Both columns hold one speed where the robot turns, and each its own elsewhere."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.relation import relation
from odometry.checks.turns.measured_turns import MeasuredTurns, measured_turns
from odometry.windows.recorded.spans import runs_of

SHARP = 0.3  # of the sharpest turns: a robot that slips a little turns less
# A robot follows its treads later by less: then it turns on while they are equal again.
LASTING_S, LEAST_WINDOWS = 1.5, 6
OFTEN = 0.2  # of the sharp turns, and share of the rows in them whose value is a new one
LEAST_TURN_RAD = 1.0
STRAIGHT = 0.1  # of the sharpest turns, below which the robot drives straight on
MOVING = 0.1  # of the ordinary fastest speed
ELSEWHERE = 0.5  # of the share of sharp turns, that of straight drives: commands are equal there
# A part of equal speeds has straight drives of its own. Share of its windows in sharp turns, and of
# its rows with new values, as ratios to those elsewhere: 0.6 and 0.9 at least where both columns
# hold one tread. In 75 real recordings a part in which commands are equal has 0.33 new values.
AS_SHARP, AS_NEW, PART_WINDOWS = 0.5, 0.5, 16
# Share of the turns explained where no row is equal; 0.78 and more of 35 drives with the mean in
# turns, 0.52 and less where a gyroscope was late, so that commands seemed to be equal in turns.
HELD = 0.7


def equal_in_turns(evidence: Evidence) -> Iterator[Finding]:
    """Speeds that are the same number, row by row, in turns that another sensor measures.

    Two encoders differ in their last digits, even of a robot that slides.
    """
    for turns in measured_turns(evidence):
        rows = _rows_of(evidence, turns)
        equal, differ = rows.twice & rows.often_new, rows.equal == 0
        rates = np.abs(turns.target) / turns.motion.lasts_s
        known = np.isfinite(rates)
        if not rows.twice.any() or not known.any():
            continue
        sharpest = np.quantile(rates[known], 0.95)
        sharp = known & (rates > SHARP * sharpest)
        odd = _lasting(turns, equal & sharp)
        part = _parts(rows, sharp)
        odd |= part & rows.twice & sharp
        turned_rad = float(np.sum(np.abs(turns.target[odd])))
        if odd.sum() < max(LEAST_WINDOWS, OFTEN * sharp.sum()) or turned_rad < LEAST_TURN_RAD:
            continue
        m = turns.motion
        straight = known & (rates < STRAIGHT * sharpest) & ~part
        straight &= np.abs(m.mean_m) > MOVING * evidence.fastest_m_s * m.lasts_s
        if np.sum(equal & straight) * sharp.sum() > ELSEWHERE * odd.sum() * straight.sum():
            continue
        others = np.where(differ, turns.target, np.nan)
        fit = relation(others, m.left_m, m.right_m, m.lasts_s)
        if fit is None or fit.explained < HELD:
            continue
        share = float(odd.sum() / sharp.sum())
        spans_s = [(m.start_s[first], m.end_s[end - 1]) for first, end in runs_of(part)]
        yield _finding(evidence, spans_s, share, turned_rad)
        return


def _finding(
    evidence: Evidence, spans_s: list[tuple[float, float]], share: float, turned_rad: float
) -> Finding:
    """Of a share of the sharp turns; the stamps of spans in which all speeds are equal."""
    return Finding(
        "treads_equal",
        Level.WARNING,
        f"v_left equals v_right in each row of {100 * share:.0f} % of the sharp turns, in which "
        f"the robot turns by {turned_rad:.2g} rad; in others they differ",
        "Both columns hold one speed in these turns: the mean of the treads, or one of them twice",
        "Log the speed of each tread; these turns are lost",
        tuple((evidence.run_time_s(begin), evidence.run_time_s(end)) for begin, end in spans_s),
    )


@dataclass(frozen=True)
class _Rows:
    """Of the rows in windows (K,): all, of one speed and moving, of one speed, with new values."""

    count: FloatArray
    equal: FloatArray
    same: FloatArray
    new: FloatArray

    @property
    def twice(self) -> BoolArray:
        """Windows (K,) in each row of which both treads move at one speed."""
        return np.asarray((self.count > 0) & (self.equal == self.count))

    @property
    def often_new(self) -> BoolArray:
        """Windows (K,) whose values are not held."""
        return np.asarray(self.new > OFTEN * self.count)


def _rows_of(evidence: Evidence, turns: MeasuredTurns) -> _Rows:
    left, right = evidence.run.odometry.stack("v_left", "v_right").T
    new = np.insert(np.diff(left) != 0, 0, True)
    rows = np.stack([np.ones(len(left)), (left == right) & (left != 0), left == right, new])
    summed = np.cumsum(np.insert(rows, 0, 0.0, axis=1), axis=1)
    m = turns.motion
    first, last = (np.searchsorted(evidence.stamps_s, at_s) for at_s in (m.start_s, m.end_s))
    return _Rows(*(summed[:, last] - summed[:, first]))


def _parts(rows: _Rows, sharp: BoolArray) -> BoolArray:
    """Unbroken windows (K,) of equal speeds, as often sharp and as often new as the others."""
    part = np.zeros_like(sharp)
    for first, end in runs_of(rows.same == rows.count):
        inside = np.zeros_like(sharp)
        inside[first:end] = True
        if end - first < PART_WINDOWS or inside.all():
            continue
        as_sharp = np.mean((rows.twice & sharp)[inside]) > AS_SHARP * np.mean(sharp[~inside])
        new, elsewhere = (rows.new[of].sum() / rows.count[of].sum() for of in (inside, ~inside))
        part |= inside & bool(as_sharp and new > AS_NEW * elsewhere)
    return part


def _lasting(turns: MeasuredTurns, flags: BoolArray) -> BoolArray:
    """Those windows (K,) of unbroken stretches that last long enough."""
    m, kept = turns.motion, np.zeros_like(flags)
    for first, end in runs_of(flags):
        kept[first:end] = m.end_s[end - 1] - m.start_s[first] >= LASTING_S
    return kept
