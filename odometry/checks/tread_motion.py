"""Treads whose values do not go with the motion that gyroscope and poses measure."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.motion import Motion
from odometry.checks.relation import Relation, relation
from odometry.windows.spans import constant_spans

BOTH_STUCK_S = 1.0
CONTRADICTED = 5.0  # times the usual residual
SHORT = 0.1  # share of the windows: a span of fewer hardly moves a robust fit to all of them
SURELY = 0.1  # of the ordinary motion of a window: what a span that goes with the treads is off by


def tread_motion(evidence: Evidence) -> Iterator[Finding]:
    """Counters in place of speeds, odometry that is lost."""
    yield from _counters(evidence)
    yield from _both_still(evidence)


def _both_still(evidence: Evidence) -> Iterator[Finding]:
    """Both treads keep their values exactly while gyroscope or poses say that motion changes."""
    spans = constant_spans(evidence.stamps_s, evidence.speeds_m_s, BOTH_STUCK_S)
    odd = [span for span in spans if _differs(evidence, span)]
    if not odd:
        return
    lasts_s = sum(end_s - begin_s for begin_s, end_s in odd)
    row = int(np.searchsorted(evidence.stamps_s, odd[0][0]))
    left, right = evidence.speeds_m_s[row]
    yield Finding(
        "treads_frozen",
        Level.WARNING,
        f"both treads stay at ({left:.3g}, {right:.3g}) m/s for {lasts_s:.1f} s (first at "
        f"{evidence.run_time_s(odd[0][0]):.1f} s) while gyroscope or poses say that the robot "
        "moves differently",
        "Odometry is lost: the log repeats its last value or zeros (a motor driver or bus that "
        "stopped); or the robot was pushed, carried or slid",
        "Cut the recording with --from and --to",
        tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in odd),
    )


def _differs(evidence: Evidence, span: FloatArray) -> bool:
    """Whether the measured motion in a span changes, or differs from that of the held speeds."""
    for motion, target, of_all in _targets(evidence):
        known = np.isfinite(target)
        inside = (motion.start_s >= span[0]) & (motion.end_s <= span[1]) & known
        if inside.sum() < 1 or _is_as_elsewhere(target, of_all, inside):
            continue
        fit = relation(np.where(inside, np.nan, target), motion.left_m, motion.right_m)
        if fit is None or fit.explained < 0.7:
            continue
        size = float(np.quantile(np.abs(target[known]), 0.9))
        usual = float(np.median(np.abs(fit.residuals[known & ~inside])))
        off = np.abs(fit.residuals[inside])
        if float(np.median(off)) > max(2 * CONTRADICTED * usual, 0.3 * size):
            return True
    return False


def _is_as_elsewhere(target: FloatArray, of_all: Relation | None, inside: BoolArray) -> bool:
    """Whether some windows surely go with the treads, by the relation of all windows.

    A short span hardly moves a robust fit: most spans need no fit of their own. So the work grows
    with their number, not with its square.
    """
    if of_all is None or inside.sum() > SHORT * len(target):
        return False
    off, size = np.abs(of_all.residuals[inside]), np.quantile(np.abs(target[of_all.kept]), 0.9)
    return bool(np.isfinite(off).any() and np.nanmedian(off) < SURELY * size)


def _targets(evidence: Evidence) -> Iterator[tuple[Motion, FloatArray, Relation | None]]:
    """Measured motions of windows, and how they come from both treads."""
    if evidence.yaw_rate is not None:
        yield evidence.uniform, evidence.uniform.gyroscope_rad, evidence.gyroscope_by_treads
    if evidence.yaw_measured:
        yield evidence.motion, evidence.pose_turn_rad, evidence.pose_turn_by_treads
        yield evidence.motion, evidence.forward_m, evidence.forward_by_treads


def _counters(evidence: Evidence) -> Iterator[Finding]:
    """Columns whose changes, not whose values, are the motion."""
    for motion, target, plain in _targets(evidence):
        rows = [
            np.clip(np.searchsorted(evidence.stamps_s, at_s, side="right") - 1, 0, None)
            for at_s in (motion.start_s, motion.end_s)
        ]
        left, right = (evidence.run.odometry[n] for n in ("v_left", "v_right"))
        changed = relation(target, left[rows[1]] - left[rows[0]], right[rows[1]] - right[rows[0]])
        if changed is None or changed.explained < 0.8:
            continue
        if plain is None or plain.explained < 0.5:
            yield Finding(
                "treads_are_counters",
                Level.WARNING,
                f"changes of v_left and v_right explain {100 * changed.explained:.0f} % of the "
                "motion, their values do not",
                "The columns hold counters: positions or angles of the wheels (an odometer, "
                "encoder ticks), not speeds",
                "Differentiate them by t, and convert to m/s",
            )
            return
