"""Gyroscope and poses against tread speeds that were held for long.

Measured motion over blocks of half a second is compared with that of the tread speeds, by a scale
and a width that fit the run. How far the two are off in ordinary moments of the run, in which
treads slip and stamps are late, is the limit beyond which a held speed is contradicted.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.dead_reckoning import dead_reckon
from odometry.geometry import se2
from odometry.recording.run import Run
from odometry.recording.sensors import gyroscope_of
from odometry.windows.recorded.measured_poses import measured_poses, tread_travel
from odometry.windows.recorded.robust import slope
from odometry.windows.recorded.spans import touched

BLOCK_S = 0.5  # over which motions are compared
LONGEST_S = 2.0  # between two poses that are compared
LEAST_BLOCKS = 20  # ordinary ones: fewer determine no limit
QUANTILE, MARGIN = 0.99, 1.5  # of the ordinary errors: the limit of what is no contradiction
SLIP = 0.3  # of a speed: treads may slip more at a held speed than in ordinary moments
LEAST_RAD_S, LEAST_M_S = 0.15, 0.15  # an error below it contradicts nothing
UNKNOWN_RAD_S, UNKNOWN_M_S = 1.0, 1.0  # the limits where ordinary moments determine none
AGREED_RAD_S, AGREED_M_S = 0.3, 0.3  # errors up to which a measurement agrees
STRAIGHT_M_S = 0.02  # of a difference of the treads, at which the yaw rate is the bias


@dataclass(frozen=True)
class Evidence:
    """Of H holds.

    Attributes
    ----------
    contradicts : (H,)
        Whether measured motion is not that of the held speeds.
    agrees : (H,)
        Whether it was measured all along, and is.
    """

    contradicts: BoolArray
    agrees: BoolArray


@dataclass(frozen=True)
class _Blocks:
    """Measured blocks in order: from stamps (K,) to others, and which are ordinary (K,)."""

    begin_s: FloatArray
    end_s: FloatArray
    ordinary: BoolArray

    @property
    def used(self) -> BoolArray:
        """Blocks (K,) from which scales are found: all where ordinary ones are few."""
        enough = self.ordinary.sum() >= LEAST_BLOCKS
        return self.ordinary if enough else np.ones_like(self.ordinary)

    def limit(self, errors: FloatArray, least: float, unknown: float) -> float:
        """What ordinary errors (K,) stay below."""
        if self.ordinary.sum() < LEAST_BLOCKS:
            return unknown
        return max(least, MARGIN * float(np.quantile(errors[self.ordinary], QUANTILE)))

    def evidence(self, holds_s: FloatArray, contradicts: BoolArray, agrees: BoolArray) -> Evidence:
        """Of the blocks (K,) whose middle lies in a hold (H, 2)."""
        middle_s = (self.begin_s + self.end_s) / 2
        first, last = np.searchsorted(middle_s, holds_s.T)
        contradicted, agreed = (
            np.concatenate([[0], np.cumsum(of)]) for of in (contradicts, agrees)
        )
        all_along = np.zeros(len(holds_s), dtype=np.bool_)
        for i, (start, stop) in enumerate(zip(first, last, strict=True)):
            ends_s = [holds_s[i, 0], *middle_s[start:stop], holds_s[i, 1]]
            all_along[i] = stop > start and np.diff(ends_s).max() <= LONGEST_S
        return Evidence(
            contradicted[last] > contradicted[first],
            all_along & (agreed[last] - agreed[first] == last - first),
        )


def gyroscope_evidence(run: Run, holds_s: FloatArray) -> Evidence:
    """Measured yaw rates beside those of the tread speeds, for holds (H, 2) from stamp to stamp."""
    gyroscope = gyroscope_of(run.yaw_rate)
    if gyroscope is None:
        return _silent(len(holds_s))
    begin_s = gyroscope.stamps_s
    end_s = begin_s + BLOCK_S
    turn, _, _, silent_s = gyroscope.between(begin_s, end_s)
    odometry_s = run.odometry.stamps_s
    known = (silent_s == 0) & (begin_s >= odometry_s[0]) & (end_s <= odometry_s[-1])
    begin_s, end_s, rates = begin_s[known], end_s[known], turn[known] / BLOCK_S
    differences = tread_travel(run).between(begin_s, end_s)[1] / BLOCK_S
    blocks = _Blocks(begin_s, end_s, ~touched(holds_s, begin_s, end_s))
    straight = blocks.used & (np.abs(differences) < STRAIGHT_M_S)
    rates = rates - (np.median(rates[straight]) if straight.sum() >= LEAST_BLOCKS else 0.0)
    expected = differences * _fitted(rates, differences, blocks.used, 1 / run.robot.track_width)
    errors = np.abs(rates - expected) - SLIP * np.abs(expected)
    limit = blocks.limit(errors, LEAST_RAD_S, UNKNOWN_RAD_S)
    return blocks.evidence(holds_s, errors > limit, errors <= AGREED_RAD_S)


def pose_evidence(run: Run, holds_s: FloatArray) -> Evidence:
    """Measured motion beside that of the tread speeds, for holds (H, 2) from stamp to stamp."""
    stamps_s, poses, begin, end = _pose_pairs(run)
    if not len(begin):
        return _silent(len(holds_s))
    begin_s, end_s = stamps_s[begin], stamps_s[end]
    blocks = _Blocks(begin_s, end_s, ~touched(holds_s, begin_s, end_s))
    measured, lasts_s = se2.between(poses[begin], poses[end]), end_s - begin_s
    ahead_m, difference_m, _, _ = tread_travel(run).between(begin_s, end_s)
    by_width = 1 / run.robot.track_width
    rad_per_m = _fitted(measured[:, 2], difference_m, blocks.used, by_width)
    asked_rad = rad_per_m * difference_m
    chord_m = np.abs(np.sinc(asked_rad / (2 * np.pi)) * ahead_m)
    scale = _fitted(np.hypot(*measured[:, :2].T), chord_m, blocks.used, 1.0)
    path = _path(run, stamps_s, scale, rad_per_m)
    off = se2.between(se2.between(path[begin], path[end]), measured)
    errors_m_s = np.hypot(off[:, 0], off[:, 1]) / lasts_s - SLIP * np.abs(ahead_m) / lasts_s
    errors_rad_s = (np.abs(off[:, 2]) - SLIP * np.abs(asked_rad)) / lasts_s
    limit_m_s = blocks.limit(errors_m_s, LEAST_M_S, UNKNOWN_M_S)
    limit_rad_s = blocks.limit(errors_rad_s, LEAST_RAD_S, UNKNOWN_RAD_S)
    return blocks.evidence(
        holds_s,
        (errors_m_s > limit_m_s) | (errors_rad_s > limit_rad_s),
        (errors_m_s <= AGREED_M_S) & (errors_rad_s <= AGREED_RAD_S),
    )


def _pose_pairs(run: Run) -> tuple[FloatArray, FloatArray, IntArray, IntArray]:
    """Stamps (M,) and poses (M, 3) in the time of odometry, and pairs (K,) to be compared."""
    stamps_s, poses, windows = measured_poses(run)
    odometry_s = run.odometry.stamps_s
    inside = (stamps_s >= odometry_s[0]) & (stamps_s <= odometry_s[-1])
    stamps_s, poses, windows = stamps_s[inside], poses[inside], windows[inside]
    end = np.searchsorted(stamps_s, stamps_s + BLOCK_S - 1e-9)
    begin = np.flatnonzero(end < len(stamps_s))
    end = end[begin]
    kept = (windows[begin] == windows[end]) & (stamps_s[end] - stamps_s[begin] <= LONGEST_S)
    return stamps_s, poses, begin[kept], end[kept]


def _path(run: Run, asked_s: FloatArray, scale: float, rad_per_m: float) -> FloatArray:
    """Poses (M, 3) at stamps (M,) by tread speeds, from the origin."""
    odometry_s = run.odometry.stamps_s
    stamps_s = np.union1d(odometry_s, asked_s)
    rows = np.searchsorted(odometry_s, stamps_s, side="right") - 1
    left, right = run.odometry.stack("v_left", "v_right")[rows].T
    twists = np.column_stack([scale * (left + right) / 2, 0 * left, rad_per_m * (right - left)])
    path = dead_reckon(stamps_s, twists, np.zeros(3))
    return np.asarray(path.poses[np.searchsorted(stamps_s, asked_s)])


def _fitted(measured: FloatArray, expected: FloatArray, used: BoolArray, otherwise: float) -> float:
    """Factor of the measured (K,) by the expected (K,) of some blocks (K,)."""
    known = used & (expected != 0)
    return slope(measured[known], expected[known]) if known.sum() >= LEAST_BLOCKS else otherwise


def _silent(holds: int) -> Evidence:
    nothing = np.zeros(holds, dtype=np.bool_)
    return Evidence(nothing, nothing)
