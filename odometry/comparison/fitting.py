"""The models of every split, identified on its training parts."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tqdm import tqdm

from odometry.comparison.candidates import Candidate, Predictor
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.split import Split
from odometry.errors import OdometryError
from odometry.parameters import ParameterSet, TerrainParameters


@dataclass(frozen=True)
class SplitModels:
    """Models that may be evaluated on the held-out parts of one split.

    Attributes
    ----------
    split : Split
    predictors : Mapping of model to Predictor
    reasons : Mapping of model to str
        Why there is no predictor of the others.
    """

    split: Split
    predictors: Mapping[str, Predictor]
    reasons: Mapping[str, str]


def fit_models(
    planned: Sequence[Split],
    candidates: Sequence[Candidate],
    config: ComparisonConfig,
    *,
    fitted_to_all: Sequence["SplitModels"] = (),
    show_progress: bool,
) -> tuple[SplitModels, ...]:
    """Identify every candidate for every split; one that fails becomes a reason.

    Parameters
    ----------
    planned : sequence of Split
    candidates : sequence of Candidate
    config : ComparisonConfig
    fitted_to_all : sequence of SplitModels
        Models of the same robots and terrains, identified on all runs: their values are where
        the search for each split starts, and nothing else of them is used.
    show_progress : bool
    """
    near = {
        (each.split.robot, each.split.terrain, model): predictor.values
        for each in fitted_to_all
        for model, predictor in each.predictors.items()
    }
    found = []
    steps = len(planned) * len(candidates)
    with tqdm(
        total=steps, desc="models", unit="fit", disable=None if show_progress else True
    ) as bar:
        for split in planned:
            predictors, reasons = {}, {}
            for candidate in candidates:
                bar.set_postfix_str(f"{candidate.label} on {split.terrain}", refresh=False)
                try:
                    predictors[candidate.label] = candidate.on(
                        split, config, near.get((split.robot, split.terrain, candidate.label))
                    )
                except OdometryError as error:
                    reasons[candidate.label] = str(error)
                bar.update()
            found.append(SplitModels(split, predictors, reasons))
    return tuple(found)


def identified_sets(
    split_models: Sequence[SplitModels], models: Sequence[str]
) -> dict[tuple[str, str], ParameterSet]:
    """One set a robot and model, one table a terrain; none of what `identify` would refuse."""
    tables: dict[tuple[str, str], dict[str, TerrainParameters]] = {}
    widths_m: dict[str, float] = {}
    for each in split_models:
        widths_m[each.split.robot] = each.split.held_out[0].run.robot.track_width
        for model in models:
            predictor = each.predictors.get(model)
            if predictor is not None and not predictor.not_identified:
                of_model = tables.setdefault((each.split.robot, model), {})
                of_model[each.split.terrain] = predictor.to_parameters()
    return {
        (robot, model): ParameterSet(of_model, {"name": robot, "track_width": widths_m[robot]})
        for (robot, model), of_model in tables.items()
    }
