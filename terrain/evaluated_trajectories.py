"""Which trajectories of a run are evaluated, and with which poses."""

from dataclasses import dataclass

import numpy as np

from odometry.estimates import Replay
from odometry.evaluation.withheld import Withheld
from odometry.geometry import se2
from odometry.run import Run
from odometry.trajectory import Trajectory


@dataclass(frozen=True)
class SecondReplay:
    """The same filter on the same run, without the poses of the evaluation.

    Attributes
    ----------
    withheld : Withheld
    replay : Replay
    """

    withheld: Withheld
    replay: Replay


@dataclass(frozen=True)
class EvaluatedTrajectory:
    """A trajectory, the poses that it is compared with, and their name.

    Attributes
    ----------
    trajectory, reference : Trajectory
    against : str
        "truth", "pose" or "withheld pose".
    """

    trajectory: Trajectory
    reference: Trajectory
    against: str


def evaluated_trajectories(
    run: Run,
    replay: Replay,
    reference_name: str,
    reference: Trajectory | None,
    second: SecondReplay | None,
) -> dict[str, EvaluatedTrajectory]:
    """Every trajectory that can be evaluated fairly, by name; none without a reference.

    No pose corrects the open-loop ones. The filter uses pose.csv: without a truth its estimate
    is evaluated in a second replay, with poses that were held out from it.
    """
    if reference is None:
        return {}
    found = {
        name: EvaluatedTrajectory(
            at_reference_point(run, reference_name, trajectory), reference, reference_name
        )
        for name, trajectory in replay.open_loop(run.robot.track_width).items()
    }
    if reference_name == "truth":
        found["estimate"] = EvaluatedTrajectory(replay.trajectory(), reference, reference_name)
    elif second is not None:
        estimate = at_reference_point(run, reference_name, second.replay.trajectory())
        found["estimate"] = EvaluatedTrajectory(estimate, second.withheld.judged, "withheld pose")
    return found


def at_reference_point(run: Run, reference_name: str, trajectory: Trajectory) -> Trajectory:
    """A trajectory of the point that the reference measures: in pose.csv that is the antenna."""
    if reference_name != "pose" or run.sensors.pose_m is None:
        return trajectory
    places = se2.transform(trajectory.poses, np.array(run.sensors.pose_m[:2]))
    return Trajectory(trajectory.stamps_s, np.column_stack([places, trajectory.poses[:, 2]]))
