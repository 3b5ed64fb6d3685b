"""Compare models on windows that they were not identified on."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from odometry.comparison.candidates import Candidate, GivenParameters, IdentifiedModel
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import Evaluation, evaluate_all, run_fitness
from odometry.comparison.fitting import SplitModels, fit_models, identified_sets
from odometry.comparison.parts_apart import parts_apart
from odometry.comparison.result import Comparison
from odometry.comparison.split import of_all, splits
from odometry.comparison.statistics import Difference, differences
from odometry.comparison.summary import Place
from odometry.comparison.training_horizons import training_horizon_errors
from odometry.errors import ComparisonError, OdometryError
from odometry.models.catalogue import MODELS
from odometry.parameters import read_parameters
from odometry.positions.heading import FoundHeading, found_heading, needs_heading
from odometry.positions.timing import timings_of
from odometry.recording.run import Run
from odometry.recording.run_terrains import with_named_terrain
from odometry.windows.recorded.measured_poses import YAW_FOUND
from odometry.windows.recorded.record import record_of

DEFAULT_MODELS = ("differential_drive", "icr_symmetric", "icr")


def compare(
    runs: Sequence[Run],
    models: Sequence[str | Candidate] = DEFAULT_MODELS,
    *,
    train: Sequence[Run] = (),
    terrain: str | None = None,
    config: ComparisonConfig | None = None,
    show_progress: bool = False,
) -> Comparison:
    """Compare kinematic models on recorded runs, by robot and terrain.

    A model of the catalogue is evaluated on windows that it was not identified on: it is
    identified on the other runs of the same robot and terrain, on the other half where there is
    one run, or on `train`.

    Parameters
    ----------
    runs : sequence of Run
        To evaluate on.
    models : sequence of str or Candidate
        Names of the catalogue, files of parameter sets, or candidates of one's own.
    train : sequence of Run
        To identify on instead of `runs`.
    terrain : str, optional
        The terrain of runs that name none.
    config : ComparisonConfig, optional
    show_progress : bool
        Whether to draw a bar on standard error.

    Raises
    ------
    ComparisonError
        If no run can be evaluated, one is there twice, or a model is not known.
    ParameterError
        If a file is no parameter set.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> compared = odometry.compare([run], ["differential_drive", "icr"], terrain="yard")
    >>> compared.models
    ('differential_drive', 'icr')
    """
    config = (config or ComparisonConfig()).with_stated_horizons()
    candidates = candidates_named(models)
    usable, left_out, found = _with_poses(
        [with_named_terrain(run, terrain) for run in runs], config
    )
    known, not_used, _ = _with_poses([with_named_terrain(run, terrain) for run in train], config)
    if not usable or (train and not known):
        raise ComparisonError(
            "\n  ".join(["no run to compare on", *(left_out | not_used).values()])
        )
    config, notes = _horizons_of_positions(found, config)
    planned = splits(usable, known)
    identified = [each for each in candidates if isinstance(each, IdentifiedModel)]
    on_all = fit_models(
        of_all(planned), () if known else identified, config, show_progress=show_progress
    )
    split_models = fit_models(
        planned, candidates, config, fitted_to_all=on_all, show_progress=show_progress
    )
    evaluations, not_evaluated = evaluate_all(split_models, config)
    names = tuple(each.label for each in candidates)
    by_training_horizon = training_horizon_errors(
        planned,
        identified,
        config,
        split_models if known else on_all,
        (evaluations, not_evaluated),
        show_progress=show_progress,
    )
    return Comparison(
        models=names,
        split_models=split_models,
        evaluations=tuple(evaluations),
        not_evaluated=tuple(not_evaluated),
        left_out=left_out | not_used,
        differences=tuple(_differences(split_models, evaluations, names, config)),
        fitness=tuple(run_fitness(split_models, names)),
        parameters=identified_sets(
            split_models if known else on_all, [each.label for each in identified]
        ),
        config=config,
        by_training_horizon=by_training_horizon,
        notes=notes,
        not_identified=_not_identified([*split_models, *on_all]),
        apart=parts_apart(identified, split_models, evaluations, config),
    )


def candidates_named(names: Sequence[str | Candidate]) -> tuple[Candidate, ...]:
    """Candidates from names of the catalogue and files of parameter sets; others pass through.

    Raises
    ------
    ComparisonError
        If one is neither, or there twice, or there is none.
    ParameterError
        If a file is no parameter set.
    """
    found: list[Candidate] = []
    for name in names:
        if isinstance(name, Candidate):
            found.append(name)
        elif name in MODELS:
            found.append(IdentifiedModel(MODELS[name]))
        elif Path(name).suffix == ".toml":
            found.append(GivenParameters(Path(name).stem, read_parameters(name)))
        else:
            raise ComparisonError(
                f"there is no model {name!r}; known: {', '.join(MODELS)}, or a parameter set "
                "(.toml)"
            )
    labels = [candidate.label for candidate in found]
    twice = [label for label in labels if labels.count(label) > 1]
    if twice or not labels:
        raise ComparisonError(
            f"models {', '.join(labels) or '(none)'}: expected one or more, each name once"
        )
    return tuple(found)


def _with_poses(
    runs: Sequence[Run], config: ComparisonConfig
) -> tuple[list[Run], dict[str, str], list[FoundHeading]]:
    """Runs that have poses, by folder why others cannot be evaluated, and headings found."""
    usable, reasons = [], {}
    found: list[FoundHeading] = []
    timings = iter(timings_of([run for run in runs if needs_heading(run)]))
    for run in runs:
        try:
            heading = found_heading(run, next(timings)) if needs_heading(run) else None
            with_yaw = run if heading is None else heading.run
            record_of(with_yaw, config.training)
            usable.append(with_yaw)
            found += [heading] if heading else []
        except OdometryError as error:
            reasons[str(run.folder)] = str(error)
    return usable, reasons, found


def _horizons_of_positions(
    found: Sequence[FoundHeading], config: ComparisonConfig
) -> tuple[ComparisonConfig, tuple[str, ...]]:
    """Horizons over which positions without yaw show errors, and what a reader should know."""
    notes = [heading.words for heading in found]
    if found:
        notes.append(
            "where such a yaw is off it is so for every window: intervals of differences in "
            "translation are wider by that"
        )
    least_m = max((heading.least_horizon_m for heading in found), default=0.0)
    horizons_m = tuple(dict.fromkeys(max(each, least_m) for each in config.horizons_m))
    if horizons_m != config.horizons_m:
        notes.append(
            f"errors are evaluated over {least_m:.3g} m and more: over less, the noise of the "
            "positions is most of them"
        )
    return replace(config, horizons_m=horizons_m), tuple(notes)


def _differences(
    split_models: Sequence[SplitModels],
    evaluations: Sequence[Evaluation],
    models: Sequence[str],
    config: ComparisonConfig,
) -> list[Difference]:
    found = []
    for robot, terrain in dict.fromkeys((p.split.robot, p.split.terrain) for p in split_models):
        for horizon_m in config.horizons_m:
            place = Place(robot, terrain, horizon_m)
            here = [evaluation for evaluation in evaluations if place.holds(evaluation)]
            sigma_rad = _found_yaw_sigma_rad(split_models, place)
            found += differences(place, here, models, config, sigma_rad)
    return found


def _found_yaw_sigma_rad(split_models: Sequence[SplitModels], place: Place) -> float:
    """Median of the run at a place whose yaw was found worst; 0 where all yaws were measured."""
    held_out = [
        part.run.pose
        for each in split_models
        if (each.split.robot, each.split.terrain) == (place.robot, place.terrain)
        for part in each.split.held_out
    ]
    sigmas = [
        float(np.nanmedian(pose[YAW_FOUND]))
        for pose in held_out
        if pose is not None and YAW_FOUND in pose
    ]
    return max(sigmas, default=0.0)


def _not_identified(
    split_models: Sequence[SplitModels],
) -> dict[tuple[str, str, str], tuple[str, ...]]:
    """By robot, terrain and model, why `identify` refuses parameters of some identification."""
    return {
        (each.split.robot, each.split.terrain, model): predictor.not_identified
        for each in split_models
        for model, predictor in each.predictors.items()
        if predictor.not_identified
    }
