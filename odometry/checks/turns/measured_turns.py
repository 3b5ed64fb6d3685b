"""Turns that a sensor measured in a time in which one tread keeps a value."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.evidence.once import once
from odometry.checks.statistics.relation import relation
from odometry.windows.recorded.spans import runs_of

STUCK_S = 2.0  # that a tread keeps its value, and that another sensor contradicts it
MOVING = 0.1  # of the ordinary fastest speed, of either tread: at rest all sensors agree
CONTRADICTED = 5.0  # times the usual residual
OFF = 0.1  # of the ordinary fastest speed, by which the tread is wrong at least
CORRELATED = 0.8  # that the motion elsewhere goes with the treads
LEAST_WINDOWS = 4
HALF = 0.5  # share of the windows of a span from which a sensor agrees with the treads
OFTEN = 0.4  # share of the windows of such a time, of a value that the tread passes now and then
RARELY = 3.0  # times more often within such a time than elsewhere
PIVOTS = 0.9  # share of the turns that the other tread explains where the robot pivots
ALIKE = 3.0  # ratio by which a wrong scale changes what a metre of the other tread turns


@dataclass(frozen=True)
class MeasuredTurns:
    """Motion of K windows, and what one sensor measured of it (K,)."""

    motion: Motion
    target: FloatArray

    def agrees(self, fastest_m_s: float, span: tuple[float, float], side: int) -> bool:
        """Whether most windows in a span are those that the treads say, noise or not."""
        treads = self._treads_m
        inside = self._moving(fastest_m_s) & self._within(span)
        fit = relation(np.where(inside, np.nan, self.target), *treads.T)
        if fit is None or inside.sum() < LEAST_WINDOWS:
            return False
        off = np.abs(self.target - treads @ fit.coefficients)
        near = off < OFF * abs(fit.coefficients[side]) * fastest_m_s * self.motion.lasts_s
        return bool(np.mean(near[inside]) > HALF)

    def pivots(self, span: tuple[float, float], side: int) -> bool:
        """Whether the other tread alone turns the robot, about as much as elsewhere."""
        inside, other = self._within(span) & np.isfinite(self.target), self._treads_m[:, 1 - side]
        fit = relation(np.where(inside, np.nan, self.target), *self._treads_m.T)
        way_m, turned = other[inside], self.target[inside]
        if fit is None or not way_m.any():
            return False
        of_metre = float(way_m @ turned / (way_m @ way_m))
        left = float(np.sum((turned - of_metre * way_m) ** 2)) / max(float(turned @ turned), 1e-300)
        ratio = of_metre / float(fit.coefficients[1 - side])
        return 1 - left > PIVOTS and 1 / ALIKE < ratio < ALIKE

    def speeds_m_s(
        self, fastest_m_s: float, spans: list[tuple[float, float]], side: int
    ) -> FloatArray | None:
        """Speeds (N,) of one tread that the turns ask for in spans, rest left out.

        None where the share of that tread is not known.
        """
        inside = np.any([self._within(span) for span in spans], axis=0)
        fit = relation(np.where(inside, np.nan, self.target), *self._treads_m.T)
        if fit is None or not fit.certain(side):
            return None
        inside &= self._moving(fastest_m_s)
        of_other = fit.coefficients[1 - side] * self._treads_m[inside, 1 - side]
        way_m = (self.target[inside] - of_other) / fit.coefficients[side]
        return np.asarray(way_m / self.motion.lasts_s[inside])

    @cached_property
    def _treads_m(self) -> FloatArray:
        return np.stack([self.motion.left_m, self.motion.right_m], axis=-1)

    def _moving(self, fastest_m_s: float) -> BoolArray:
        """Windows (K,) that were measured and in which a tread moves."""
        return np.asarray(self._largest_m > MOVING * fastest_m_s * self.motion.lasts_s)

    @cached_property
    def _largest_m(self) -> FloatArray:
        """Way (K,) of the tread that moves most; NaN where nothing was measured."""
        return np.where(np.isfinite(self.target), np.abs(self._treads_m).max(axis=1), np.nan)

    def _within(self, span: FloatArray | tuple[float, float]) -> BoolArray:
        begun, ended = self.motion.start_s >= span[0], self.motion.end_s <= span[1]
        return np.asarray(begun & ended)

    def contradicts(
        self, fastest_m_s: float, span: FloatArray, side: int
    ) -> tuple[float, float] | None:
        """First and last stamp of the windows in a span that are contradicted for long enough.

        The relation of treads and sensor is that of all windows outside. Windows at rest say
        nothing: the tread may have stood before it was lost.
        """
        m, treads, way_m = self.motion, self._treads_m, fastest_m_s * self.motion.lasts_s
        moving = self._moving(fastest_m_s)
        inside = moving & self._within(span)
        outside = (m.end_s <= span[0]) | (m.start_s >= span[1])
        if inside.sum() < LEAST_WINDOWS or (outside & moving).sum() < LEAST_WINDOWS:
            return None
        fit = relation(np.where(outside, self.target, np.nan), *treads.T)
        if fit is None or fit.correlation < CORRELATED:
            return None
        off = np.abs(self.target - treads @ fit.coefficients)
        usual = float(np.median(off[outside & moving]))
        least = np.maximum(CONTRADICTED * usual, OFF * abs(fit.coefficients[side]) * way_m)
        odd = moving & (off > least)
        often = float(np.mean(odd[inside]))
        if often < RARELY * np.mean(odd[outside & moving]):
            return None
        if often > OFTEN and (inside & odd).sum() >= LEAST_WINDOWS:
            return _ends(m, inside & odd)
        return _lasting(m, inside, odd)


def _lasting(m: Motion, inside: BoolArray, odd: BoolArray) -> tuple[float, float] | None:
    """First and last stamp of unbroken windows that are odd for long, of those inside."""
    rows = np.flatnonzero(inside)
    ends = [(rows[first], rows[after - 1]) for first, after in runs_of(odd[rows])]
    long = [
        (first, last)
        for first, last in ends
        if last - first + 1 >= LEAST_WINDOWS and m.end_s[last] - m.start_s[first] >= STUCK_S
    ]
    return _ends(m, np.ravel(long)) if long else None


def _ends(m: Motion, rows: BoolArray | IntArray) -> tuple[float, float]:
    return float(m.start_s[rows][0]), float(m.end_s[rows][-1])


def measured_turns(evidence: Evidence) -> Iterator[MeasuredTurns]:
    """Turns by the gyroscope, where there is one, and then by the poses.

    The way along is none of them: it changes where treads slip.
    """
    if evidence.yaw_rate is not None:
        yield _by_gyroscope(evidence)
    yield _by_poses(evidence)


@once
def _by_gyroscope(evidence: Evidence) -> MeasuredTurns:
    return MeasuredTurns(evidence.uniform, evidence.uniform.gyroscope_rad)


@once
def _by_poses(evidence: Evidence) -> MeasuredTurns:
    return MeasuredTurns(evidence.turn_motion, evidence.pose_turn_rad)
