"""Steps of the poses from one row to the next, smaller than their usual drift: corrections.

A reference that recognises a place (SLAM) or changes its fix (GNSS) moves its poses at once by some
decimetres or degrees. Dead reckoning does not show that, since slip adds up to as much within
seconds. But no robot leaves its own path within one row and goes on as before.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.checks.poses.steps import JITTER_S, first_ones, moments
from odometry.tables.table import Table
from odometry.windows.recorded.spans import runs_of

ROWS = 5  # on each side of a step, which have a line of the same slope each
WHOLE = 0.6  # of a step of these lines, that is between two rows
GAP = 1.3  # times the usual duration of these rows: stamps are late, or rows are lost
CLASSES, CLASS_ROWS = 3, 150  # rows by how fast the robot turns: at most so many, of so many rows
MOVES_M = 0.02  # travel of the treads over these rows, of a robot that moves
QUANTILE, TIMES = 0.95, 7.0  # of the steps of a class, and so many times that is a step
LEAST_M, LEAST_RAD = 0.2, np.radians(2)


@dataclass(frozen=True)
class Rows:
    """Poses that are checked: rows (M,) of pose.csv."""

    evidence: Evidence
    pose: Table
    rows: IntArray

    @cached_property
    def stamps_s(self) -> FloatArray:
        """Stamps (M,) of the poses."""
        return self.pose.stamps_s[self.rows]

    @cached_property
    def lasts_s(self) -> FloatArray:
        """Time (M,) that the rows around each step take."""
        return around(self.stamps_s)

    @cached_property
    def usual_s(self) -> float:
        """Time that they take where no row is late."""
        return (2 * ROWS - 1) * float(np.median(np.diff(self.stamps_s)))

    @cached_property
    def judged(self) -> BoolArray:
        """Where (M,) no row is lost or late, and the column `window` goes on."""
        judged = self.lasts_s < GAP * self.usual_s
        if "window" in self.pose.columns:
            window = np.nan_to_num(self.pose["window"][self.rows])
            judged &= around(np.cumsum(np.diff(window, prepend=window[0]) != 0)) == 0
        return np.asarray(judged)

    @cached_property
    def classes(self) -> IntArray:
        """Class (M,) of each row by its motion: 0 stands, the last one turns fastest."""
        of = self.evidence.integrals
        left_m, right_m = of.left_m(self.stamps_s), of.right_m(self.stamps_s)
        travel_m = (np.abs(around(left_m)) + np.abs(around(right_m))) / 2
        moves = travel_m > MOVES_M
        turn = np.abs(around(right_m - left_m))
        if self.evidence.yaw_rate is not None:  # the treads may be at fault
            turn = np.abs(around(of.gyroscope_rad(self.stamps_s)))
        count = int(np.clip(moves.sum() // CLASS_ROWS, 1, CLASSES))
        found = np.zeros(len(turn), np.intp)
        if moves.any():
            edges = np.quantile(turn[moves], np.arange(1, count) / count)
            found[moves] = 1 + np.searchsorted(edges, turn[moves])
        return found

    def large(self, steps_of: tuple[FloatArray, BoolArray], least: float) -> IntArray:
        """Rows of the whole steps (M,) that are far larger than others of their class."""
        sizes, whole = steps_of
        odd = np.zeros(len(sizes), bool)
        for motion in np.unique(self.classes):
            alike = (self.classes == motion) & self.judged & np.isfinite(sizes)
            if alike.sum() >= CLASS_ROWS:
                usual = float(np.quantile(sizes[alike], QUANTILE))
                odd |= alike & whole & (sizes > max(TIMES * usual, least))
        return np.array([a + int(np.argmax(sizes[a:b])) for a, b in runs_of(odd)], np.intp)


def pose_steps(evidence: Evidence, rows: IntArray) -> Iterator[Finding]:
    """Steps of positions and of yaw, each between two of `rows` (M,) of pose.csv."""
    if evidence.run.pose is None or len(rows) < CLASS_ROWS:
        return
    of = Rows(evidence, evidence.run.pose, rows)
    by_position = position_steps(of)
    places = of.large(by_position, LEAST_M)
    if len(places):
        sizes = [f"{size_m:.2g} m" for size_m in by_position[0][places]]
        yield _finding(evidence, "pose_jumps", "poses step", of.stamps_s[places], sizes)
    if not evidence.yaw_measured or evidence.yaw_in_degrees:
        return
    known = rows[np.isfinite(evidence.run.pose["yaw"][rows])]
    if len(known) < CLASS_ROWS:
        return
    of = Rows(evidence, evidence.run.pose, known)
    by_yaw = yaw_steps(of)
    places = of.large(by_yaw, LEAST_RAD)
    if len(places):
        sizes = [f"{degrees:.2g} degrees" for degrees in np.degrees(by_yaw[0][places])]
        yield _finding(evidence, "yaw_jumps", "yaw steps", of.stamps_s[places], sizes)


def position_steps(of: Rows) -> tuple[FloatArray, BoolArray]:
    """Steps (M,) of the positions [m], less what stamps that are off do along the path."""
    positions = of.pose.stack("x", "y")[of.rows]
    step, whole = steps(positions)
    way = around(positions) - np.diff(positions, axis=0, prepend=positions[:1])
    length_m = np.hypot(*way.T)
    unit = way / np.maximum(length_m, 1e-9)[:, None]
    along, aside = (step * unit).sum(axis=1), step[:, 1] * unit[:, 0] - step[:, 0] * unit[:, 1]
    off_s = JITTER_S + np.abs(of.lasts_s - of.usual_s)
    by_stamps_m = length_m / of.usual_s * off_s
    return np.hypot(aside, np.maximum(np.abs(along) - by_stamps_m, 0)), whole


def yaw_steps(of: Rows) -> tuple[FloatArray, BoolArray]:
    """Steps (M,) of yaw [rad]: the smaller one of its own, and of it against the gyroscope."""
    yaw = np.unwrap(of.pose["yaw"][of.rows])
    step, whole = steps(yaw[:, None])
    by_gyroscope = of.evidence.pose_turn_by_gyroscope
    if of.evidence.yaw_rate is None or by_gyroscope is None:
        return np.abs(step[:, 0]), whole
    turned = of.evidence.integrals.gyroscope_rad(of.stamps_s) * by_gyroscope.slope
    other, also = steps((yaw - turned)[:, None])
    same = step[:, 0] * other[:, 0] > 0
    return np.where(same, np.minimum(np.abs(step), np.abs(other))[:, 0], 0.0), whole & also


def steps(values: FloatArray) -> tuple[FloatArray, BoolArray]:
    """Steps (M, D) of values to each row, and whether (M,) they happen between two rows.

    Of two lines of one slope, through the values before and from the row on.
    """
    place = np.arange(-ROWS, ROWS) + 0.5
    lines = np.linalg.pinv(np.stack([place < 0, place > 0, place], axis=-1).astype(float))
    of = np.lib.stride_tricks.sliding_window_view(values, 2 * ROWS, axis=0)
    step = np.full(values.shape, np.nan)
    step[ROWS : len(values) - ROWS + 1] = of @ (lines[1] - lines[0])
    rate = np.full(values.shape, np.nan)
    rate[ROWS : len(values) - ROWS + 1] = of @ lines[2]
    left = step - (np.diff(values, axis=0, prepend=values[:1]) - rate)
    return step, np.hypot.reduce(left, axis=1) < (1 - WHOLE) * np.hypot.reduce(step, axis=1)


def around(values: FloatArray) -> FloatArray:
    """Change (M,) or (M, D) of values over the rows around each step; NaN at the ends."""
    change = np.full(values.shape, np.nan)
    change[ROWS : len(values) - ROWS + 1] = values[2 * ROWS - 1 :] - values[: 1 - 2 * ROWS]
    return change


def _finding(
    evidence: Evidence, name: str, what: str, at_s: FloatArray, sizes: list[str]
) -> Finding:
    return Finding(
        name,
        Level.NOTE,
        f"{what} within one row, and go on as before, {counted(len(at_s), 'time')}: "
        f"{first_ones(evidence, at_s, sizes)}",
        "The reference was corrected there: it recognised a place, or its fix or map changed",
        "Number the stretches between steps in a column `window`, or cut with --from and --to",
        moments(evidence, at_s),
    )
