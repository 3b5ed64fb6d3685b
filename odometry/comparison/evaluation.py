"""Errors of every model on the windows of each split that it was not identified on."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from odometry.arrays import FloatArray
from odometry.comparison.candidates import Predictor
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.fitting import SplitModels
from odometry.comparison.split import Part, windows_of_parts
from odometry.effects.interface.corrected import Added, delay_s, seen_poses
from odometry.effects.interface.recorded import Reported
from odometry.effects.measurement.measured import robot_run, shared_measurement
from odometry.effects.tables import effects_of
from odometry.errors import OdometryError
from odometry.evaluation.open_loop import Fitness, fitness, measured_poses, open_loop
from odometry.geometry import se2
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.run_inputs import inputs_of
from odometry.windows.travel.motion import level_path, window_motion
from odometry.windows.travel.windows import Windows
from odometry.windows.window_errors import WindowErrors, errors_of_motion


@dataclass(frozen=True)
class Evaluation:
    """Models on the windows of one part of a run, over one horizon.

    Attributes
    ----------
    robot, terrain, run : str
    training_runs : str
        What the identified models were identified on.
    horizon_m : float
    windows : Windows
        K distinct windows.
    errors : Mapping of model to WindowErrors
        Without the models that failed here.
    """

    robot: str
    terrain: str
    run: str
    training_runs: str
    horizon_m: float
    windows: Windows
    errors: Mapping[str, WindowErrors]

    @property
    def mean_speeds_m_s(self) -> FloatArray:
        """v_left, v_right (K, 2) averaged over the time of each window."""
        windows = self.windows
        duration_s = _sums(windows, windows.steps_s)
        travelled_m = windows.inputs.tread_speeds_m_s * windows.steps_s[:, None]
        return np.stack([_sums(windows, side) / duration_s for side in travelled_m.T], axis=-1)


@dataclass(frozen=True)
class NotEvaluated:
    """What could not be evaluated, and why; `model` is "" where it concerns all of them."""

    robot: str
    terrain: str
    run: str
    model: str
    reason: str


def evaluate_all(
    split_models: Sequence[SplitModels], config: ComparisonConfig
) -> tuple[list[Evaluation], list[NotEvaluated]]:
    """Errors over all horizons on the windows of every split, and what has none."""
    evaluations: list[Evaluation] = []
    not_evaluated: list[NotEvaluated] = []
    for each in split_models:
        for part in each.split.held_out:
            found, missing = _evaluate_part(part, each, config)
            evaluations += found
            not_evaluated += missing
    return evaluations, not_evaluated


def _evaluate_part(
    part: Part, models: SplitModels, config: ComparisonConfig
) -> tuple[list[Evaluation], list[NotEvaluated]]:
    split, found = models.split, []
    reasons = dict(models.reasons)
    for horizon_m in config.evaluated_m:
        try:
            windows = evaluation_windows(part, horizon_m, config.training)
        except OdometryError as error:
            if horizon_m in config.horizons_m:
                reasons[""] = str(error)
            continue
        errors: dict[str, WindowErrors] = {}
        for model, predictor in models.predictors.items():
            try:
                motion = predicted_motion(predictor, part.run, windows)
                errors[model] = errors_of_motion(motion, windows)
            except OdometryError as error:
                reasons[model] = str(error)
        found.append(
            Evaluation(
                split.robot,
                split.terrain,
                part.name,
                split.training_names,
                horizon_m,
                windows,
                errors,
            )
        )
    not_evaluated = [
        NotEvaluated(split.robot, split.terrain, part.name, model, reason)
        for model, reason in reasons.items()
    ]
    return found, not_evaluated


def evaluation_windows(part: Part, horizon_m: float, training: WindowConfig) -> Windows:
    """Distinct windows of a horizon; they may straddle changes of `window`, but no gaps.

    A recording whose poses were chained every 2 s has hardly any window inside one chain. The
    errors at the joints are the same for every model, so that differences of models stand.

    Parameters
    ----------
    part : Part
    horizon_m : float
        Wheel travel.
    training : WindowConfig
        Says what a gap is.

    Raises
    ------
    WindowError
        If there is no such window.
    """
    config = replace(training, horizon_m=horizon_m, horizon_s=0.0, stride=1.0, shortest=1.0)
    whole = replace(part, run=_as_one_chain(part.run))
    return windows_of_parts([whole], config)


def _as_one_chain(run: Run) -> Run:
    if run.pose is None or "window" not in run.pose:
        return run
    columns = {name: column for name, column in run.pose.columns.items() if name != "window"}
    return replace(run, pose=replace(run.pose, columns=columns))


def _sums(windows: Windows, values: FloatArray) -> FloatArray:
    """Sum of values (N,) over the samples in force in each window (K,)."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    return np.asarray(sums[windows.last] - sums[windows.first])


def predicted_motion(predictor: Predictor, run: Run, windows: Windows) -> FloatArray:
    """Motion (K, 3) of the reference sensor over each window of one run; yaw is not wrapped.

    Effects may depend on what was before a window (the moment of a loss, the last command), so
    that a model with effects is computed on the whole run.
    """
    effects = effects_of(predictor.model)
    if not effects:
        return window_motion(predictor.model, predictor.packed, windows)
    pose_s, poses = measured_poses(run)
    reported = Reported(pose_s - run.odometry.stamps_s[0], poses)
    seen = seen_poses(effects, _robot_poses(predictor, effects, run, pose_s), reported)
    first = np.searchsorted(pose_s, windows.start_s)
    last = first + windows.last_pose - windows.first_pose
    motion = se2.between(seen[first], seen[last])
    motion[:, 2] = seen[last, 2] - seen[first, 2]
    return motion


def _robot_poses(
    predictor: Predictor, effects: tuple[Added, ...], run: Run, pose_s: FloatArray
) -> FloatArray:
    """Poses (M, 3) of the robot when the poses stamped (M,) were measured, from the origin.

    Before the first and after the last stamp of odometry the robot is stationary.
    """
    odometry_s = run.odometry.stamps_s
    late_s = delay_s(effects, pose_s - odometry_s[0])
    measured_s = np.clip(pose_s - late_s, odometry_s[0], odometry_s[-1])
    stamps_s = np.union1d(odometry_s, measured_s)
    rows = np.searchsorted(odometry_s, stamps_s, side="right") - 1
    inputs = replace(inputs_of(run).rows(rows), time_s=stamps_s - odometry_s[0])
    twists = predictor.model.twist(predictor.packed, inputs)
    path = level_path(twists, np.append(np.diff(stamps_s), 0.0), inputs)
    return np.asarray(path[np.searchsorted(stamps_s, measured_s)])


@dataclass(frozen=True)
class RunFitness:
    """Dead reckoning of a whole run under one model, each row held out."""

    robot: str
    run: str
    model: str
    fitness: Fitness


def run_fitness(split_models: Sequence[SplitModels], models: Sequence[str]) -> list[RunFitness]:
    """Dead-reckon runs from their first poses under each model (Martinez 2024 eq. 13).

    A run over several terrains, or of which each half is held out in turn, changes parameters on
    its way. A model that failed on a part of a run has no fitness of it. Where a model has effects
    on the measurement, it is evaluated with the poses of the robot.
    """
    parts: dict[str, list[tuple[Part, SplitModels]]] = {}
    for each in split_models:
        for part in each.split.held_out:
            parts.setdefault(part.name, []).append((part, each))
    found = []
    for of_run in parts.values():
        for model in models:
            try:
                found.append(_fitness(of_run, model))
            except (OdometryError, KeyError):
                continue  # the evaluated windows say why
    return found


def _fitness(parts: Sequence[tuple[Part, SplitModels]], model: str) -> RunFitness:
    run, name = parts[0][0].run, parts[0][0].name
    twists = _twists(parts, model)
    effects = [effects_of(fitted.predictors[model].model) for _, fitted in parts]
    robot = robot_run(run, shared_measurement(effects))
    result = fitness(open_loop(robot, twists), *measured_poses(robot))
    return RunFitness(parts[0][1].split.robot, name, model, result)


def _twists(parts: Sequence[tuple[Part, SplitModels]], model: str) -> FloatArray:
    """Twists (N, 3) at all rows of a run, from the parts that it falls into."""
    run = parts[0][0].run
    inputs, twists = inputs_of(run), np.empty((len(run.odometry), 3))
    for part, fitted in parts:
        rows, predictor = np.flatnonzero(part.rows), fitted.predictors[model]
        twists[rows] = predictor.model.twist(predictor.packed, inputs.rows(rows))
    return twists
