"""The result of a replayed run."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import pairwise

from odometry.checks.findings.finding import CheckReport
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.relative import position_errors
from odometry.evaluation.score import Score
from odometry.evaluation.stretches import Stretch, stretches
from odometry.parameters import ParameterSet
from odometry.recording.run import UNKNOWN, Run
from odometry.replays.estimates import Replay
from odometry.trajectory import Trajectory
from terrain.config import Config
from terrain.result.contradictions_so_far import Contradiction
from terrain.result.evaluated import (
    EvaluatedTrajectory,
    SecondReplay,
    at_reference_point,
    is_used_by_filter,
    scatter_of_reference,
)
from terrain.result.evaluation_notes import remarks
from terrain.sources.watcher import TerrainWatcher
from terrain.switch.switch import SwitchEvent


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
    report : CheckReport or None
        What the check found in a folder that `run_odometry` read; None of a `Run`.

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
    report: CheckReport | None = None

    @property
    def reports(self) -> tuple[CheckReport, ...]:
        """`report`, or none."""
        return () if self.report is None else (self.report,)

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
        lines = self.replay.open_loop_by_name(self.run.robot.track_width)
        found = {name: self.beside_reference(line) for name, line in lines.items()}
        if not is_used_by_filter(self.reference_name):
            found["estimate"] = self.beside_reference(self.replay.trajectory)
        elif self.second is not None:
            estimate = self.beside_reference(self.second.replay.trajectory)
            poses = self.second.withheld.judged
            found["estimate"] = replace(estimate, reference=poses, against="withheld pose")
        return found

    def beside_reference(self, reckon: Callable[[], Trajectory]) -> EvaluatedTrajectory:
        """A trajectory of the robot, moved to the point that the reference measures.

        Raises
        ------
        ValueError
            If there is no reference.
        """
        if self.reference is None:
            raise ValueError(f"{self.run.name} has no reference")
        moved = partial(at_reference_point, self.run, self.reference_name, reckon)
        return EvaluatedTrajectory(
            moved, self.reference, self.reference_name, self.run, self.config.evaluation
        )

    @cached_property
    def scores(self) -> dict[str, Score]:
        """Errors of each trajectory that is evaluated, by its name."""
        return {name: of.score for name, of in self.evaluated.items()}

    @cached_property
    def off_at_the_end_m(self) -> dict[str, float]:
        """Distance of each trajectory, as delivered, from the reference at its last stamp.

        Where the reference is pose.csv the filter has used it, up to that pose: the distance of the
        estimate is no measure of its error, but a large one shows that the filter lost the poses.
        """
        distances = {name: of.position_errors[1] for name, of in self.evaluated.items()}
        if self.reference is not None:
            delivered = self.beside_reference(self.replay.trajectory).trajectory
            distances["estimate"] = position_errors(delivered, self.reference)[1]
        return {name: float(found[-1]) for name, found in distances.items() if len(found)}

    @property
    def remarks(self) -> list[str]:
        """Sentences that belong beside the errors."""
        events, horizon_m = self.replay.events, self.config.evaluation.horizon_m
        return [
            *scatter_of_reference(events, self.reference_name, horizon_m),
            *remarks(self.scores, self.off_at_the_end_m, events),
        ]

    @property
    def changes(self) -> tuple[SwitchEvent | TerrainChange, ...]:
        """Every change of the terrain in force, in order of time."""
        if self.watcher is not None:
            return tuple(self.watcher.events)
        return tuple(TerrainChange(of.terrain, of.start_s) for of in self.in_force[1:])

    @property
    def in_force(self) -> tuple[Stretch, ...]:
        """Stretches of the terrain in force; `unknown` where for long no label supported it."""
        return stretches(self.replay.stamps_s, self.replay.terrains)

    @property
    def changes_and_unknown(self) -> tuple[SwitchEvent | TerrainChange, ...]:
        """`changes`, and where the terrain in force became `unknown` or was supported again."""
        if self.watcher is None:
            return self.changes
        found, known = list(self.changes), self.initial_terrain
        for before, of in pairwise(self.in_force):
            known = known if before.terrain == UNKNOWN else before.terrain
            if of.terrain == UNKNOWN or (before.terrain == UNKNOWN and of.terrain == known):
                found.append(TerrainChange(of.terrain, of.start_s))
        return tuple(sorted(found, key=lambda change: change.stamp_s))

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
