"""The main job: from a run with images and odometry to terrain-aware odometry."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from odometry.effects.catalogue import added_effects
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.measured import shared_measurement
from odometry.estimation.corrections import corrections_of
from odometry.estimation.icr_ekf import IcrEkf, MeansKept
from odometry.evaluation.odometer_uncertainty import odometer_uncertainty
from odometry.evaluation.score import reference_of, withhold
from odometry.feel.labels.follow import Felt
from odometry.feel.model import FeelModel
from odometry.modes.models.mode_set import ModeSet
from odometry.parameters import ParameterSet, read_parameters
from odometry.preparation.prepared import prepared_run
from odometry.recording.run import UNKNOWN, Run
from odometry.recording.run_span import Span
from odometry.replays.estimates import Replay
from odometry.replays.learned_parameters import learned_parameters
from odometry.replays.pipeline import Estimator, TerrainSource, replay
from odometry.replays.terrain_sources import NamedTerrain, ReplayedFooting
from terrain.believed import as_checked
from terrain.checks.recording import checked_run
from terrain.config import Config
from terrain.result.contradictions import contradictions, labels_beneath
from terrain.result.contradictions_so_far import Contradiction
from terrain.result.evaluated import SecondReplay, is_used_by_filter
from terrain.result.new_terrain import learned_apart, new_spans
from terrain.result.run_result import RunResult
from terrain.run_presets import run_preset, with_preset
from terrain.sources.images_outside_replay import add_images_outside
from terrain.sources.sources import (
    BOTH,
    OWN_SOURCE,
    felt_of,
    initial_terrain,
    moved_terrain,
    source_name,
    terrain_source,
)
from terrain.sources.watcher import TerrainWatcher

if TYPE_CHECKING:
    from odometry.checks.findings.finding import CheckReport
    from terrain.classification.answer import Classifier
    from terrain.classification.classifier import TerrainClassifier

__all__ = ["RunResult", "run_odometry"]


def run_odometry(
    run: Run | str | Path,
    *,
    model: "TerrainClassifier | str | Path | None" = None,
    parameters: ParameterSet | str | Path | None = None,
    vision: bool = True,
    terrain: str | None = None,
    config: Config | None = None,
    source: str | TerrainSource | None = None,
    modes: ModeSet | str | Path | None = None,
    feel: FeelModel | str | Path | None = None,
    preset: str | None = None,
    show_progress: bool = False,
) -> RunResult:
    """Replay a run with the ICR filter; the camera or another source gives the terrain.

    Parameters
    ----------
    run : Run or path
        A folder is read and checked, as the command `run` does: what the check warns of is a
        `UserWarning`, images that show other terrain than that ahead are left out, and so are
        parts of images that show the robot. A `Run` is taken as it is.
    model : TerrainClassifier or path, optional
        Without a model images are not used.
    parameters : ParameterSet or path, optional
        A terrain without a table starts from a broad prior round the mean of the others, or
        round the track width where there are none. Effects of a table act on that terrain;
        those on the measurement must be the same everywhere.
    vision : bool
        False reads no image: without another `source` one terrain is in force for the whole run.
    terrain : str, optional
        In force until the first switch; by default the run's own where `parameters` has it, else
        `unknown`; without any source of terrain the only one of `parameters`, else the run's own.
    config : Config, optional
    source : {"camera", "labels", "modes", "feel", "none"} or TerrainSource, optional
        The source of the terrain: the images, classified by `model`; the run's own column
        `terrain`; the motion, by `modes`; inertial and current sensors, by `feel`; none. By
        default the camera where there is a model, else feel where `feel` is given, else none.
    modes : ModeSet or path, optional
        From `identify-modes`, for the source "modes".
    feel : FeelModel or path, optional
        From `identify-feel`, for the source "feel", and as a second source beside the camera.
    preset : {"chen2023"}, optional
        All settings of a published system, see `terrain.run_presets`; `config` may set the others.
    show_progress : bool
        Whether to draw a bar on standard error.

    Raises
    ------
    OdometryError
        If an input does not follow its format, a folder cannot be used as it is, a model is
        given for a run without images, or a setting contradicts the preset.

    Examples
    --------
    >>> import odometry
    >>> import terrain
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> result = terrain.run_odometry(run, vision=False)
    >>> off_m = result.off_at_the_end_m
    >>> f"{off_m['differential_drive']:.0f} m, {off_m['odometer']:.0f} m"
    '11 m, 0 m'
    """
    name, has_feel = OWN_SOURCE, feel is not None
    if isinstance(source, str | None):
        name = source_name(source, vision=vision, has_model=model is not None, has_feel=has_feel)
    report: CheckReport | None = None
    if not isinstance(run, Run):
        of_images = name == "camera" and preset is None  # a published system is what it is
        run, report = checked_run(Path(run), Span(), images=of_images)
        run, name = as_checked(run, report, name, has_feel=has_feel)
    config = config or (run_preset(preset).config if preset else Config())
    if not isinstance(parameters, ParameterSet):
        parameters = read_parameters(parameters) if parameters else ParameterSet()
    initial = initial_terrain(terrain, parameters, run.terrain)
    corrections = corrections_of(run, parameters)
    run, of_filter, noticed = prepared_run(run, config.filter, _sensor_effects(parameters))
    config = replace(config, filter=of_filter)
    lever_m = run.sensors.pose_m[:2] if run.sensors.pose_m else (0.0, 0.0)
    trained = _trained(model) if name == "camera" else None
    reader: Classifier | None = trained
    if preset is not None:
        config, reader = with_preset(
            preset, run, config, source=name, model=trained, parameters=parameters
        )
    ekf = IcrEkf(run.robot.track_width, parameters, config.filter, corrections, lever_m)
    estimator = ekf if preset is None else MeansKept(ekf)
    if isinstance(source, str | None):
        source = terrain_source(
            run,
            name,
            config,
            initial=initial,
            terrain=terrain,
            model=reader,
            modes=modes,
            feel=feel,
            show_progress=show_progress,
        )
    watcher = source if isinstance(source, TerrainWatcher) else None
    causal = config.filter.causal
    result = replay(
        run, estimator, source, noticed=noticed, causal=causal, show_progress=show_progress
    )
    if watcher is not None and run.images is not None:
        add_images_outside(watcher, run, run.images, result)
    differing: tuple[Contradiction, ...] = ()
    if feel is not None and name in ("camera", "feel"):
        motion = None if modes is None else moved_terrain(run, modes, UNKNOWN)
        felt = felt_of(run, feel, causal=causal)
        differing = _contradictions(felt, motion, watcher, result, causal=causal)
    reference_name, reference = reference_of(run) or ("", None)
    used, second = is_used_by_filter(reference_name), None
    if used:
        second = _second_replay(run, estimator, result, causal, show_progress=show_progress)
    learned = learned_parameters(parameters, result, run.name, run.robot)
    unknown_s = new_spans(differing)
    learned = learned_apart(run, estimator, result, unknown_s, learned, causal=causal)
    return RunResult(
        run,
        config,
        parameters,
        source.initial,
        watcher,
        result,
        reference_name,
        reference,
        learned,
        odometer_uncertainty(run, result, None if used else reference),
        second,
        BOTH if name == "camera" and has_feel else name,
        differing,
        report,
    )


def _contradictions(
    felt: Felt,
    motion: NamedTerrain | None,
    watcher: TerrainWatcher | None,
    result: Replay,
    *,
    causal: bool,
) -> tuple[Contradiction, ...]:
    """Where camera, feel and motion differ for long."""
    beneath = None
    if watcher is not None:
        radius_m = watcher.footprint.radius_m
        beneath = labels_beneath(
            felt, watcher.image_labels, result.odometer(), radius_m, causal=causal
        )
    return contradictions(felt, beneath, motion)


def _second_replay(
    run: Run, estimator: Estimator, first: Replay, causal: bool, *, show_progress: bool
) -> SecondReplay | None:
    """Replay without the poses of the evaluation; no image is classified twice."""
    withheld = withhold(run, float(first.stamps_s[0]), float(first.stamps_s[-1]))
    if withheld is None:
        return None
    source = ReplayedFooting(first.estimates)
    again = replay(withheld.run, estimator, source, causal=causal, show_progress=show_progress)
    return SecondReplay(withheld, again)


def _sensor_effects(parameters: ParameterSet) -> tuple[Added, ...]:
    return shared_measurement(
        [
            added_effects(table.effects, f"[terrain.{name}]")
            for name, table in parameters.terrains.items()
        ]
    )


def _trained(model: "TerrainClassifier | str | Path | None") -> "TerrainClassifier | None":
    if not isinstance(model, str | Path):
        return model
    from terrain.classification.classifier import TerrainClassifier  # noqa: PLC0415 - slow to load

    return TerrainClassifier.load(Path(model))
