"""What is known of a run at any moment: measured poses, and the travel of its treads."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.geometry import se2
from odometry.geometry.angles import wrap
from odometry.recording.run import Run
from odometry.windows.recorded.interpolated import interpolated
from odometry.windows.recorded.spans import touched

YAW_FOUND = "yaw_from_positions_sigma"  # column of pose tables whose yaw is no measured one

FASTEST = 2.0  # times the turn of treads that do not slip: the stated width may be twice too large
SKEWED = 0.1  # of the treads' travel by the width: a turn while both treads are as fast
POSE_RAD = 0.2  # by which measured yaws may be off
CLOSE_S = 5.0  # longest pair from which something is learned
LEAST_PAIRS = 8
LEAST_TURNED_RAD = 2.0  # over all pairs: less determines no scale


def measured_poses(run: Run) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stamps (M,), poses (M, 3) and source windows (M,), without rows of missing cells.

    Rows that were interpolated between measured ones are left out (`interpolated`).

    Poses are those of the robot: where `[sensors]` states a lever arm, the measured position less
    R(yaw) times it.
    """
    if run.pose is None:
        return np.empty(0), np.empty((0, 3)), np.empty(0)
    poses = run.pose.stack("x", "y", "yaw")
    measured = _measured(run.pose.stamps_s, poses)
    windows = run.pose["window"] if "window" in run.pose.columns else np.zeros(len(poses))
    return (
        run.pose.stamps_s[measured],
        of_robot(run, poses[measured]),
        np.nan_to_num(windows)[measured],
    )


def _measured(stamps_s: FloatArray, poses: FloatArray) -> BoolArray:
    """Which rows (M,) of poses (M, 2 or 3) are complete and were measured."""
    rows = np.flatnonzero(np.isfinite(poses).all(axis=1))
    measured = np.zeros(len(poses), dtype=np.bool_)
    measured[rows[~interpolated(stamps_s[rows], poses[rows, :2])]] = True
    return measured


def of_robot(run: Run, poses: FloatArray) -> FloatArray:
    """Poses (M, 3) of the robot's origin from those of the antenna that `[sensors]` places."""
    if run.sensors.pose_m is None:
        return poses
    arm_m = np.array(run.sensors.pose_m[:2])
    return np.column_stack([se2.transform(poses, -arm_m), poses[:, 2]])


def positions_at(time_s: FloatArray, stamps_s: FloatArray, poses: FloatArray) -> FloatArray:
    """Positions (N, 2) at times (N,), between poses (M, 2 or 3) and held beyond them."""
    return np.column_stack([np.interp(time_s, stamps_s, poses[:, k]) for k in (0, 1)])


def measured_positions(run: Run) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Stamps (M,), positions (M, 2) and source windows (M,) of rows with x and y, yaw or not.

    Positions are those of the antenna, as recorded; interpolated ones are left out.
    """
    if run.pose is None:
        return np.empty(0), np.empty((0, 2)), np.empty(0)
    positions = run.pose.stack("x", "y")
    measured = _measured(run.pose.stamps_s, positions)
    windows = run.pose["window"] if "window" in run.pose.columns else np.zeros(len(positions))
    return run.pose.stamps_s[measured], positions[measured], np.nan_to_num(windows)[measured]


def lacks_yaw(run: Run) -> bool:
    """Whether positions are measured and fewer than half of them with a yaw: GNSS, for example.

    A yaw that was found from positions is not measured.
    """
    if run.pose is not None and YAW_FOUND in run.pose:
        return True
    positions = len(measured_positions(run)[0])
    return 2 * len(measured_poses(run)[0]) < positions


@dataclass(frozen=True)
class TreadTravel:
    """Integrals over the tread speeds of a run, up to each of N stamps.

    Attributes
    ----------
    stamps_s : (N,)
    integrals_m : (N, 4)
        Of the speed (v_left + v_right) / 2, of the difference v_right - v_left, of the size of
        this difference, and of |v_left| + |v_right|.
    """

    stamps_s: FloatArray
    integrals_m: FloatArray

    def between(self, begin_s: FloatArray, end_s: FloatArray) -> FloatArray:
        """Integrals (4, K) from stamps (K,) to others; treads stand outside of the N stamps."""
        return np.stack(
            [
                np.interp(end_s, self.stamps_s, column) - np.interp(begin_s, self.stamps_s, column)
                for column in self.integrals_m.T
            ]
        )


def tread_travel(run: Run) -> TreadTravel:
    """Integrate the tread speeds of a run."""
    stamps_s = run.odometry.stamps_s
    steps_s, integrals_m = np.diff(stamps_s), np.zeros((4, len(stamps_s)))
    for of, rates in zip(integrals_m, _rates(run), strict=True):
        np.cumsum(rates[:-1] * steps_s, out=of[1:])
    return TreadTravel(stamps_s, integrals_m.T)


def _rates(run: Run) -> Iterator[FloatArray]:
    """What `TreadTravel` integrates, one (N,) after the other."""
    left, right = run.odometry["v_left"], run.odometry["v_right"]
    yield (left + right) / 2
    yield right - left
    yield np.abs(right - left)
    yield np.abs(left) + np.abs(right)


@dataclass(frozen=True)
class ClosePairs:
    """Turns (C,) that measured yaws determine by themselves, from stamps (C,) to others."""

    begin_s: FloatArray
    end_s: FloatArray
    turned_rad: FloatArray

    def where(self, chosen: BoolArray) -> "ClosePairs":
        """The chosen (C,) pairs."""
        return ClosePairs(self.begin_s[chosen], self.end_s[chosen], self.turned_rad[chosen])

    @property
    def tell_a_scale(self) -> bool:
        """Whether they are enough, and turned enough, to compare another sensor with."""
        turned_rad = float(np.abs(self.turned_rad).sum())
        return len(self.turned_rad) >= LEAST_PAIRS and turned_rad >= LEAST_TURNED_RAD


def close_pairs(
    travel: TreadTravel,
    width_m: float,
    stamps_s: FloatArray,
    yaw_rad: FloatArray,
    gaps_s: FloatArray,
) -> ClosePairs:
    """Poses end to end, as far apart as treads of half the width turn less than half a turn."""
    turn = fastest_rad(travel, width_m, np.full(len(stamps_s), stamps_s[0]), stamps_s)
    reached = np.searchsorted(turn, turn + np.pi - POSE_RAD) - 1
    in_time = np.searchsorted(stamps_s, stamps_s + CLOSE_S, side="right") - 1
    last = np.minimum(reached, in_time)
    ends, at = [], 0
    while at < len(stamps_s) - 1:
        if last[at] > at:
            ends.append((at, int(last[at])))
        at = max(int(last[at]), at + 1)
    begin, end = np.array(ends, dtype=np.int64).reshape(-1, 2).T
    seen = ~unseen(travel, gaps_s, stamps_s[begin], stamps_s[end])
    begin, end = begin[seen], end[seen]
    return ClosePairs(stamps_s[begin], stamps_s[end], wrap(yaw_rad[end] - yaw_rad[begin]))


def fastest_rad(
    travel: TreadTravel, width_m: float, begin_s: FloatArray, end_s: FloatArray
) -> FloatArray:
    """The largest turns (K,) that treads of half the stated width could make."""
    _, _, difference_m, gross_m = travel.between(begin_s, end_s)
    return np.asarray((FASTEST * difference_m + SKEWED * gross_m) / width_m)


def unseen(
    travel: TreadTravel, gaps_s: FloatArray, begin_s: FloatArray, end_s: FloatArray
) -> BoolArray:
    """Whether treads were not recorded at some time from stamps (K,) to others."""
    outside = (begin_s < travel.stamps_s[0]) | (end_s > travel.stamps_s[-1])
    return np.asarray(outside | touched(gaps_s, begin_s, end_s))
