"""reference.csv of a result folder: the poses that judge, for whoever judges others by them."""

from typing import Any

import numpy as np

from odometry.evaluation.score import counted_reference_yaw
from terrain.run_result import RunResult


def reference_columns(result: RunResult) -> dict[str, Any]:
    """Columns by name: t, x, y, yaw (whole turns counted) and wheel_travel; none without poses."""
    reference, run = result.reference, result.run
    if reference is None:
        return {}
    travel_m = np.interp(reference.stamps_s, run.odometry.stamps_s, run.wheel_travel_m)
    x, y, _ = reference.poses.T
    yaw = counted_reference_yaw(run, reference)
    return {"t": reference.stamps_s, "x": x, "y": y, "yaw": yaw, "wheel_travel": travel_m}


def reference_place_m(result: RunResult) -> list[float]:
    """Where the reference's poses are taken, x and y in the robot frame [m]."""
    lever_m = result.run.sensors.pose_m
    return list(lever_m[:2]) if result.reference_name == "pose" and lever_m else [0.0, 0.0]
