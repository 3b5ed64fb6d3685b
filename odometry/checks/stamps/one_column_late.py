"""One column of the tread speeds that is late against the other: turns are those of two times."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import in_turn, sooner
from odometry.checks.statistics.relation import relation
from odometry.checks.turns.measured_turns import MeasuredTurns, measured_turns

GRID_S, MOST_S = 0.05, 1.5
LEAST_S = 0.15  # of one column against the other
# Share of the squares which the best two shifts leave of those that one shift of both leaves: at
# least 0.8 in 71 real recordings that turn, 0.01 to 0.25 of columns that were shifted by 0.5 s and
# more, 0.18 to 0.5 of one through a low pass.
LEFT, LEFT_BY_POSES = 0.35, 0.5
HELD = 0.9  # share of the turns that is explained then
LEAST_ANGLE = 1e-3  # squared sine of the angle between both columns: less is a straight drive
SAME_S = 0.15  # by which both sensors of turns may differ
DIFFER = 0.01  # share of the turns not explained, below which nothing is late
LEAST_WINDOWS = 40
ALONG = 0.9  # share of what is left of the way, that the shifts leave at most
ALONE = 0.4  # of the shift between both, that the one on time is off at most


@dataclass(frozen=True)
class Shifts:
    """How late [s] each column is against one sensor, and what that leaves of the turns.

    `left` is the share of what one shift of both columns leaves; `differ` and `after` are the
    shares of the turns which the columns do not explain as they are, and with these shifts.
    """

    left_s: float
    right_s: float
    left: float
    differ: float
    after: float

    @property
    def apart_s(self) -> float:
        """By how much the left column is later than the right one."""
        return self.left_s - self.right_s


def one_column_late(evidence: Evidence) -> Iterator[Finding]:
    """A column whose values explain the turns only at other stamps than those of the other.

    Slip, and a robot that follows its treads later, are of both treads.
    """
    sensors = list(measured_turns(evidence))
    found = _shifts(evidence, sensors[0])
    if found is None or found.differ < DIFFER or found.left > LEFT or found.after > 1 - HELD:
        return
    if abs(found.apart_s) < LEAST_S:
        return
    if len(sensors) > 1 and evidence.yaw_measured:
        other = _shifts(evidence, sensors[1])
        if other is None or other.left > LEFT_BY_POSES:
            return
        if abs(other.apart_s - found.apart_s) > SAME_S:
            return
    if not _goes_along(evidence, found):
        return
    late, early = ("v_left", "v_right") if found.apart_s > 0 else ("v_right", "v_left")
    own_s = {"v_left": found.left_s, "v_right": found.right_s}
    if abs(own_s[early]) < ALONE * abs(found.apart_s):
        cause = f"{late} alone is late"
    elif abs(own_s[late]) < ALONE * abs(found.apart_s):
        cause = f"{early} alone is early"
    else:
        cause = f"{late} is late against {early}"
    yield Finding(
        "tread_late",
        Level.WARNING,
        f"with {late} {abs(found.apart_s):.2f} s sooner against {early} the treads explain "
        f"{100 * (1 - found.after):.1f} % of the measured turns, and "
        f"{100 * (1 - found.differ):.1f} % as recorded",
        f"{cause}: its column is shifted against the rows, its message or bus has a delay of its "
        "own, or that side alone is smoothed",
        f"Shift the column by {abs(found.apart_s):.2f} s, or log both sides by one message",
        mend=in_turn(sooner(("v_left",), found.left_s), sooner(("v_right",), found.right_s)),
    )


def _goes_along(evidence: Evidence, found: Shifts) -> bool:
    """Whether the way along is explained better as well, where it is measured.

    Without a gyroscope turns are those of yaw alone, which may differ from the heading by what goes
    with the speed (currents beside a compass).
    """
    m, of = evidence.motion, evidence.integrals
    left_m = of.left_m(m.end_s + found.left_s) - of.left_m(m.start_s + found.left_s)
    right_m = of.right_m(m.end_s + found.right_s) - of.right_m(m.start_s + found.right_s)
    plain = relation(evidence.forward_m, m.left_m, m.right_m)
    shifted = relation(evidence.forward_m, left_m, right_m)
    if plain is None or shifted is None:
        return evidence.yaw_rate is not None
    return 1 - shifted.explained < ALONG * (1 - plain.explained)


def _shifts(evidence: Evidence, sensor: MeasuredTurns) -> Shifts | None:
    """The two shifts of the columns that explain the turns best, of all on a grid."""
    m, of = sensor.motion, evidence.integrals
    steps_s = np.arange(-MOST_S, MOST_S + GRID_S / 2, GRID_S)
    begin_s, end_s = (stamps[None, :] + steps_s[:, None] for stamps in (m.start_s, m.end_s))
    ways = [side(end_s) - side(begin_s) for side in (of.left_m, of.right_m)]
    known = np.isfinite(sensor.target) & np.isfinite(ways).all(axis=(0, 1))
    if known.sum() < LEAST_WINDOWS:
        return None
    left_m, right_m = (way[:, known] for way in ways)
    squares = _squares_left(left_m, right_m, sensor.target[known])
    left, right = np.unravel_index(np.argmin(squares), squares.shape)
    both = float(np.diag(squares).min())
    still = len(steps_s) // 2
    whole = float(np.sum(sensor.target[known] ** 2))
    return Shifts(
        float(steps_s[left]),
        float(steps_s[right]),
        float(squares[left, right]) / max(both, 1e-300),
        float(squares[still, still]) / max(whole, 1e-300),
        float(squares[left, right]) / max(whole, 1e-300),
    )


def _squares_left(left: FloatArray, right: FloatArray, turns: FloatArray) -> FloatArray:
    """Squares (S, S) that each shift of the left (S, K) and the right column (S, K) leaves.

    Least squares by the normal equations of two columns, or of the better one where both are one
    motion: on a drive that only spins they explain what one of them does.
    """
    ll, rr, lr = np.sum(left**2, axis=1)[:, None], np.sum(right**2, axis=1)[None, :], left @ right.T
    lt, rt = (left @ turns)[:, None], (right @ turns)[None, :]
    area = ll * rr - lr**2
    apart = area > LEAST_ANGLE * ll * rr
    explained = (lt**2 * rr - 2 * lt * rt * lr + rt**2 * ll) / np.where(apart, area, 1.0)
    one = np.maximum(lt**2 / np.maximum(ll, 1e-300), rt**2 / np.maximum(rr, 1e-300))
    return np.asarray(np.sum(turns**2) - np.where(apart, explained, one))
