"""The main job: an image and odometry run goes in, terrain-aware odometry comes out."""

from dataclasses import dataclass
from pathlib import Path

from odometry.effects.catalogue import added_effects
from odometry.effects.corrected import Added
from odometry.effects.measured import robot_run, shared_measurement
from odometry.errors import ParameterError, RunFolderError
from odometry.estimation.corrections import corrections_of
from odometry.estimation.icr_ekf import IcrEkf
from odometry.evaluation.score import Score, reference_of, score
from odometry.learned import learned_parameters
from odometry.parameters import ParameterSet, read_parameters
from odometry.pipeline import ConstantTerrain, replay
from odometry.replay import Replay
from odometry.run import UNKNOWN, UNNAMED_TERRAIN, Run
from odometry.trajectory import Trajectory
from terrain.camera import Camera
from terrain.classification.classifier import TerrainClassifier
from terrain.config import Config
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
        By trajectory: odometer, differential_drive, and estimate where there is a truth.
    learned : ParameterSet
        `parameters` with what the filter learned in place of what it visited.
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


def run_odometry(
    run: Run | str | Path,
    *,
    model: TerrainClassifier | str | Path | None = None,
    parameters: ParameterSet | str | Path | None = None,
    vision: bool = True,
    terrain: str | None = None,
    config: Config | None = None,
    show_progress: bool = False,
) -> RunResult:
    """Replay a run with the ICR filter, its terrain told by the camera.

    Parameters
    ----------
    run : Run or path
    model : TerrainClassifier or path, optional
        Without one there is no vision.
    parameters : ParameterSet or path, optional
        A terrain without a table starts from a broad prior centred on the track width. Effects
        of a table act on that terrain; those on the measurement must be the same everywhere.
    vision : bool
        False keeps one terrain in force throughout.
    terrain : str, optional
        In force until the first switch; by default the run's own where `parameters` has it, else
        the first of `parameters`, else the run's own.
    config : Config, optional
    show_progress : bool
        Whether to draw a bar on standard error.

    Raises
    ------
    OdometryError
        If an input is not as its format says, or a model is given for a run without images.
    """
    run = run if isinstance(run, Run) else Run.read(run)
    config = config or Config()
    if not isinstance(parameters, ParameterSet):
        parameters = read_parameters(parameters) if parameters else ParameterSet()
    initial = _initial_terrain(run, parameters, terrain)
    corrections = corrections_of(run, parameters)
    run = robot_run(run, _sensor_effects(parameters))
    estimator = IcrEkf(run.robot.track_width, parameters, config.filter, corrections)
    watcher = _watcher(run, model, initial, config) if vision and model is not None else None
    result = replay(
        run, estimator, watcher or ConstantTerrain(initial), show_progress=show_progress
    )
    reference_name, reference = reference_of(run) or ("", None)
    return RunResult(
        run,
        config,
        parameters,
        initial,
        watcher,
        result,
        reference_name,
        reference,
        _scores(run, result, reference_name, reference, config),
        learned_parameters(parameters, result, run.name),
    )


def _sensor_effects(parameters: ParameterSet) -> tuple[Added, ...]:
    return shared_measurement(
        [
            added_effects(table.effects, f"[terrain.{name}]")
            for name, table in parameters.terrains.items()
        ]
    )


def _initial_terrain(run: Run, parameters: ParameterSet, terrain: str | None) -> str:
    if terrain == UNKNOWN:
        raise ParameterError(f"the terrain name {UNKNOWN!r} is reserved; name another, or none")
    of_run = None if run.terrain == UNKNOWN else run.terrain
    known = of_run if of_run in parameters.terrains else next(iter(parameters.terrains), None)
    return terrain or known or of_run or UNNAMED_TERRAIN


def _watcher(
    run: Run, model: TerrainClassifier | str | Path, initial: str, config: Config
) -> TerrainWatcher:
    if run.images is None or "camera" not in run.settings:
        raise RunFolderError(
            f"{run.folder}: a model was given, but the run has no "
            f"{'images.csv' if run.images is None else '[camera] in run.toml'}; "
            "a model (--model) reads images: leave it out, or turn vision off (--no-vision)"
        )
    camera = Camera.from_table(run.settings["camera"], str(run.folder / "run.toml"))
    classifier = (
        model if isinstance(model, TerrainClassifier) else TerrainClassifier.load(Path(model))
    )
    return TerrainWatcher(
        run, camera, classifier, initial, region=config.region, switch=config.switch
    )


def _scores(
    run: Run, result: Replay, reference_name: str, reference: Trajectory | None, config: Config
) -> dict[str, Score]:
    """The filter has seen pose.csv: against it only the open-loop trajectories are judged."""
    if reference is None:
        return {}
    trajectories = {
        "odometer": result.odometer(),
        "differential_drive": result.differential_drive(run.robot.track_width),
    }
    if reference_name == "truth":
        trajectories["estimate"] = result.trajectory()
    return {
        name: score(run, trajectory, reference, config.evaluation)
        for name, trajectory in trajectories.items()
    }
