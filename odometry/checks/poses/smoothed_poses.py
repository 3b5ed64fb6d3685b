"""Poses that a filter has smoothed: their path cuts the corners that treads and gyroscope show."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.measured_between import measured_between
from odometry.windows.recorded.spans import touched

GRID_S = 0.05
SMOOTHED_S = (0.5, 0.7, 1.0, 1.4, 2.0, 2.8, 4.0)  # slip on ice and wind look like the longest
STRETCH_S = 20.0
FEWEST, FEWEST_POSES = 3, 15  # stretches, and poses in each
TURN_S = 0.5  # over which turns of yaw and gyroscope are compared
SHORTEST_M = 1.0  # of a stretch
LESS = 0.75  # of the distance from the path of treads and gyroscope, by smoothing that path
MOST_STRETCHES = 0.9  # have less


def smoothed_poses(evidence: Evidence) -> Iterator[Finding]:
    """The path of treads and gyroscope fits the positions far better when it is smoothed.

    On each stretch the positions are fitted by that path with free scales, side slip, lever arm
    and place: as it is, and as a moving mean over several times. Positions that were measured fit
    it best as it is, or nearly so. A filter of poses smooths yaw with them: where yaw turns as
    sharply as the gyroscope, it is something else (an axis that is late, a drive to and fro).
    """
    pose, used = evidence.run.pose, evidence.poses_used
    if pose is None or used is None or evidence.yaw_rate is None:
        return
    distances = _distances(evidence, pose.stamps_s, pose["x"] + 1j * pose["y"], used)
    if distances.shape[1] < FEWEST or not (distances > 0).all():
        return
    shares = distances[1:] / distances[0]
    means = np.exp(np.log(shares).mean(axis=1))
    best = int(np.argmin(means))
    if best == len(means) - 1 or means[best] > LESS or (shares[best] < 1).mean() < MOST_STRETCHES:
        return
    if evidence.yaw_measured and not _yaw_is_smooth(evidence, SMOOTHED_S[best]):
        return
    yield Finding(
        "smoothed_poses",
        Level.WARNING,
        f"the path of treads and gyroscope lies {1 / means[best]:.1f} times nearer to the "
        f"positions when it is averaged over {SMOOTHED_S[best]:g} s",
        f"Poses are smoothed over some {SMOOTHED_S[best]:g} s (by the receiver or a filter): they "
        "cut corners short, and parameters identified from them are biased",
        "Record poses before they are smoothed, or switch the smoothing of the receiver off",
    )


def _yaw_is_smooth(evidence: Evidence, over_s: float) -> bool:
    """Whether measured turns are nearer to those of the gyroscope when these are smoothed."""
    pose, used = evidence.run.pose, evidence.poses_used
    assert pose is not None and used is not None  # noqa: S101, PT018 - checked by the caller
    stamps_s, yaw = pose.stamps_s[used], pose["yaw"][used]
    yaw = np.unwrap(np.radians(yaw) if evidence.yaw_in_degrees else yaw)
    begin_s, end_s = max(stamps_s[0], evidence.stamps_s[0]), evidence.stamps_s[-1]
    grid_s = np.arange(begin_s, min(stamps_s[-1], end_s), GRID_S)
    heading = evidence.integrals.gyroscope_rad(grid_s)[None, :]
    measured = measured_between(grid_s, stamps_s, yaw)
    step, margin = int(TURN_S / GRID_S), over_s / 2
    inside = slice(int(margin / GRID_S) + 1, len(grid_s) - int(margin / GRID_S) - 1)
    plain, smooth = (
        float(np.nanstd(off[step:] - off[:-step]))
        for half in (0, int(over_s / GRID_S) // 2)
        for off in [(measured - _averaged(heading, half)[0])[inside]]
    )
    return smooth < plain


def _distances(
    evidence: Evidence, stamps_s: FloatArray, positions: AnyArray, used: BoolArray
) -> FloatArray:
    """Root mean square distance [m] of positions from the path, (1 + smoothings, stretches)."""
    begin_s, end_s = evidence.stamps_s[0], evidence.stamps_s[-1]
    grid_s = np.arange(begin_s, end_s, GRID_S)
    path = _path(evidence, grid_s)
    margin_s = SMOOTHED_S[-1] / 2 + GRID_S
    edges_s = np.arange(begin_s + margin_s, end_s - margin_s, STRETCH_S)
    silent = touched(evidence.silent_s, edges_s[:-1] - margin_s, edges_s[1:] + margin_s)
    spans_s = [span for span, lost in zip(pairwise(edges_s), silent, strict=True) if not lost]
    rows = np.flatnonzero(used)
    places = np.searchsorted(stamps_s[rows], np.reshape(spans_s, (-1, 2)))
    parts = [
        part
        for part in (rows[first:after] for first, after in places)
        if len(part) >= FEWEST_POSES and np.abs(np.diff(positions[part])).sum() > SHORTEST_M
    ]
    found = np.empty((1 + len(SMOOTHED_S), len(parts)))
    for row, over_s in enumerate((0.0, *SMOOTHED_S)):
        smooth = _averaged(path, int(over_s / GRID_S) // 2)
        for column, part in enumerate(parts):
            found[row, column] = _off(stamps_s[part], positions[part], grid_s, smooth)
    return found


def _path(evidence: Evidence, grid_s: FloatArray) -> AnyArray:
    """Complex columns (4, N): way of the mean speed, of the difference, and the heading.

    The second is the derivative of the first by the scale of the gyroscope.
    """
    of = evidence.integrals
    turned_rad = np.nan_to_num(of.gyroscope_rad(grid_s))
    heading = np.exp(1j * turned_rad)
    left, right = np.diff(of.left_m(grid_s)), np.diff(of.right_m(grid_s))
    between = (heading[1:] + heading[:-1]) / 2
    by_scale = 1j * (turned_rad[1:] + turned_rad[:-1]) / 2 * (left + right)
    ways = np.cumsum(np.stack([left + right, by_scale, right - left]) * between, axis=1)
    return np.vstack([np.insert(ways, 0, 0.0, axis=1), heading])


def _averaged(columns: AnyArray, half: int) -> AnyArray:
    """Moving mean over so many samples to either side; as it is at the ends.

    A sample that is NaN leaves its neighbours alone without a mean: no sums from the start.
    """
    count = 2 * half + 1
    averaged = columns.copy()
    if columns.shape[1] < count:
        return averaged
    weights = np.full(count, 1 / count)
    inside = slice(half, columns.shape[1] - half)
    averaged[:, inside] = [np.convolve(column, weights, "valid") for column in columns]
    return averaged


def _off(stamps_s: FloatArray, positions: AnyArray, grid_s: FloatArray, path: AnyArray) -> float:
    at_poses = [np.interp(stamps_s, grid_s, column) for column in path]
    design = np.vstack([*at_poses, np.ones(len(stamps_s))]).T
    factors, *_ = np.linalg.lstsq(design, positions - positions.mean(), rcond=1e-9)
    left = positions - positions.mean() - design @ factors
    return float(np.sqrt(np.mean(np.abs(left) ** 2)))
