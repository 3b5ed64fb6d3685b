"""Steps of a difference that should be smooth, and positions by dead reckoning."""

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence import Evidence
from odometry.checks.heading import READINGS

JUMP_TIMES = 7.0  # the usual change of the difference to dead reckoning over the same time
JITTER_S = 0.4  # by which poses that came in bursts were late
SHOWN = 3  # jumps that are named
BLOCK = 1_000_000  # values whose medians are taken at a time
NEAR_S, FAR_S = 0.25, 1.25  # of a jump: between them its two sides are compared


def reckoned(evidence: Evidence, rows: IntArray, scale: float) -> FloatArray:
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


def without_window_changes(evidence: Evidence, rows: IntArray, positions: FloatArray) -> FloatArray:
    """Positions (M, 2) with the steps at changes of `window` taken out: these may jump."""
    pose = evidence.run.pose
    if pose is None or "window" not in pose:
        return positions
    steps = np.diff(positions, axis=0)
    steps[np.diff(np.nan_to_num(pose["window"][rows])) != 0] = 0.0
    return np.concatenate([positions[:1], positions[0] + np.cumsum(steps, axis=0)])


def step_sizes(stamps_s: FloatArray, off: FloatArray) -> FloatArray:
    """Distance (M,) between the medians of `off` (M, 2) shortly before and after each pose.

    Medians are robust to jitter of stamps. NaN next to the ends and to gaps.
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


def rate_of(values: FloatArray, stamps_s: FloatArray) -> FloatArray:
    """Change (M,) of values to the next row for each second."""
    rates = np.diff(values) / np.maximum(np.diff(stamps_s), 1e-3)
    return np.append(rates, rates[-1:])


def moments(evidence: Evidence, at_s: FloatArray) -> tuple[tuple[float, float], ...]:
    """Spans without length, in run time [s], at stamps (K,)."""
    return tuple((evidence.run_time_s(stamp_s),) * 2 for stamp_s in at_s)
