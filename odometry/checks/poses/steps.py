"""Steps of a difference that should be smooth, and positions by dead reckoning."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import READINGS
from odometry.checks.evidence.motion import WIDTH
from odometry.geometry import se2

JUMP_TIMES = 7.0  # the usual change of the difference to dead reckoning over the same time
JITTER_S = 0.4  # by which poses that came in bursts were late
SHOWN = 3  # jumps that are named
BLOCK = 1_000_000  # values whose medians are taken at a time
NEAR_S, FAR_S = 0.25, 1.25  # of a jump: between them its two sides are compared
AT_ONCE = 0.5  # share of a jump that one or two steps of the poses themselves hold
SHARP_RAD = 1.2  # turn from one pose to the next
BESIDE = 3  # steps, whose median is the rate before and after
BESIDE_S = 0.5  # and their mean over so long at least: where poses come in bursts, steps are uneven


def reckoned(evidence: Evidence, rows: IntArray, scale: float) -> FloatArray:
    """Positions (M, 2) by mean tread travel along the measured yaw; zeros where yaw is unknown.

    Those of the antenna, where `[sensors]` states its place.
    """
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
    way_m = np.cumsum(np.stack([steps * np.cos(middle), steps * np.sin(middle)], -1), 0)
    of_robot = np.column_stack([np.concatenate([np.zeros((1, 2)), way_m]), yaw])
    return se2.transform(of_robot, np.array((evidence.run.sensors.pose_m or (0.0, 0.0))[:2]))


def sharp_turns_s(evidence: Evidence, stamps_s: FloatArray) -> FloatArray:
    """Spans (S, 2) in which a way between two poses (M,) is so bent that dead reckoning errs."""
    of = evidence.integrals
    by_treads_m = np.diff(of.right_m(stamps_s) - of.left_m(stamps_s))
    by_treads = by_treads_m / (WIDTH * evidence.run.robot.track_width)
    least = np.fmin(np.abs(np.diff(of.gyroscope_rad(stamps_s))), np.abs(by_treads))
    sharp = np.flatnonzero(least > SHARP_RAD)
    reach_s = max(FAR_S, NEAR_S + 3 * float(np.median(np.diff(stamps_s))))
    return np.stack([stamps_s[sharp] - reach_s, stamps_s[sharp + 1] + reach_s], axis=-1)


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


def first_ones(evidence: Evidence, at_s: FloatArray, sizes: Sequence[str]) -> str:
    """Sizes of the first steps (K,) in words, each with its run time."""
    places = ", ".join(
        f"{size} at {evidence.run_time_s(stamp_s):.1f} s"
        for size, stamp_s in zip(sizes[:SHOWN], at_s[:SHOWN], strict=True)
    )
    return f"{places}{' ...' if len(at_s) > SHOWN else ''}"


def moments(evidence: Evidence, at_s: FloatArray) -> tuple[tuple[float, float], ...]:
    """Spans without length, in run time [s], at stamps (K,)."""
    return tuple((evidence.run_time_s(stamp_s),) * 2 for stamp_s in at_s)


def jumps_by_itself(stamps_s: FloatArray, values: FloatArray, at: int, size: float) -> bool:
    """Whether a series jumps near a row, and not what it is compared with.

    Two steps in a row change it by half of the size, beyond what it changes by at the rates just
    before and after, by their medians and by their means. A robot that starts, stops or turns
    round has rates between these.

    Parameters
    ----------
    stamps_s : (M,)
    values : (M, D)
    at : int
        Where medians of both sides differ most: the jump is no farther away than their windows.
    size : float
        Of the step against the other sensor.
    """
    reach_s = max(FAR_S, 1.5 * float(np.median(np.diff(stamps_s))))
    first, last = np.searchsorted(stamps_s, stamps_s[at] + np.array([-reach_s, reach_s]))
    for row in range(max(first - 2, BESIDE), min(last, len(values) - BESIDE - 2)):
        lasts_s = float(stamps_s[row + 2] - stamps_s[row])
        rate = (values[row + 2] - values[row]) / lasts_s
        medians = (_median_rate(stamps_s[of], values[of]) for of in _beside(row, BESIDE, BESIDE))
        if _beyond(rate, *medians) * lasts_s <= AT_ONCE * size:
            continue
        means = (_mean_rate(stamps_s[of], values[of]) for of in _long_beside(stamps_s, row))
        if _beyond(rate, *means) * lasts_s > AT_ONCE * size:
            return True
    return False


def _beside(row: int, before: int, after: int) -> tuple[slice, slice]:
    """Rows of so many steps before two steps, the first of which is from a row, and after them."""
    return slice(row - before, row + 1), slice(row + 2, row + 3 + after)


def _long_beside(stamps_s: FloatArray, row: int) -> tuple[slice, slice]:
    """The same of steps that last for BESIDE_S at least, as far as there are stamps (M,)."""
    first = np.searchsorted(stamps_s, stamps_s[row] - BESIDE_S, side="right") - 1
    last = np.searchsorted(stamps_s, stamps_s[row + 2] + BESIDE_S)
    return _beside(row, max(row - max(int(first), 0), BESIDE), max(int(last) - row - 2, BESIDE))


def _median_rate(stamps_s: FloatArray, values: FloatArray) -> FloatArray:
    return np.asarray(np.median(np.diff(values, axis=0) / np.diff(stamps_s)[:, None], axis=0))


def _mean_rate(stamps_s: FloatArray, values: FloatArray) -> FloatArray:
    return np.asarray((values[-1] - values[0]) / (stamps_s[-1] - stamps_s[0]))


def _beyond(rate: FloatArray, before: FloatArray, after: FloatArray) -> float:
    """By how much a rate (D,) differs from any between two (D,)."""
    between, off = after - before, rate - before
    squared = max(float(between @ between), np.finfo(float).tiny)
    share = np.clip(off @ between / squared, 0.0, 1.0)
    return float(np.linalg.norm(off - share * between))
