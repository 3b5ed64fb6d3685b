"""Steps from one measured pose to another half a second later, in the frame of the robot."""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se2
from odometry.geometry.angles import wrap
from odometry.windows.recorded.spans import touched

STEP_S, LONGEST_S = 0.5, 1.05  # from a pose to the one it is compared with
AHEAD, ASIDE, TURN = 0, 1, 2


@dataclass(frozen=True)
class PoseSteps:
    """K steps that overlap, each from a measured pose to one STEP_S later or a little more.

    `moved` (K, 3) is ahead, to the left [m] and turn [rad]: the constant twist of a step times its
    duration; `heading_rad` (K,) is that in the middle.
    """

    begin_s: FloatArray
    end_s: FloatArray
    moved: FloatArray
    heading_rad: FloatArray

    def __len__(self) -> int:
        return len(self.begin_s)

    @property
    def lasts_s(self) -> FloatArray:
        """Duration (K,) of each."""
        return self.end_s - self.begin_s

    @property
    def overlapping(self) -> float:
        """How many steps hold one moment."""
        return max(float(np.median(self.lasts_s) / np.median(np.diff(self.begin_s))), 1.0)


def pose_steps(stamps_s: FloatArray, poses: FloatArray, gaps_s: FloatArray) -> PoseSteps:
    """Steps of poses (N, 3), NaN where none was measured; none touches a gap (G, 2)."""
    known = np.isfinite(poses).all(axis=1)
    stamps_s, poses = stamps_s[known], poses[known]
    last = np.searchsorted(stamps_s, stamps_s + STEP_S - 1e-6)
    first = np.flatnonzero(last < len(stamps_s))
    last = last[first]
    begin_s, end_s = stamps_s[first], stamps_s[last]
    kept = (end_s - begin_s <= LONGEST_S) & ~touched(gaps_s, begin_s, end_s)
    first, last = first[kept], last[kept]
    moved = np.asarray(se2.between(poses[first], poses[last]))
    moved[:, TURN] = wrap(moved[:, TURN])
    heading = poses[first, 2] + moved[:, TURN] / 2
    return PoseSteps(stamps_s[first], stamps_s[last], se2.log(moved), heading)
