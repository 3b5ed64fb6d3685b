"""Which trajectories of a run are judged, and by which poses."""

from dataclasses import dataclass

import numpy as np

from odometry.estimates import Replay
from odometry.evaluation.withheld import Withheld
from odometry.geometry import se2
from odometry.run import Run
from odometry.trajectory import Trajectory


@dataclass(frozen=True)
class SecondReplay:
    """The same filter on the same run without the poses that judge it.

    Attributes
    ----------
    withheld : Withheld
    replay : Replay
    """

    withheld: Withheld
    replay: Replay


@dataclass(frozen=True)
class Judged:
    """A trajectory, the poses that judge it, and what these are called.

    Attributes
    ----------
    trajectory, reference : Trajectory
    against : str
        "truth", "pose" or "withheld pose".
    """

    trajectory: Trajectory
    reference: Trajectory
    against: str


def judged_trajectories(
    run: Run,
    replay: Replay,
    reference_name: str,
    reference: Trajectory | None,
    second: SecondReplay | None,
) -> dict[str, Judged]:
    """Every trajectory that can be judged fairly, by name; none without a reference.

    No pose corrects the open-loop ones. The filter has seen pose.csv: without a truth its estimate
    is judged in a second replay, by poses that were withheld from it.
    """
    if reference is None:
        return {}
    found = {
        name: Judged(seen_by(run, reference_name, trajectory), reference, reference_name)
        for name, trajectory in replay.open_loop(run.robot.track_width).items()
    }
    if reference_name == "truth":
        found["estimate"] = Judged(replay.trajectory(), reference, reference_name)
    elif second is not None:
        estimate = seen_by(run, reference_name, second.replay.trajectory())
        found["estimate"] = Judged(estimate, second.withheld.judged, "withheld pose")
    return found


def seen_by(run: Run, reference_name: str, trajectory: Trajectory) -> Trajectory:
    """A trajectory of the robot as its reference sees it: pose.csv holds the antenna's place."""
    if reference_name != "pose" or run.sensors.pose_m is None:
        return trajectory
    places = se2.transform(trajectory.poses, np.array(run.sensors.pose_m[:2]))
    return Trajectory(trajectory.stamps_s, np.column_stack([places, trajectory.poses[:, 2]]))
