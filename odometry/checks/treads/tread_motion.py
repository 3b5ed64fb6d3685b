"""Treads whose values do not go with the motion that gyroscope and poses measure."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.relation import Relation, relation
from odometry.windows.recorded.gaps import REPEATS
from odometry.windows.recorded.spans import constant_spans, within

BOTH_STUCK_S = 3.0  # held commands of heavy faults in simulations contradict for up to 2.4 s
CONTRADICTED = 5.0  # times the usual residual
SHORT = 0.1  # share of the windows: a span of fewer hardly moves a robust fit to all of them
SURELY = 0.1  # of the ordinary motion of a window: what a span that goes with the treads is off by
OTHERWISE = 0.7  # of the motion by which it differs: on another terrain it does by a half
SPEEDS = 0.5  # share of a motion from which columns that explain it are speeds
FAR_BETTER = 0.1  # of what another relation leaves unexplained
HALF = 0.5  # of the rows that such a time should have
SHOWN = 3  # times of which begin and end are printed
LOST = (
    "odometry is lost: the log repeats its last value or zeros (a motor driver or bus that stopped)"
)
BLOCKED = "The robot is blocked or its wheels spin"
Target = tuple[Motion, FloatArray, Relation | None]


def tread_motion(evidence: Evidence) -> Iterator[Finding]:
    """Counters in place of speeds, odometry that is lost."""
    yield from _counters(evidence)
    yield from _both_still(evidence)


def _both_still(evidence: Evidence) -> Iterator[Finding]:
    """Both treads keep their values exactly while gyroscope or poses say that motion changes."""
    spans = constant_spans(evidence.stamps_s, evidence.speeds_m_s, BOTH_STUCK_S)
    odd = [span for span in spans if moves_differently(evidence, span)]
    if not odd:
        return
    left, right = evidence.speeds_m_s[int(np.searchsorted(evidence.stamps_s, odd[0][0]))]
    in_run_time = [(evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in odd]
    yield Finding(
        "treads_frozen",
        Level.WARNING,
        f"both treads stay at ({left:.3g}, {right:.3g}) m/s {times(in_run_time)} of run time, "
        "while gyroscope or poses say that the robot moves differently",
        _cause(evidence, odd),
        "Cut the recording with --from and --to",
        tuple(in_run_time),
    )


def times(spans_s: list[tuple[float, float]]) -> str:
    """The first spans in words."""
    words = ", ".join(f"from {b:.1f} to {e:.1f} s" for b, e in spans_s[:SHOWN])
    return words + (" ..." if len(spans_s) > SHOWN else "")


def _cause(evidence: Evidence, odd: list[FloatArray]) -> str:
    """Speeds that ordinarily differ from row to row were not measured where they are equal.

    Where they stay equal elsewhere as well, other columns that change show that the log goes on.
    """
    speeds, stamps_s = evidence.speeds_m_s, evidence.stamps_s
    inside = within(stamps_s, np.array(odd))
    if inside.sum() * evidence.period_s < HALF * sum(np.ptp(span) for span in odd):
        return (
            "Either rows of odometry.csv are lost, or their stamps are wrong there (a clock that "
            "was set, rows sorted after stamps that went back); or speeds are logged as they "
            "change, and odometry was lost or the robot blocked"
        )
    if not np.abs(speeds[inside]).max() > 0:
        return (
            f"Either {LOST}; or the robot was pushed, carried or slid, or stamps are off (a clock "
            "that was set), or both treads moved too slowly to be read (a dead zone)"
            + _poses_wrong(evidence, odd)
        )
    moving = (np.abs(speeds[1:]).max(axis=1) > 0) & ~inside[1:]
    repeated = (speeds[1:] == speeds[:-1]).all(axis=1)
    if repeated[moving].sum() <= REPEATS * moving.sum():
        return f"{LOST.capitalize()}: elsewhere they differ from row to row"
    names = ("current_left", "current_right")
    currents = [evidence.run.odometry[n] for n in names if n in evidence.run.odometry]
    if any(np.ptp(current[inside]) > 0 for current in currents):
        return f"{BLOCKED}: the currents of the motors go on changing; or odometry is lost"
    return (
        f"Either {LOST}; or the robot is blocked or its wheels spin, or readings are coarse: they "
        "stay equal elsewhere as well"
    )


def _poses_wrong(evidence: Evidence, odd: list[FloatArray]) -> str:
    """Words where the poses may be wrong instead: nothing else says that the robot moved."""
    if evidence.yaw_rate is None:
        return "; or the yaw is wrong there: no gyroscope says that the robot turned"
    if any(_turns_differently(evidence, span) for span in odd):
        return ""
    return (
        "; or positions wander there (reflected signals, a map or a receiver that drifts): no turn "
        "says that the robot moved"
    )


def moves_differently(evidence: Evidence, span: FloatArray) -> bool:
    """Whether the measured motion in a span changes, or differs from that of the treads.

    Gyroscope and poses must agree on it where both measure turns: else one of these is at fault.
    """
    ways = list(_targets(evidence, span))[-1:] if evidence.yaw_measured else []
    return _turns_differently(evidence, span) or any(_differs(of, span) for of in ways)


def _turns_differently(evidence: Evidence, span: FloatArray) -> bool:
    """The same of the turns alone."""
    turns = list(_targets(evidence, span))
    differ = [_differs(of, span) for of in (turns[:-1] if evidence.yaw_measured else turns)]
    said = [differs for differs in differ if differs is not None]
    return any(said) and all(said)


def _differs(of: Target, span: FloatArray) -> bool | None:
    """Whether one sensor contradicts the treads in a span; None where it does not say."""
    motion, target, of_all = of
    known = np.isfinite(target)
    inside = (motion.start_s >= span[0]) & (motion.end_s <= span[1]) & known
    if inside.sum() < 1:
        return None
    if _is_as_elsewhere(target, of_all, inside):
        return False
    treads = np.stack([motion.left_m, motion.right_m], axis=-1)
    fit = relation(np.where(inside, np.nan, target), *treads.T)
    if fit is None or fit.explained < 0.7:
        return None
    size = float(np.quantile(np.abs(target[known]), 0.9))
    usual = float(np.median(np.abs(fit.residuals[known & ~inside])))
    asked, measured = treads[inside] @ fit.coefficients, target[inside]
    larger = max(float(np.median(np.abs(of))) for of in (asked, measured))
    least = max(2 * CONTRADICTED * usual, 0.3 * size, OTHERWISE * larger)
    return float(np.median(np.abs(measured - asked))) > least


def _is_as_elsewhere(target: FloatArray, of_all: Relation | None, inside: BoolArray) -> bool:
    """Whether some windows surely go with the treads, by the relation of all windows.

    A short span hardly moves a robust fit: most spans need no fit of their own. So the work grows
    with their number, not with its square.
    """
    if of_all is None or inside.sum() > SHORT * len(target):
        return False
    off, size = np.abs(of_all.residuals[inside]), np.quantile(np.abs(target[of_all.kept]), 0.9)
    return bool(np.isfinite(off).any() and np.nanmedian(off) < SURELY * size)


def _targets(evidence: Evidence, span: FloatArray | None = None) -> Iterator[Target]:
    """Measured motions of windows, and how they come from both treads.

    A gyroscope that repeats one value all through a span is none of them.
    """
    if evidence.yaw_rate is not None and (span is None or is_read(evidence, span)):
        yield evidence.uniform, evidence.uniform.gyroscope_rad, evidence.gyroscope_by_treads
    if evidence.yaw_measured:
        yield evidence.motion, evidence.pose_turn_rad, evidence.pose_turn_by_treads
        yield evidence.motion, evidence.forward_m, evidence.forward_by_treads


def is_read(evidence: Evidence, span: FloatArray) -> bool:
    """Whether a gyroscope's values change in a span: else it is silent, or holds one."""
    if evidence.yaw_rate is None:
        return False
    stamps_s, rates = evidence.yaw_rate
    read = rates[(stamps_s >= span[0]) & (stamps_s <= span[1])]
    return len(read) > 0 and bool(np.ptp(read) > 0)


def _counters(evidence: Evidence) -> Iterator[Finding]:
    """Columns whose changes are a measured motion, while their values explain none.

    A count that grows all the time explains the mean of a way ahead, too, but far worse.
    """
    both = [
        (plain, _by_changes(evidence, motion, target))
        for motion, target, plain in _targets(evidence)
    ]
    if any(plain and plain.explained > SPEEDS and not _far_better(by, plain) for plain, by in both):
        return  # a gyroscope that holds the change of the turn rate makes counters of speeds
    for _, changed in both:
        if changed is None or changed.explained < 0.8:
            continue
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


def _by_changes(evidence: Evidence, motion: Motion, target: FloatArray) -> Relation | None:
    """A measured motion by how far both columns change over its windows."""
    rows = [
        np.clip(np.searchsorted(evidence.stamps_s, at_s, side="right") - 1, 0, None)
        for at_s in (motion.start_s, motion.end_s)
    ]
    left, right = (evidence.run.odometry[n] for n in ("v_left", "v_right"))
    return relation(target, left[rows[1]] - left[rows[0]], right[rows[1]] - right[rows[0]])


def _far_better(one: Relation | None, other: Relation) -> bool:
    return one is not None and 1 - one.explained < FAR_BETTER * (1 - other.explained)
