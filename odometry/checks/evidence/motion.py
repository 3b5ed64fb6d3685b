"""What treads, gyroscope and poses say of the motion between the same stamps."""

from bisect import bisect_left
from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.recording.run import Run
from odometry.windows.recorded.spans import touched

WINDOW_S = 0.5  # long against the jitter of stamps, short against a turn
LONGEST = (
    3.0  # windows longer than this many times WINDOW_S, or the usual pose period, are left out
)

WIDTH = 1.8  # track widths, as which a robot turns where no gyroscope says more


@dataclass(frozen=True)
class Motion:
    """Motion over K windows, raw: as the files say it, in their units.

    Attributes
    ----------
    start_s, end_s : (K,)
        Stamps.
    left_m, right_m : (K,)
        Tread travel; of speeds without spikes.
    gyroscope_rad : (K,)
        Integral of the yaw rate, NaN where it was not recorded.
    moved_m : (K, 2)
        Measured x, y at the end less at the start, NaN without poses.
    yaw_rad : (K, 2)
        Measured yaw at the start and at the end, as in the file.
    """

    start_s: FloatArray
    end_s: FloatArray
    left_m: FloatArray
    right_m: FloatArray
    gyroscope_rad: FloatArray
    moved_m: FloatArray
    yaw_rad: FloatArray

    def __len__(self) -> int:
        return len(self.start_s)

    def rows(self, chosen: IntArray) -> "Motion":
        """The same with only the chosen windows."""
        return Motion(*(getattr(self, field.name)[chosen] for field in fields(self)))

    @property
    def lasts_s(self) -> FloatArray:
        """Duration (K,)."""
        return self.end_s - self.start_s

    @property
    def mean_m(self) -> FloatArray:
        """Mean travel (K,) of both treads."""
        return (self.left_m + self.right_m) / 2

    @property
    def difference_m(self) -> FloatArray:
        """Travel (K,) of the right tread less that of the left."""
        return self.right_m - self.left_m

    @property
    def distance_m(self) -> FloatArray:
        """Distance (K,) between the measured positions."""
        return np.asarray(np.hypot(self.moved_m[:, 0], self.moved_m[:, 1]))

    def least_turn_rad(self, width_m: float) -> FloatArray:
        """Turn (K,) without its sign, the smaller one by gyroscope and treads.

        A unit may be wrong. Where there is no gyroscope, treads turn the robot less than they say.
        """
        by_treads, by_gyroscope = np.abs(self.difference_m) / width_m, np.abs(self.gyroscope_rad)
        return np.fmin(np.where(np.isnan(by_gyroscope), by_treads / WIDTH, by_gyroscope), by_treads)

    @property
    def turn_rad(self) -> FloatArray:
        """Measured turn (K,), the shorter way round."""
        raw = self.yaw_rad[:, 1] - self.yaw_rad[:, 0]
        return np.asarray((raw + np.pi) % (2 * np.pi) - np.pi)

    def with_yaw(self, read: Callable[[FloatArray], FloatArray]) -> "Motion":
        """The same with another reading of the measured yaw (K, 2)."""
        return replace(self, yaw_rad=read(self.yaw_rad))

    def of_point(self, yaw_rad: FloatArray, place_m: FloatArray) -> "Motion":
        """The same of the point from which the measured one lies at (2,) in the robot frame.

        Where its yaw (K, 2) at the start and at the end is not known, as it is.
        """
        cosine, sine = np.diff(np.cos(yaw_rad))[:, 0], np.diff(np.sin(yaw_rad))[:, 0]
        swung_m = np.stack([cosine, -sine, sine, cosine], axis=-1).reshape(-1, 2, 2) @ place_m
        return replace(self, moved_m=self.moved_m - np.nan_to_num(swung_m))

    @property
    def course_rad(self) -> FloatArray:
        """Direction (K,) of the measured displacement in the frame of the poses."""
        return np.asarray(np.arctan2(self.moved_m[:, 1], self.moved_m[:, 0]))


@dataclass(frozen=True)
class Integrals:
    """Tread travel and gyroscope heading as functions of the stamp.

    Attributes
    ----------
    left_m, right_m, gyroscope_rad : callable of stamps (K,) to (K,)
        The last one gives NaN where no gyroscope was recorded.
    silent_s : (S, 2)
        Stamps between which the gyroscope was not measured. Differences across them are no turns.
    """

    left_m: Callable[[FloatArray], FloatArray]
    right_m: Callable[[FloatArray], FloatArray]
    gyroscope_rad: Callable[[FloatArray], FloatArray]
    silent_s: FloatArray

    def between(
        self, begin_s: FloatArray, end_s: FloatArray
    ) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Left and right travel and turn by the gyroscope (K,) from stamps (K,) to others.

        The turn is NaN where the gyroscope was not measured for a while in between.
        """
        left_m, right_m, turn_rad = (
            integral(end_s) - integral(begin_s)
            for integral in (self.left_m, self.right_m, self.gyroscope_rad)
        )
        silent = touched(self.silent_s, begin_s, end_s)
        return left_m, right_m, np.where(silent, np.nan, turn_rad)


def integrals(
    run: Run,
    speeds_m_s: FloatArray,
    yaw_rate: tuple[FloatArray, FloatArray] | None,
    silent_s: FloatArray,
) -> Integrals:
    """Integrals of held values.

    Parameters
    ----------
    run : Run
    speeds_m_s : (N, 2)
        Tread speeds without spikes, at the stamps of odometry.csv.
    yaw_rate : (stamps (G,), rad/s (G,)) or None
    silent_s : (S, 2)
        Stamps between which it was not measured.
    """
    stamps_s = run.odometry.stamps_s
    turned = _held(*yaw_rate) if yaw_rate is not None else lambda s: np.full(len(s), np.nan)
    return Integrals(
        _held(stamps_s, speeds_m_s[:, 0]),
        _held(stamps_s, speeds_m_s[:, 1]),
        lambda at_s: np.where(touched(silent_s, at_s, at_s), np.nan, turned(at_s)),
        silent_s,
    )


def motion_between(
    run: Run, of: Integrals, poses_used: BoolArray | None, window_s: float = WINDOW_S
) -> Motion:
    """Cut a run into windows of half a second, between measured poses where there are any.

    Parameters
    ----------
    run : Run
    of : Integrals
    poses_used : (M,) or None
        Which rows of pose.csv count.
    window_s : float
        Least length of a window.
    """
    odometry_s = run.odometry.stamps_s
    if run.pose is not None and poses_used is not None and poses_used.sum() >= 2:
        pose_s = run.pose.stamps_s
        inside = poses_used & (pose_s >= odometry_s[0]) & (pose_s <= odometry_s[-1])
        rows = _spaced(pose_s, np.flatnonzero(inside), window_s)
        if len(rows) >= 2:
            return _between_poses(run, of, rows, window_s)
    edges_s = np.arange(odometry_s[0], odometry_s[-1], window_s)
    nothing = np.full((max(len(edges_s) - 1, 0), 2), np.nan)
    return _window(edges_s[:-1], edges_s[1:], of, nothing, nothing)


def turns_both_ways(motion: Motion) -> bool:
    """Whether there are left and right turns: else an offset looks like a wrong width."""
    turns = motion.difference_m[np.abs(motion.difference_m) > 0.05 * np.abs(motion.mean_m)]
    left = float(np.mean(turns > 0)) if len(turns) else 0.0
    return 0.15 < left < 0.85


def _between_poses(run: Run, of: Integrals, rows: IntArray, window_s: float) -> Motion:
    assert run.pose is not None  # noqa: S101 - for the type checker: checked by the caller
    first, last = rows[:-1], rows[1:]
    pose_s = run.pose.stamps_s
    lasts_s = pose_s[last] - pose_s[first]
    near = lasts_s <= LONGEST * max(window_s, float(np.median(np.diff(pose_s))))
    if "window" in run.pose:
        window = np.nan_to_num(run.pose["window"])
        near &= window[first] == window[last]
    first, last = first[near], last[near]
    positions, yaw = run.pose.stack("x", "y"), run.pose["yaw"]
    return _window(
        pose_s[first],
        pose_s[last],
        of,
        positions[last] - positions[first],
        np.stack([yaw[first], yaw[last]], axis=-1),
    )


def _window(
    start_s: FloatArray, end_s: FloatArray, of: Integrals, moved: FloatArray, yaw: FloatArray
) -> Motion:
    return Motion(start_s, end_s, *of.between(start_s, end_s), moved, yaw)


def _spaced(pose_s: FloatArray, rows: IntArray, apart_s: float) -> IntArray:
    """Rows at least so far apart."""
    stamps_s, chosen, place = pose_s[rows].tolist(), [], 0
    while place < len(rows):
        chosen.append(place)
        place = bisect_left(stamps_s, stamps_s[place] + apart_s - 1e-6)
    return np.asarray(rows[chosen], dtype=np.int64)


def _held(stamps_s: FloatArray, values: FloatArray) -> Callable[[FloatArray], FloatArray]:
    """Integral of values that hold until the next stamp; NaN outside of the stamps."""
    known = np.isfinite(values)
    if not known.all():
        stamps_s, values = stamps_s[known], values[known]
    if len(stamps_s) < 2:
        return lambda at_s: np.full(len(at_s), np.nan)
    summed = np.concatenate([[0.0], np.cumsum(values[:-1] * np.diff(stamps_s))])
    return lambda at_s: np.asarray(np.interp(at_s, stamps_s, summed, left=np.nan, right=np.nan))
