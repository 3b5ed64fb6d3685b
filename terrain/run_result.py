"""The result of a replayed run, and which of its trajectories are evaluated with which poses."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from odometry.estimates import Replay
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.relative import position_errors
from odometry.evaluation.score import Score, Withheld, score
from odometry.evaluation.stretches import stretches
from odometry.geometry import se2
from odometry.parameters import ParameterSet
from odometry.run import Run
from odometry.trajectory import Trajectory
from terrain.config import Config
from terrain.contradictions_so_far import Contradiction
from terrain.switch import SwitchEvent
from terrain.watcher import TerrainWatcher


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


def is_used_by_filter(reference_name: str) -> bool:
    """Whether the filter used the reference, which then cannot evaluate its estimate."""
    return reference_name == "pose"


def at_reference_point(run: Run, reference_name: str, trajectory: Trajectory) -> Trajectory:
    """A trajectory of the point that the reference measures: in pose.csv that is the antenna."""
    if reference_name != "pose" or run.sensors.pose_m is None:
        return trajectory
    places = se2.transform(trajectory.poses, np.array(run.sensors.pose_m[:2]))
    return Trajectory(trajectory.stamps_s, np.column_stack([places, trajectory.poses[:, 2]]))


@dataclass(frozen=True)
class TerrainChange:
    """A change of the terrain in force that comes from another source than the camera.

    Attributes
    ----------
    terrain : str
    stamp_s : float
    """

    terrain: str
    stamp_s: float


@dataclass(frozen=True)
class RunResult:
    """Everything that the replay of one run gives.

    Attributes
    ----------
    run : Run
        With the poses of the robot: effects on the measurement are undone.
    config : Config
    parameters : ParameterSet
        What was known before the run.
    initial_terrain : str
    watcher : TerrainWatcher or None
        Labels of the images; None without vision.
    replay : Replay
        Estimates at every frame.
    reference_name : str
        "truth", "pose" or "" where there is none.
    reference : Trajectory or None
    learned : ParameterSet
        `parameters`, with what the filter learned about the terrains that it drove on.
    uncertainty : OdometerUncertainty
        Covariance of the odometer along the run.
    second : SecondReplay or None
        The run replayed without the poses that the estimate is evaluated with; None where there is
        a truth, or too few poses.
    source : str
        Source of the terrain: "camera", "labels", "modes", "feel", "none", or the user's own.
    contradictions : tuple of Contradiction
        Where camera, feel and motion differ for long, or no source knows the terrain.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> result = terrain.run_odometry(run, vision=False)
    >>> result.reference_name, sorted(result.scores)[:3]
    ('truth', ['differential_drive', 'estimate', 'gyroscope'])
    """

    run: Run
    config: Config
    parameters: ParameterSet
    initial_terrain: str
    watcher: TerrainWatcher | None
    replay: Replay
    reference_name: str
    reference: Trajectory | None
    learned: ParameterSet
    uncertainty: OdometerUncertainty
    second: SecondReplay | None = None
    source: str = "none"
    contradictions: tuple[Contradiction, ...] = ()

    @property
    def judged(self) -> dict[str, EvaluatedTrajectory]:
        """`evaluated` under its old name, for one version."""
        return self.evaluated

    @cached_property
    def evaluated(self) -> dict[str, EvaluatedTrajectory]:
        """Every trajectory that can be evaluated fairly, with the poses that it is compared with.

        differential_drive, gyroscope, odometer_without_gyroscope (both only where there is one),
        odometer, and estimate; none without a reference. No pose corrects the open-loop ones. The
        filter uses pose.csv: without a truth its estimate is evaluated in a second replay, with
        poses that were held out from it.
        """
        if self.reference is None:
            return {}
        lines = self.replay.open_loop(self.run.robot.track_width)
        found = {name: self.beside_reference(line) for name, line in lines.items()}
        if not is_used_by_filter(self.reference_name):
            found["estimate"] = self.beside_reference(self.replay.trajectory())
        elif self.second is not None:
            estimate = self.beside_reference(self.second.replay.trajectory())
            poses = self.second.withheld.judged
            found["estimate"] = replace(estimate, reference=poses, against="withheld pose")
        return found

    def beside_reference(self, trajectory: Trajectory) -> EvaluatedTrajectory:
        """A trajectory of the robot, moved to the point that the reference measures.

        Raises
        ------
        ValueError
            If there is no reference.
        """
        if self.reference is None:
            raise ValueError(f"{self.run.name} has no reference")
        moved = at_reference_point(self.run, self.reference_name, trajectory)
        return EvaluatedTrajectory(moved, self.reference, self.reference_name)

    @cached_property
    def scores(self) -> dict[str, Score]:
        """Errors of each trajectory that is evaluated, by its name."""
        return {name: self.score_of(of) for name, of in self.evaluated.items()}

    def score_of(self, evaluated: EvaluatedTrajectory) -> Score:
        """Errors of a trajectory of this run."""
        line, reference = evaluated.trajectory, evaluated.reference
        return score(self.run, line, reference, self.config.evaluation)

    @property
    def off_at_the_end_m(self) -> dict[str, float]:
        """Distance of each trajectory, as delivered, from the reference at its last stamp.

        Where the reference is pose.csv the filter has used it, up to that pose: the distance of the
        estimate is no measure of its error, but a large one shows that the filter lost the poses.
        """
        delivered = dict(self.evaluated)
        if self.reference is not None:
            delivered["estimate"] = self.beside_reference(self.replay.trajectory())
        distances = {
            name: position_errors(of.trajectory, of.reference)[1] for name, of in delivered.items()
        }
        return {name: float(found[-1]) for name, found in distances.items() if len(found)}

    @property
    def changes(self) -> tuple[SwitchEvent | TerrainChange, ...]:
        """Every change of the terrain in force, in order of time."""
        if self.watcher is not None:
            return tuple(self.watcher.events)
        found = stretches(self.replay.stamps_s, self.replay.terrains)
        return tuple(TerrainChange(of.terrain, of.start_s) for of in found[1:])

    @property
    def effects(self) -> dict[str, list[str]]:
        """Names of the effects that were added, by terrain."""
        return {
            name: [str(effect["name"]) for effect in table.effects]
            for name, table in self.parameters.terrains.items()
            if table.effects
        }

    @property
    def has_learned(self) -> bool:
        """Whether `learned` differs from what was known before."""
        before = self.parameters.terrains
        return any(of is not before.get(name) for name, of in self.learned.terrains.items())
