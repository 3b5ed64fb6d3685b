"""Poses so close that their measured yaws determine the turn between them, with whole turns."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.geometry.angles import wrap
from odometry.windows.measured_poses import TreadTravel
from odometry.windows.spans import touched

FASTEST = 2.0  # times the turn of treads that do not slip: the stated width may be twice too large
SKEWED = 0.1  # of the treads' travel by the width: a turn while both treads are as fast
POSE_RAD = 0.2  # by which measured yaws may be off
CLOSE_S = 5.0  # longest pair from which something is learned
LEAST_PAIRS = 8
LEAST_TURNED_RAD = 2.0  # over all pairs: less determines no scale


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
