"""Which trajectories of a run are judged, and by which poses."""

from dataclasses import dataclass

from odometry.evaluation.withheld import Withheld
from odometry.replay import Replay
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
    replay: Replay,
    track_width: float,
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
        name: Judged(trajectory, reference, reference_name)
        for name, trajectory in replay.open_loop(track_width).items()
    }
    if reference_name == "truth":
        found["estimate"] = Judged(replay.trajectory(), reference, reference_name)
    elif second is not None:
        estimate = second.replay.trajectory()
        found["estimate"] = Judged(estimate, second.withheld.judged, "withheld pose")
    return found
