"""Steps of measured poses against dead reckoning and gyroscope."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level, counted
from odometry.checks.heading import READINGS
from odometry.checks.spans import runs_of, within

LEAST_JUMP_M = 0.4
LEAST_WITHOUT_HEADING_M = 1.0  # where no heading says which way the robot drove, or it slides
JUMP_TIMES = 7.0  # the usual change of the difference to dead reckoning over the same time
LEAST_YAW_JUMP_RAD = np.radians(25)
JITTER_S = 0.4  # by which poses that came in bursts were late
LOST_S = 0.3  # around a jump, in which treads that read zero are its cause
SHOWN = 3  # jumps that are named
BLOCK = 1_000_000  # values whose medians are taken at a time
NEAR_S, FAR_S = 0.25, 1.25  # of a jump: between them its two sides are compared


def jumps(
    evidence: Evidence, rows: IntArray, travel_m: FloatArray, frozen_s: FloatArray
) -> Iterator[Finding]:
    """Steps of the difference between the poses and dead reckoning along their own yaw."""
    if evidence.run.pose is None:
        return
    stamps_s = evidence.run.pose.stamps_s[rows]
    positions = evidence.run.pose.stack("x", "y")[rows]
    scale = evidence.metres_per_metre
    if scale is None:
        return
    reckoned = _reckoned(evidence, rows, scale)
    off = _without_window_changes(evidence, rows, positions - reckoned)
    step = _step_sizes(stamps_s, off)
    if evidence.heading is None:
        step = np.maximum(step - scale * _driven_m(stamps_s, travel_m), 0.0)
    speed = _rate(travel_m, stamps_s)
    known = np.isfinite(step) & ~within(stamps_s - evidence.stamps_s[0], _widened(frozen_s))
    if known.sum() < 20:
        return
    moving = known & (speed > 0.2 * evidence.fastest_m_s)
    usual = 1.4826 * float(np.median(step[moving if moving.sum() > 20 else known]))
    jitter_m = JITTER_S * speed * scale
    least_m = LEAST_JUMP_M if evidence.heading is not None else LEAST_WITHOUT_HEADING_M
    odd = known & (step > np.maximum(JUMP_TIMES * usual, least_m * scale + jitter_m))
    peaks = [begin + int(np.argmax(step[begin:end])) for begin, end in runs_of(odd)]
    stood = [i for i in peaks if _stood(stamps_s, positions, reckoned, i)]
    peaks = [i for i in peaks if i not in stood]
    lost = [i for i in peaks if _lost_treads(evidence, stamps_s[i])]
    peaks = [i for i in peaks if i not in lost]
    if stood:
        yield _slip_episodes(evidence, stamps_s[stood], float(step[stood[0]]))
    if lost:
        yield _lost_odometry(evidence, stamps_s[lost], float(step[lost].max()))
    if peaks:
        yield _pose_jumps(evidence, stamps_s[peaks], step[peaks], usual)


def _slip_episodes(evidence: Evidence, at_s: FloatArray, first_m: float) -> Finding:
    return Finding(
        "slip_episodes",
        Level.NOTE,
        f"the treads drive on while the poses hardly move ({counted(len(at_s), 'time')}, first by "
        f"{first_m:.2f} m at {evidence.run_time_s(at_s[0]):.1f} s)",
        "The robot is stuck or slips while its wheels spin, or poses are frozen for a moment",
        "Judge by what the robot drove on; cut with --from and --to",
        _moments(evidence, at_s),
    )


def _lost_odometry(evidence: Evidence, at_s: FloatArray, farthest_m: float) -> Finding:
    return Finding(
        "treads_frozen",
        Level.WARNING,
        f"poses move by up to {farthest_m:.2f} m while both treads read zero "
        f"({counted(len(at_s), 'time')}, first at {evidence.run_time_s(at_s[0]):.1f} s)",
        "Odometry is lost: the log writes zeros (a motor driver or bus that stopped); or the "
        "robot was pushed, carried or slid, or poses jump, or these are commands and it coasts",
        "Cut the recording with --from and --to",
        _moments(evidence, at_s),
    )


def _pose_jumps(
    evidence: Evidence, at_s: FloatArray, steps_m: FloatArray, usual_m: float
) -> Finding:
    places = ", ".join(
        f"{step_m:.3g} m at {evidence.run_time_s(stamp_s):.1f} s"
        for step_m, stamp_s in zip(steps_m[:SHOWN], at_s[:SHOWN], strict=True)
    )
    return Finding(
        "pose_jumps",
        Level.WARNING,
        f"poses jump against what treads and yaw say, and stay, {counted(len(at_s), 'time')}: "
        f"{places}{' ...' if len(at_s) > SHOWN else ''} (usual: {usual_m:.2g} m)",
        "Poses jump: the reference was relocalised, or its map or fix changed",
        "Number the stretches between jumps in a column `window`, or cut with --from and --to",
        _moments(evidence, at_s),
    )


def _moments(evidence: Evidence, at_s: FloatArray) -> tuple[tuple[float, float], ...]:
    return tuple((evidence.run_time_s(stamp_s),) * 2 for stamp_s in at_s)


def yaw_jumps(evidence: Evidence, rows: IntArray) -> Iterator[Finding]:
    """Steps of the measured yaw against the gyroscope."""
    pose = evidence.run.pose
    if pose is None or not evidence.yaw_measured or evidence.yaw_rate is None:
        return
    by_gyroscope = evidence.pose_turn_by_gyroscope
    if by_gyroscope is None or by_gyroscope.correlation < 0.9:
        return
    stamps_s = np.clip(pose.stamps_s[rows], evidence.stamps_s[0], evidence.stamps_s[-1])
    yaw = np.radians(pose["yaw"][rows]) if evidence.yaw_in_degrees else pose["yaw"][rows]
    heading = evidence.integrals.gyroscope_rad(stamps_s) * by_gyroscope.slope
    known = np.isfinite(yaw) & np.isfinite(heading)
    stamps_s, off = stamps_s[known], np.unwrap((yaw - heading)[known])
    step = _step_sizes(stamps_s, np.stack([off, np.zeros_like(off)], axis=-1))
    measured = np.isfinite(step)
    if measured.sum() < 20:
        return
    usual = 1.4826 * float(np.median(step[measured]))
    rate = np.abs(_rate(heading[known], stamps_s))
    odd = measured & (step > np.maximum(JUMP_TIMES * usual, LEAST_YAW_JUMP_RAD + JITTER_S * rate))
    peaks = [begin + int(np.argmax(step[begin:end])) for begin, end in runs_of(odd)]
    if not peaks:
        return
    yield Finding(
        "yaw_jumps",
        Level.WARNING,
        f"yaw of pose.csv jumps against the gyroscope, and stays, {counted(len(peaks), 'time')}: "
        + ", ".join(
            f"{np.degrees(step[i]):.0f} degrees at {evidence.run_time_s(stamps_s[i]):.1f} s"
            for i in peaks[:SHOWN]
        ),
        "Yaw jumps: the heading of the reference was corrected or lost (magnetometer, antennas)",
        "Number the stretches between jumps in a column `window`, or cut with --from and --to",
        _moments(evidence, stamps_s[peaks]),
    )


def _reckoned(evidence: Evidence, rows: IntArray, scale: float) -> FloatArray:
    """Positions (M, 2) by mean tread travel along the measured yaw; zeros where yaw is unknown."""
    pose, heading = evidence.run.pose, evidence.heading
    if pose is None or heading is None:
        return np.zeros((len(rows), 2))
    yaw = pose["yaw"][rows]
    yaw = READINGS[heading.reading](np.radians(yaw) if evidence.yaw_in_degrees else yaw)
    yaw = np.unwrap(np.nan_to_num(yaw)) + heading.offset_rad
    of = evidence.integrals
    stamps_s = np.clip(pose.stamps_s[rows], evidence.stamps_s[0], evidence.stamps_s[-1])
    travel_m = (of.left_m(stamps_s) + of.right_m(stamps_s)) / 2
    steps = scale * np.diff(travel_m)
    middle = (yaw[1:] + yaw[:-1]) / 2
    return np.concatenate(
        [
            np.zeros((1, 2)),
            np.cumsum(np.stack([steps * np.cos(middle), steps * np.sin(middle)], -1), 0),
        ]
    )


def _step_sizes(stamps_s: FloatArray, off: FloatArray) -> FloatArray:
    """Distance (M,) between the medians of `off` (M, 2) shortly before and after each pose.

    Medians bear jitter of stamps. NaN next to the ends and to gaps.
    """
    period_s = float(np.median(np.diff(stamps_s)))
    near_s, far_s = NEAR_S, max(FAR_S, NEAR_S + 3 * period_s)
    edges = [
        np.searchsorted(stamps_s, stamps_s + shift_s)
        for shift_s in (-far_s, -near_s, near_s, far_s)
    ]
    before, after = (_medians(off, *edges[i : i + 2]) for i in (0, 2))
    return np.asarray(np.hypot(*(after - before).T))


def _medians(values: FloatArray, first: IntArray, last: IntArray) -> FloatArray:
    """Medians (K, 2) of values (M, 2) from `first` to before `last` (K,); NaN of less than two."""
    found, sizes = np.full((len(first), 2), np.nan), last - first
    for size in np.unique(sizes[sizes >= 2]):
        windows = np.lib.stride_tricks.sliding_window_view(values, size, axis=0)
        rows = np.flatnonzero(sizes == size)
        for some in np.array_split(rows, 1 + len(rows) * size // BLOCK):
            found[some] = np.median(windows[first[some]], axis=-1)
    return found


def _driven_m(stamps_s: FloatArray, travel_m: FloatArray) -> FloatArray:
    """Tread travel (M,) over the time from which `_step_sizes` takes its medians."""
    far_s = max(FAR_S, NEAR_S + 3 * float(np.median(np.diff(stamps_s))))
    before, after = (np.interp(stamps_s + s, stamps_s, travel_m) for s in (-far_s, far_s))
    return np.asarray(after - before)


def _without_window_changes(
    evidence: Evidence, rows: IntArray, positions: FloatArray
) -> FloatArray:
    """Positions (M, 2) with the steps at changes of `window` taken out: these may jump."""
    pose = evidence.run.pose
    if pose is None or "window" not in pose:
        return positions
    steps = np.diff(positions, axis=0)
    steps[np.diff(np.nan_to_num(pose["window"][rows])) != 0] = 0.0
    return np.concatenate([positions[:1], positions[0] + np.cumsum(steps, axis=0)])


def _stood(stamps_s: FloatArray, positions: FloatArray, reckoned: FloatArray, at: int) -> bool:
    """Whether around a row the poses moved far less than dead reckoning, and not against it."""
    first, last = np.searchsorted(stamps_s, [stamps_s[at] - FAR_S, stamps_s[at] + FAR_S])
    last = min(int(last), len(stamps_s) - 1)
    moved, driven = positions[last] - positions[first], reckoned[last] - reckoned[first]
    return bool(np.hypot(*moved) < 0.4 * np.hypot(*driven))


def _widened(spans_s: FloatArray) -> FloatArray:
    return np.asarray(spans_s + np.array([-2 * FAR_S, 2 * FAR_S]))


def _rate(values: FloatArray, stamps_s: FloatArray) -> FloatArray:
    """Change (M,) of values to the next row for each second."""
    rates = np.diff(values) / np.maximum(np.diff(stamps_s), 1e-3)
    return np.append(rates, rates[-1:])


def _lost_treads(evidence: Evidence, at_s: float) -> bool:
    """Whether both treads read exactly zero around a stamp."""
    near = np.abs(evidence.stamps_s - at_s) < LOST_S
    return bool(near.any() and (evidence.speeds_m_s[near] == 0).all(axis=1).mean() > 0.6)
