"""What is odd about the values of the tread speeds: steps, a limit, no motion, one for both."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.turns.turn_signs import lasting_turn_rad
from odometry.estimation.speed_step import speed_step_m_s, tick_of

COARSE = 0.1  # a step of the readings as a share of the ordinary fastest speed
STILL_RAD = 0.1  # range of the heading of a stationary robot
SATURATED = 0.05  # share of rows at the very largest value
STRAIGHT, LEAST_TRAVEL, LEAST_WINDOWS = 0.5, 0.3, 8  # windows in which distances are compared
AS_FAR = 0.03  # by which they may differ: what is clipped by less hardly moves an odometer
EQUAL = 0.98  # share of the rows in motion; encoders of two treads differ in their last digits
LEAST_ROWS = 100
LEAST_TURN_RAD = 1.0  # range of the heading that equal treads do not explain


def treads(evidence: Evidence) -> Iterator[Finding]:
    """Coarse steps, saturation, missing motion."""
    yield from _coarse(evidence)
    yield from _saturated(evidence)
    yield from _idle(evidence)


def _coarse(evidence: Evidence) -> Iterator[Finding]:
    """Readings that come in large steps, from one to the next and back."""
    step = _step_m_s(evidence)
    if step < COARSE / 4 * evidence.fastest_m_s or step == 0:
        return
    much = is_coarse(evidence)
    yield Finding(
        "coarse_speeds",
        Level.WARNING if much else Level.NOTE,
        f"tread speeds come in steps of {step:.3g} m/s, where {evidence.fastest_m_s:.3g} m/s is "
        "the ordinary fastest",
        "Quantisation: speeds from few encoder ticks in a short time, or rounded in the log",
        "Log ticks, or speeds over a longer time or with more digits"
        if much
        else "Nothing to do where slow motion does not matter",
    )


def is_coarse(evidence: Evidence) -> bool:
    """Whether the steps are large against the ordinary fastest speed."""
    return _step_m_s(evidence) > COARSE * evidence.fastest_m_s


def _step_m_s(evidence: Evidence) -> float:
    """The step of the speeds, or one tick in a usual period where stamps are uneven; else 0."""
    step_m_s = speed_step_m_s(evidence.speeds_m_s)
    if step_m_s:
        return step_m_s
    periods_s = np.diff(evidence.stamps_s, prepend=evidence.stamps_s[0])
    ticks_m = (tick_of(values, periods_s) for values in evidence.speeds_m_s.T)
    return min(filter(None, ticks_m), default=0.0) / evidence.period_s


def _saturated(evidence: Evidence) -> Iterator[Finding]:
    """A largest value that is reached to both directions, or by both treads: a limit.

    A robot that drives at its top speed reaches one as well: there poses go no farther than the
    treads say.
    """
    tops = np.abs(evidence.speeds_m_s).max(axis=0)
    shared = abs(float(tops[0] - tops[1])) < 1e-9
    for side, name in enumerate(("v_left", "v_right")):
        values, largest = evidence.speeds_m_s[:, side], float(tops[side])
        if largest <= 0:
            continue
        at_top = np.abs(np.abs(values) - largest) < 1e-9
        changes = int(np.sum(np.diff(at_top.astype(np.int8)) == 1))
        lively = len(np.unique(np.round(np.abs(values[~at_top]), 4))) > 50
        both = bool((values[at_top] > 0).any() and (values[at_top] < 0).any())
        if at_top.mean() > SATURATED and changes >= 3 and (both or shared) and lively:
            true = _travels_as_said(evidence, at_top)
            yield Finding(
                "saturated_speed",
                Level.NOTE if true else Level.WARNING,
                f"{100 * at_top.mean():.0f} % of {name} are exactly +-{largest:.4g} m/s, reached "
                f"{changes} times" + (", and positions go as far there as elsewhere" * true),
                "The robot drives at its top speed"
                if true
                else "The speed saturates: it is clipped at a limit of the sensor or the log, or "
                "it is the command and not what the wheels did",
                "Nothing to do" if true else "Log measured wheel speeds over their whole range",
            )


def _travels_as_said(evidence: Evidence, at_top: BoolArray) -> bool:
    """Whether positions go as far a metre of the treads at the largest speed as elsewhere."""
    m, stamps_s = evidence.motion, evidence.stamps_s
    ends = np.searchsorted(stamps_s, np.stack([m.start_s, m.end_s]), side="right")
    counted_before = np.append(0, np.cumsum(at_top))
    share = np.diff(counted_before[ends], axis=0)[0] / np.maximum(np.diff(ends, axis=0)[0], 1)
    straight = np.abs(m.difference_m) < STRAIGHT * np.abs(m.mean_m)
    far = straight & (np.abs(m.mean_m) > LEAST_TRAVEL * evidence.fastest_m_s * m.lasts_s)
    per_metre = m.distance_m / np.maximum(np.abs(m.mean_m), 1e-9)
    groups = [per_metre[far & of & np.isfinite(per_metre)] for of in (share > 0.9, share < 0.1)]
    if min(map(len, groups)) < LEAST_WINDOWS:
        return False
    top, other = map(float, map(np.median, groups))
    return abs(top / other - 1) < AS_FAR


def _extent(positions: FloatArray) -> tuple[float, float]:
    """Width [m] of positions (M, 2) without their farthest tenth, and their noise [m]."""
    if len(positions) < 10:
        return 0.0, 0.0
    low, high = np.quantile(positions, [0.05, 0.95], axis=0)
    noise = np.median(np.abs(np.diff(positions, axis=0))) * 1.4826 / np.sqrt(2)
    return float(np.hypot(*(high - low))), float(noise)


def _idle(evidence: Evidence) -> Iterator[Finding]:
    """Treads that do not move."""
    if evidence.fastest_m_s > 1e-3:
        return
    moved, level = "", Level.WARNING
    if evidence.run.pose is not None and evidence.poses_used is not None:
        extent_m, noise_m = _extent(evidence.run.pose.stack("x", "y")[evidence.poses_used])
        moved = f" while poses lie within {extent_m:.3g} m"
        level = Level.NOTE if extent_m < max(10 * noise_m, 0.1) else level
    elif evidence.yaw_rate is not None:
        m = evidence.uniform
        turned_rad = lasting_turn_rad(m.gyroscope_rad, m.lasts_s)
        moved = f" while the gyroscope turns by {turned_rad:.2g} rad"
        level = Level.NOTE if turned_rad < STILL_RAD else level
    yield Finding(
        "treads_still",
        level,
        f"the fastest tread speed is {evidence.fastest_m_s:.3g} m/s{moved}",
        "Either the robot was stationary, carried or pushed; or the columns are empty or in km/s, "
        "or both hold the mean of the treads, which is zero on the spot",
        "Record a drive, and look whether the treads read anything",
    )


def equal_treads(evidence: Evidence) -> Iterator[Finding]:
    """A robot that turns while v_left and v_right are the same number in each row."""
    left, right = evidence.speeds_m_s.T
    moving = (left != 0) | (right != 0)
    if moving.sum() < LEAST_ROWS or np.mean(left[moving] == right[moving]) < EQUAL:
        return
    measured = (
        ("the gyroscope", evidence.uniform.gyroscope_rad, evidence.uniform.lasts_s),
        ("the poses", evidence.pose_turn_rad, evidence.turn_motion.lasts_s),
    )
    for name, turns, lasts_s in measured:
        if (turned_rad := lasting_turn_rad(turns, lasts_s)) > LEAST_TURN_RAD:
            alone = evidence.positions_measured is None or evidence.yaw_rate is None
            yield Finding(
                "treads_equal",
                Level.WARNING,
                f"v_left equals v_right in {100 * np.mean(left[moving] == right[moving]):.0f} % of "
                f"the rows in motion, and {name} turns over a range of {turned_rad:.2g} rad",
                f"{'Either both' if alone else 'Both'} columns hold one speed: the mean of the "
                "treads, or one tread twice"
                + f"; or turns by {name} are wrong: nothing else measured them"
                * alone,
                "Log the speed of each tread; the turns are lost",
            )
            return
