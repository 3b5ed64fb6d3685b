"""Steps of measured poses against dead reckoning and gyroscope."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted, disagreement
from odometry.checks.poses.steps import (
    FAR_S,
    JITTER_S,
    JUMP_TIMES,
    NEAR_S,
    first_ones,
    jumps_by_itself,
    moments,
    rate_of,
    reckoned,
    sharp_turns_s,
    step_sizes,
    without_window_changes,
)
from odometry.windows.recorded.spans import runs_of, within

LEAST_JUMP_M = 0.4
LEAST_WITHOUT_HEADING_M = 1.0  # where no heading says which way the robot drove, or it slides
LOST_S = 0.3  # around a jump, in which treads that read zero are its cause
LEAST_POSES = 20
STANDING_TIMES = 5.0  # the usual step of a standing robot: noise makes 4.5 of them in minutes
WANDERS = 4.0  # times its scatter that the noise of a receiver wanders
SUDDEN_S, SUDDEN = 0.5, 0.6  # to both sides of a jump, within which so much of it happens


@dataclass(frozen=True)
class Steps:
    """Stamps (M,), measured and reckoned positions (M, 2), size (M,) of the steps between both.

    `off` (M, 2) is the difference of both without changes of `window`; None without a heading.
    `noise_m` is the usual step of a robot that stands, where no heading is known.
    """

    stamps_s: FloatArray
    positions: FloatArray
    reckoned: FloatArray
    off: FloatArray | None
    size_m: FloatArray
    noise_m: float = 0.0


def jumps(
    evidence: Evidence, rows: IntArray, travel_m: FloatArray, left_out_s: FloatArray
) -> Iterator[Finding]:
    """Steps of the difference between the poses and dead reckoning along their own yaw.

    Parameters
    ----------
    evidence : Evidence
    rows : (M,)
        Of pose.csv: the poses that are checked.
    travel_m : (M,)
        Tread travel at each of them.
    left_out_s : (S, 2)
        Run time in which poses are frozen or a tread was lost: jumps are not searched there.
    """
    if evidence.run.pose is None:
        return
    if evidence.heading is not None:
        known = np.isfinite(evidence.run.pose["yaw"][rows])
        rows, travel_m = rows[known], travel_m[known]
    if len(rows) < LEAST_POSES:
        return
    stamps_s = evidence.run.pose.stamps_s[rows]
    positions = evidence.run.pose.stack("x", "y")[rows]
    scale = evidence.metres_per_metre
    if scale is None:
        return
    by_treads = reckoned(evidence, rows, scale)
    off = without_window_changes(evidence, rows, positions - by_treads)
    step = step_sizes(stamps_s, off)
    noise_m = 0.0
    if evidence.heading is None:
        driven_m = scale * _driven_m(stamps_s, travel_m)
        noise_m = _noise_m(positions, step[np.isfinite(step) & (driven_m == 0)])
        step = np.maximum(step - driven_m, 0.0)
    speed = rate_of(travel_m, stamps_s)
    known = np.isfinite(step) & ~within(stamps_s - evidence.run.began_s, _widened(left_out_s))
    known &= ~within(stamps_s, sharp_turns_s(evidence, stamps_s))
    if known.sum() < LEAST_POSES:
        return
    moving = known & (speed > 0.2 * evidence.fastest_m_s)
    usual = 1.4826 * float(np.median(step[moving if moving.sum() > 20 else known]))
    jitter_m = JITTER_S * speed * scale
    least_m = LEAST_JUMP_M if evidence.heading is not None else LEAST_WITHOUT_HEADING_M
    odd = known & (step > np.maximum(JUMP_TIMES * usual, least_m * scale + jitter_m))
    peaks = [begin + int(np.argmax(step[begin:end])) for begin, end in runs_of(odd)]
    measured_off = off if evidence.heading is not None else None
    steps = Steps(stamps_s, positions, by_treads, measured_off, step, noise_m)
    yield from _findings(evidence, steps, peaks, usual)


def _findings(evidence: Evidence, of: Steps, peaks: list[int], usual_m: float) -> Iterator[Finding]:
    """By what the treads and the poses did, what a large step is."""
    stood = [i for i in peaks if _stood(of, i)]
    moved = [i for i in peaks if i not in stood]
    sudden = [i for i in moved if _sudden(of, i) and _by_itself(of, i)]
    lost = [i for i in moved if i not in sudden and _lost_treads(evidence, of.stamps_s[i])]
    peaks = [i for i in moved if i not in lost]
    lost = [i for i in lost if of.size_m[i] > STANDING_TIMES * of.noise_m]
    if stood:
        yield _slip_episodes(evidence, of.stamps_s[stood], float(of.size_m[stood[0]]))
    if lost:
        yield _lost_odometry(evidence, of.stamps_s[lost], float(of.size_m[lost].max()))
    if sudden:
        yield _pose_jumps(evidence, of.stamps_s[sudden], of.size_m[sudden], usual_m)
    elif peaks:
        yield _drift(evidence, of.stamps_s[peaks[0]], float(of.size_m[peaks].max()), usual_m)


def _noise_m(positions_m: FloatArray, standing_m: FloatArray) -> float:
    """Usual step (S,) of the poses of a robot that stands: noise of a receiver wanders.

    No more than the scatter of positions (M, 2) from one to the next allows: else poses moved
    while the treads read zero.
    """
    bent_m = np.hypot(*np.diff(positions_m, n=2, axis=0).T)
    most_m = WANDERS * float(np.median(bent_m)) / float(np.sqrt(6 * np.log(4)))
    return min(float(np.median(standing_m)), most_m) if len(standing_m) else most_m


def _drift(evidence: Evidence, at_s: float, farthest_m: float, usual_m: float) -> Finding:
    return disagreement(
        f"poses end {farthest_m:.2g} m (usual: {usual_m:.2g} m) from where treads and yaw lead, "
        f"within {2 * FAR_S:g} s at {evidence.run_time_s(at_s):.0f} s, without a jump of the "
        "poses: stamps that are off, treads at fault, reflected signals (multipath) or slip do so"
    )


def _slip_episodes(evidence: Evidence, at_s: FloatArray, first_m: float) -> Finding:
    return slip_episode(
        f"the treads drive on while the poses hardly move ({counted(len(at_s), 'time')}, first by "
        f"{first_m:.2f} m at {evidence.run_time_s(at_s[0]):.1f} s)",
        moments(evidence, at_s),
    )


def slip_episode(seen: str, spans_s: tuple[tuple[float, float], ...]) -> Finding:
    """A note of treads that drive on while the poses stay, in run time [s]."""
    return Finding(
        "slip_episodes",
        Level.NOTE,
        seen,
        "The robot is stuck or slips while its wheels spin, or poses are frozen for a moment, or "
        "the treads read too much there",
        "Decide by what the robot drove on; run, identify and compare learn nothing where poses "
        "surely stay; else cut with --from and --to",
        spans_s,
    )


def _lost_odometry(evidence: Evidence, at_s: FloatArray, farthest_m: float) -> Finding:
    return Finding(
        "treads_frozen",
        Level.WARNING,
        f"poses move by up to {farthest_m:.2f} m while both treads read zero "
        f"({counted(len(at_s), 'time')}, first at {evidence.run_time_s(at_s[0]):.1f} s)",
        "Either odometry is lost: the log writes zeros (a motor driver or bus that stopped); or "
        "the robot was pushed, carried or slid, or poses jump or wander (reflected signals), or "
        "their stamps are off (late, or of a clock that was set or has another rate), or these are "
        "commands and it coasts, or they are held between two readings, or two recordings are "
        "joined there",
        "Cut the recording with --from and --to",
        moments(evidence, at_s),
    )


def _pose_jumps(
    evidence: Evidence, at_s: FloatArray, steps_m: FloatArray, usual_m: float
) -> Finding:
    places = first_ones(evidence, at_s, [f"{step_m:.3g} m" for step_m in steps_m])
    return Finding(
        "pose_jumps",
        Level.WARNING,
        f"poses jump against what treads and yaw say, and stay, {counted(len(at_s), 'time')}: "
        f"{places} (usual: {usual_m:.2g} m)",
        "Poses jump: the reference was relocalised, its map or fix changed, or it held its pose or "
        "its clock for a while; or two recordings are joined there",
        "Number the stretches between jumps in a column `window`, or cut with --from and --to",
        moments(evidence, at_s),
    )


def _driven_m(stamps_s: FloatArray, travel_m: FloatArray) -> FloatArray:
    """Tread travel (M,) over the time from which `step_sizes` takes its medians."""
    far_s = max(FAR_S, NEAR_S + 3 * float(np.median(np.diff(stamps_s))))
    before, after = (np.interp(stamps_s + s, stamps_s, travel_m) for s in (-far_s, far_s))
    return np.asarray(after - before)


def _stood(of: Steps, at: int) -> bool:
    """Whether around a row the poses moved far less than dead reckoning, and not against it."""
    first, last = _around(of, at, FAR_S)
    moved = of.positions[last] - of.positions[first]
    driven = of.reckoned[last] - of.reckoned[first]
    return bool(np.hypot(*moved) < 0.4 * np.hypot(*driven))


def _sudden(of: Steps, at: int) -> bool:
    """Whether most of a step comes within few poses: a drift takes its time."""
    if of.off is None:
        return True
    period_s = float(np.median(np.diff(of.stamps_s)))
    short_s, long_s = max(SUDDEN_S, 1.5 * period_s), max(2 * FAR_S, 6 * period_s)
    first, last = _around(of, at, long_s)
    whole = float(np.hypot(*(of.off[last] - of.off[first])))
    rows = np.arange(first, last + 1)
    ends = (np.searchsorted(of.stamps_s, of.stamps_s[rows] + s) for s in (-short_s, short_s))
    before, after = (np.clip(end, first, last) for end in ends)
    return float(np.hypot(*(of.off[after] - of.off[before]).T).max()) > SUDDEN * whole


def _by_itself(of: Steps, at: int) -> bool:
    return jumps_by_itself(of.stamps_s, of.positions, at, float(of.size_m[at]))


def _around(of: Steps, at: int, reach_s: float) -> tuple[int, int]:
    """Rows so far before and after one."""
    stamp_s = of.stamps_s[at]
    first, last = np.searchsorted(of.stamps_s, [stamp_s - reach_s, stamp_s + reach_s])
    return int(first), min(int(last), len(of.stamps_s) - 1)


def _widened(spans_s: FloatArray) -> FloatArray:
    return np.asarray(spans_s + np.array([-2 * FAR_S, 2 * FAR_S]))


def _lost_treads(evidence: Evidence, at_s: float) -> bool:
    """Whether both treads read exactly zero around a stamp."""
    near = np.abs(evidence.stamps_s - at_s) < LOST_S
    return bool(near.any() and (evidence.speeds_m_s[near] == 0).all(axis=1).mean() > 0.6)
