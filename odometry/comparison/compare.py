"""Identify models, judge them on what they have not seen, and tell them apart."""

from collections.abc import Sequence

from odometry.comparison.candidates import Candidate, IdentifiedModel, candidates_named
from odometry.comparison.comparison import Comparison
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.differences import Difference, differences
from odometry.comparison.errors import ComparisonError
from odometry.comparison.judgement import Judgement
from odometry.comparison.judging import judge_all
from odometry.comparison.prepare import Prepared, prepare
from odometry.comparison.run_fitness import run_fitness
from odometry.comparison.split import of_all, splits
from odometry.comparison.summary import Place
from odometry.errors import OdometryError
from odometry.grounds import with_named_ground
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.run import Run
from odometry.windows.record import record_of

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
    """Compare kinematic models on recorded runs, by robot and ground.

    A model of the catalogue is judged on windows that it was not identified on: by other runs of
    the same robot and ground, by the other half where there is one run, or by `train`.

    Parameters
    ----------
    runs : sequence of Run
        To be judged on.
    models : sequence of str or Candidate
        Names of the catalogue, files of parameter sets, or candidates of one's own.
    train : sequence of Run
        To identify on instead of `runs`.
    terrain : str, optional
        The ground of runs that name none.
    config : ComparisonConfig, optional
    show_progress : bool
        Whether to draw a bar on standard error.

    Raises
    ------
    ComparisonError
        If no run can be judged, one is there twice, or a model is not known.
    ParameterError
        If a file is no parameter set.
    """
    config = config or ComparisonConfig()
    candidates = candidates_named(models)
    judged, left_out = _with_poses([with_named_ground(run, terrain) for run in runs], config)
    known, not_seen = _with_poses([with_named_ground(run, terrain) for run in train], config)
    if not judged or (train and not known):
        raise ComparisonError(
            "\n  ".join(["no run to compare on", *(left_out | not_seen).values()])
        )
    planned = splits(judged, known)
    prepared = prepare(planned, candidates, config, show_progress=show_progress)
    judgements, shortfalls = judge_all(prepared, config)
    names = tuple(candidate.label for candidate in candidates)
    identified = [each for each in candidates if isinstance(each, IdentifiedModel)]
    on_all = (
        prepared
        if known
        else prepare(of_all(planned), identified, config, show_progress=show_progress)
    )
    return Comparison(
        models=names,
        prepared=prepared,
        judgements=tuple(judgements),
        shortfalls=tuple(shortfalls),
        left_out=left_out | not_seen,
        differences=tuple(_differences(prepared, judgements, names, config)),
        fitness=tuple(run_fitness(prepared, names)),
        parameters=_parameter_sets(on_all, [each.label for each in identified]),
        config=config,
    )


def _with_poses(runs: Sequence[Run], config: ComparisonConfig) -> tuple[list[Run], dict[str, str]]:
    """Runs that have measured poses, and by folder why others cannot be judged."""
    usable, reasons = [], {}
    for run in runs:
        try:
            record_of(run, config.training)
            usable.append(run)
        except OdometryError as error:
            reasons[str(run.folder)] = str(error)
    return usable, reasons


def _differences(
    prepared: Sequence[Prepared],
    judgements: Sequence[Judgement],
    models: Sequence[str],
    config: ComparisonConfig,
) -> list[Difference]:
    found = []
    for robot, ground in dict.fromkeys((p.split.robot, p.split.ground) for p in prepared):
        for horizon_m in config.horizons_m:
            place = Place(robot, ground, horizon_m)
            here = [judgement for judgement in judgements if place.holds(judgement)]
            found += differences(place, here, models, config)
    return found


def _parameter_sets(
    prepared: Sequence[Prepared], models: Sequence[str]
) -> dict[tuple[str, str], ParameterSet]:
    """One set a robot and model, one table a ground."""
    tables: dict[tuple[str, str], dict[str, TerrainParameters]] = {}
    for each in prepared:
        for model in (model for model in models if model in each.predictors):
            of_model = tables.setdefault((each.split.robot, model), {})
            of_model[each.split.ground] = each.predictors[model].to_parameters()
    return {
        (robot, model): ParameterSet(of_model, {"name": robot})
        for (robot, model), of_model in tables.items()
    }
