"""A yaw rate that is repeated while the robot turns: stuck, lost, clipped, or cut off near zero."""

from collections.abc import Iterator, Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.windows.recorded.spans import constant_spans

DEAD_S = 1.0
SAME = 1e-9  # rad/s
LIVELY = 20  # other values: a rate without noise that is held (a simulation) is not clipped
HELD = 0.01  # of the ordinary fastest speed, by which treads change that hold a turn
FAR_FROM_ZERO = 10.0  # times the step between other rates: none is smaller


def held_in_turns(evidence: Evidence) -> list[FloatArray]:
    """Spans (2,) in which one rate is repeated while the treads turn the robot."""
    assert evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
    spans = constant_spans(*evidence.yaw_rate, DEAD_S)
    return [span for span in spans if _turns_by_treads(evidence, span)]


def dead(evidence: Evidence) -> Iterator[Finding]:
    """Stretches in which a rate is repeated while the treads turn the robot."""
    odd = held_in_turns(evidence)
    if not odd or limit_of(evidence, odd):
        return
    lasts_s = sum(end_s - begin_s for begin_s, end_s in odd)
    yield Finding(
        "gyroscope_dead",
        Level.WARNING,
        f"gyro_z repeats one value for {lasts_s:.1f} s while the treads turn the robot",
        _dead_zone(evidence)
        or (
            "Either the gyroscope is stuck or was lost; or the log holds the side of a turn alone"
            if _reach_both_sides(_held_rates(evidence, odd))
            else "The gyroscope is stuck or was lost"
        ),
        "Leave gyro_z empty there",
        tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in odd),
    )


def limit_of(evidence: Evidence, spans_s: Sequence[FloatArray]) -> float:
    """The size of rates that are held in spans (2,), where it is a limit of the sensor; else 0.

    Both sides reach it, and meanwhile rates are smaller or as large. A gyroscope that is stuck
    holds one value; a log of the side of the turn alone has no smaller ones.
    """
    assert evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
    stamps_s, rates = evidence.yaw_rate
    held = _held_rates(evidence, spans_s)
    if not _reach_both_sides(held):
        return 0.0
    limit = float(np.abs(held).max())
    first, last = np.searchsorted(stamps_s, [spans_s[0][0], spans_s[-1][1]])
    sizes = np.abs(rates[first:last])
    smaller = len(np.unique(np.round(sizes[sizes < limit - SAME], 6))) > LIVELY
    one_size = np.abs(np.abs(held) - limit).max() < SAME and sizes.max() < limit + SAME
    return limit if smaller and one_size else 0.0


def _held_rates(evidence: Evidence, spans_s: Sequence[FloatArray]) -> FloatArray:
    assert evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
    stamps_s, rates = evidence.yaw_rate
    return rates[np.searchsorted(stamps_s, [begin_s for begin_s, _ in spans_s])]


def _reach_both_sides(rates: FloatArray) -> bool:
    return bool((rates > 0).any() and (rates < 0).any())


def _dead_zone(evidence: Evidence) -> str:
    """Words where rates are zero or far from zero: slow turns are cut off."""
    assert evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
    sizes = np.unique(np.abs(evidence.yaw_rate[1]))
    if len(sizes) < LIVELY or sizes[0] > 0:
        return ""
    if sizes[1] < FAR_FROM_ZERO * float(np.quantile(np.diff(sizes[1:]), 0.9)):
        return ""
    return (
        f"It has a dead zone: slower turns than {sizes[1]:.2g} rad/s read zero (a threshold "
        "against drift); or it was lost at times"
    )


def _turns_by_treads(evidence: Evidence, span: FloatArray) -> bool:
    """Whether the treads turn the robot within a span, and not by one rate that both hold."""
    m = evidence.uniform
    inside = (m.start_s >= span[0] - 1e-6) & (m.end_s <= span[1] + 1e-6)
    if not inside.any():
        return False
    turning_m_s = m.difference_m[inside] / m.lasts_s[inside]
    row = int(np.searchsorted(evidence.yaw_rate[0], span[0])) if evidence.yaw_rate else 0
    reads_zero = evidence.yaw_rate is not None and evidence.yaw_rate[1][row] == 0
    changes = float(np.ptp(turning_m_s)) > HELD * evidence.fastest_m_s
    turns = float(np.mean(np.abs(turning_m_s))) > 0.1 * evidence.fastest_m_s
    return turns and (reads_zero or changes)
