"""The span in which a change, undone, makes the turns of two sensors agree."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.parts.changes import Change
from odometry.checks.parts.edges import Columns, exact_span
from odometry.checks.parts.span import Span, best_rows
from odometry.checks.statistics.relation import relation

LEAST_WINDOWS = 20  # that both sensors measured
LEAST_TURN_RAD = 1.0  # within the span, and outside
LEFT = 0.35  # share of what differs as recorded, that is left with the change undone in the span
ELSEWHERE = 0.5  # share of what would differ outside with it undone, that differs as recorded
OUTLIER = 3.0  # root mean squares of the turns: what differs by more counts as that much


@dataclass(frozen=True)
class Compared:
    """Squares (K,) by which turns of two sensors differ, as recorded and with a change undone."""

    recorded: FloatArray
    undone: FloatArray

    @property
    def gains(self) -> FloatArray:
        """By how much less (K,) differs with the change undone."""
        return self.recorded - self.undone

    @property
    def rows(self) -> tuple[int, int]:
        """First row and row after the last of the span with the most to gain."""
        return best_rows(self.gains)

    @property
    def left(self) -> float:
        """What differs with the change undone in the span."""
        return float(self.recorded.sum() - self.gains[slice(*self.rows)].sum())

    @property
    def inside(self) -> BoolArray:
        """Whether each window (K,) is in that span."""
        inside = np.zeros(len(self.recorded), dtype=np.bool_)
        inside[slice(*self.rows)] = True
        return inside

    @property
    def is_clear(self) -> bool:
        """Whether the change explains what differs, in this span and nowhere else."""
        elsewhere, if_undone = (of[~self.inside].sum() for of in (self.recorded, self.undone))
        explained = self.left < LEFT * self.recorded.sum()
        return bool(explained and elsewhere < ELSEWHERE * if_undone)


def changed_span(evidence: Evidence, change: Change) -> Span | None:
    """The span with the most to gain from undoing a change; None where it is not clear."""
    other, windows = beside(evidence, change.sensor)
    if other == change.sensor or _has_lost_its_sign(evidence, change):
        return None
    turns, others = (turns_of(windows, sensor) for sensor in (change.sensor, other))
    undone = turns_of(change.motion(windows), change.sensor)
    known = np.flatnonzero(np.isfinite(turns) & np.isfinite(undone) & np.isfinite(others))
    if len(known) < LEAST_WINDOWS:
        return None
    turns, undone, others = turns[known], undone[known], others[known]
    sizes = [relation(np.abs(of), np.abs(others)) for of in (turns, undone)]
    ratios = [fit.slope for fit in sizes if fit is not None]
    if "treads" not in (change.sensor, other):
        ratios = [1.0]  # both in rad
    compared = [_compared(turns, undone, ratio * others) for ratio in ratios]
    found = min(compared, key=lambda one: one.left, default=None)
    if found is None or not found.is_clear:
        return None
    turned_rad = np.abs(others) / (evidence.run.robot.track_width if other == "treads" else 1.0)
    if min(turned_rad[found.inside].sum(), turned_rad[~found.inside].sum()) < LEAST_TURN_RAD:
        return None
    return _exact(evidence, change, windows.rows(known), found)


def beside(evidence: Evidence, sensor: str) -> tuple[str, Motion]:
    """The sensor whose turns tell more of this one, and windows of both; itself without one."""
    others = [*["gyroscope"] * (evidence.yaw_rate is not None), *["pose"] * evidence.yaw_measured]
    other = next((of for of in others if of != sensor), "treads")
    return other, evidence.raw_motion if "pose" in (sensor, other) else evidence.uniform


def _has_lost_its_sign(evidence: Evidence, change: Change) -> bool:
    """Whether a column whose sign would change is never negative: it may hold a size instead."""
    if change.sensor == "pose" or (change.sensor == "gyroscope" and evidence.yaw_rate is None):
        return False  # yaw may be written from 0 to a full turn
    recorded = change.columns(evidence.run, change.table(evidence.gyroscope_file))
    unknown = np.isnan(recorded)
    turned = (unknown | (change.undo(recorded) == -recorded)).all(axis=1)
    return bool((turned & (unknown | (recorded >= 0)).all(axis=1)).any())


def turns_of(of: Motion, sensor: str) -> FloatArray:
    """Turns (K,) in rad, of the treads in m."""
    if sensor == "treads":
        return of.difference_m
    return of.turn_rad if sensor == "pose" else of.gyroscope_rad


def _compared(turns: FloatArray, undone: FloatArray, expected: FloatArray) -> Compared:
    """Of turns (K,) of a sensor, as recorded and undone, with those that another one expects."""
    most = OUTLIER**2 * float(np.mean(expected**2))
    recorded, if_undone = (np.minimum((of - expected) ** 2, most) for of in (turns, undone))
    return Compared(recorded, if_undone)


def _exact(evidence: Evidence, change: Change, windows: Motion, found: Compared) -> Span:
    table = change.table(evidence.gyroscope_file)
    recorded = change.columns(evidence.run, table)
    columns = Columns(
        getattr(evidence.run, table).stamps_s,
        recorded,
        change.undo(recorded),
        change.factor,
        2 * np.pi if change.sensor == "pose" else np.inf,
    )
    windows_s = np.stack([windows.start_s, windows.end_s], axis=-1)
    return exact_span(found.gains, windows_s, found.rows, columns)
