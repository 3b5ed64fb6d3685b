"""All that came out of a replayed run."""

from dataclasses import dataclass

from odometry.estimates import Replay
from odometry.evaluation.odometer_uncertainty import OdometerUncertainty
from odometry.evaluation.relative import position_errors
from odometry.evaluation.score import Score
from odometry.evaluation.stretches import stretches
from odometry.parameters import ParameterSet
from odometry.run import Run
from odometry.trajectory import Trajectory
from terrain.config import Config
from terrain.judged import Judged, SecondReplay, judged_trajectories, seen_by
from terrain.switch import SwitchEvent
from terrain.terrain_change import TerrainChange
from terrain.watcher import TerrainWatcher


@dataclass(frozen=True)
class RunResult:
    """All that came out of one run.

    Attributes
    ----------
    run : Run
        With the poses of the robot: effects on the measurement are undone.
    config : Config
    parameters : ParameterSet
        What was known before the run.
    initial_terrain : str
    watcher : TerrainWatcher or None
        What was seen; None without vision.
    replay : Replay
        Estimates at every frame.
    reference_name : str
        "truth", "pose" or "" where there is none.
    reference : Trajectory or None
    scores : dict of str to Score
        By trajectory: differential_drive, gyroscope, odometer_without_gyroscope (both only where
        there is one), odometer, and estimate where `judged` holds it.
    learned : ParameterSet
        `parameters` with what the filter learned in place of what it visited.
    uncertainty : OdometerUncertainty
        Covariance of the odometer along the run.
    second : SecondReplay or None
        The run replayed without the poses that judge the estimate; None where there is a truth,
        or too few poses.
    source : str
        What told the terrain: "camera", "labels", "modes", "none", or a source of one's own.

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
    scores: dict[str, Score]
    learned: ParameterSet
    uncertainty: OdometerUncertainty
    second: SecondReplay | None = None
    source: str = "none"

    @property
    def judged(self) -> dict[str, Judged]:
        """Every trajectory that can be judged fairly, with the poses that judge it."""
        return judged_trajectories(
            self.run, self.replay, self.reference_name, self.reference, self.second
        )

    @property
    def off_at_the_end_m(self) -> dict[str, float]:
        """Distance of each trajectory, as delivered, from the reference at its last stamp.

        Where the reference is pose.csv the estimate has seen it, up to that pose: its distance is
        no measure of its error, but a large one says that the filter lost the poses.
        """
        delivered = self.judged
        if self.reference is not None:
            seen = seen_by(self.run, self.reference_name, self.replay.trajectory())
            delivered["estimate"] = Judged(seen, self.reference, self.reference_name)
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
