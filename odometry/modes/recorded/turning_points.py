"""How far ahead of its origin a robot turns, by measured poses alone.

On a terrain the robot turns about nearly one point of its own (x_icr). A load that shifts, or a
load more, moves that point by as much as it moves the centre of mass; by how much the robot then
turns for given treads is as on another terrain.
"""

from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.modes.recorded.measured_steps import LEAST_STEPS, step_windows
from odometry.modes.recorded.pose_steps import ASIDE, TURN, PoseSteps, pose_steps
from odometry.recording.run import Run
from odometry.windows.recorded.measured_poses import YAW_FOUND

WINDOW_S = 16.0
# Prior deviations of a drift in the world, as on a slope, and of the error of a step.
DRIFT_M_S, STEP_M = 0.03, 0.02
FREE_M = 20.0  # of a point: any
TURNING_RAD_S, TURNED_S = 0.03, 3.0  # in a window: less determines no point
UNKNOWNS = 3  # of a window: the point, and a drift in x and y


@dataclass(frozen=True)
class TurningPoints:
    """Of windows that turn enough.

    Attributes
    ----------
    ends_s : (W,)
    ahead_m : (W,)
        The point about which the robot turned in the WINDOW_S before.
    sigma_m : (W,)
        Its standard deviation, by what the window leaves.
    """

    ends_s: FloatArray
    ahead_m: FloatArray
    sigma_m: FloatArray


def turning_points(run: Run) -> TurningPoints | None:
    """Of the windows of a run, which end each half second; None without measured yaw.

    Displacement and turn are taken between the same two poses, so that late poses do not matter.
    A yaw that was found from positions holds an assumption on this point, and is not used.
    """
    if run.pose is None or YAW_FOUND in run.pose:
        return None
    stamps_s, breaks_s = run.pose.stamps_s, np.empty((0, 2))
    if "window" in run.pose:
        new = np.flatnonzero(np.diff(run.pose["window"]))
        breaks_s = np.column_stack([stamps_s[new], stamps_s[new + 1]])
    steps = pose_steps(stamps_s, run.pose.stack("x", "y", "yaw"), breaks_s)
    return _points(steps) if len(steps) >= LEAST_STEPS else None


def _points(steps: PoseSteps) -> TurningPoints:
    """Least squares of sideways motion, -ahead * turn and a drift, in each window."""
    windows = step_windows(steps.begin_s, steps.end_s, WINDOW_S)
    aside, turn, lasts_s = steps.moved[:, ASIDE], steps.moved[:, TURN], steps.lasts_s
    drift = lasts_s * np.array([-np.sin(steps.heading_rad), np.cos(steps.heading_rad)])
    table = np.vstack([-turn, drift])
    normal = np.moveaxis(windows.sums(table[:, None] * table), -1, 0)
    prior = np.diag(STEP_M**2 / np.square([FREE_M, DRIFT_M_S, DRIFT_M_S]))
    inverse = np.linalg.inv(normal + prior)
    right = windows.sums(table * aside)
    found = np.einsum("wij,jw->wi", inverse, right)
    left = np.maximum(windows.sums(aside**2) - np.einsum("wi,iw->w", found, right), 0.0)
    # errors of steps that overlap count as one
    freedom = windows.sums(np.ones(len(steps))) / steps.overlapping - UNKNOWNS
    variances = left / np.maximum(freedom, 1.0) * inverse[:, 0, 0]
    turning = np.abs(turn) > TURNING_RAD_S * lasts_s
    known = windows.sums(turning * lasts_s) / steps.overlapping > TURNED_S
    known &= freedom > 0
    return TurningPoints(windows.ends_s[known], found[known, 0], np.sqrt(variances[known]))
