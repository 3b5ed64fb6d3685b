"""What a prepared model says that the reference sensor sees over windows."""

from dataclasses import replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.comparison.predictor import Predictor
from odometry.effects.corrected import Added, delay_s, seen_poses
from odometry.effects.tables import effects_of
from odometry.evaluation.open_loop import measured_poses
from odometry.geometry import se2
from odometry.models.run_inputs import inputs_of
from odometry.run import Run
from odometry.windows.motion import level_path, window_motion
from odometry.windows.windows import Windows


def predicted_motion(predictor: Predictor, run: Run, windows: Windows) -> FloatArray:
    """Motion (K, 3) of the reference sensor over each window of one run; yaw is not wrapped.

    Effects may depend on what was before a window (the moment of a loss, the last command), so
    that a model with effects is computed on the whole run.
    """
    effects = effects_of(predictor.model)
    if not effects:
        return window_motion(predictor.model, predictor.packed, windows)
    pose_s, _ = measured_poses(run)
    seen = seen_poses(effects, _robot_poses(predictor, effects, run, pose_s))
    first = np.searchsorted(pose_s, windows.start_s)
    last = first + windows.last_pose - windows.first_pose
    motion = se2.between(seen[first], seen[last])
    motion[:, 2] = seen[last, 2] - seen[first, 2]
    return motion


def _robot_poses(
    predictor: Predictor, effects: tuple[Added, ...], run: Run, pose_s: FloatArray
) -> FloatArray:
    """Poses (M, 3) of the robot when the poses stamped (M,) were measured, from the origin.

    Before the first and after the last stamp of odometry the robot stands.
    """
    odometry_s = run.odometry.stamps_s
    measured_s = np.clip(pose_s - delay_s(effects), odometry_s[0], odometry_s[-1])
    stamps_s = np.union1d(odometry_s, measured_s)
    rows = np.searchsorted(odometry_s, stamps_s, side="right") - 1
    inputs = replace(inputs_of(run).rows(rows), time_s=stamps_s - odometry_s[0])
    twists = predictor.model.twist(predictor.packed, inputs)
    path = level_path(twists, np.append(np.diff(stamps_s), 0.0), inputs)
    return np.asarray(path[np.searchsorted(stamps_s, measured_s)])
