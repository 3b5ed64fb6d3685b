"""The result of a comparison."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from odometry.comparison.config import ComparisonConfig
from odometry.comparison.evaluation import Evaluation, NotEvaluated, RunFitness
from odometry.comparison.fitting import SplitModels
from odometry.comparison.sentences import contradictions, sentences
from odometry.comparison.statistics import Difference
from odometry.comparison.summary import Place, Summary, summarise
from odometry.comparison.training_horizons import HorizonErrors
from odometry.parameters import ParameterSet
from odometry.windows.recorded.record import summed


@dataclass(frozen=True)
class Comparison:
    """Models and their errors on windows that they were not identified on.

    Attributes
    ----------
    models : tuple of str
    split_models : tuple of SplitModels
        The models of each split.
    evaluations : tuple of Evaluation
        Over all horizons.
    not_evaluated : tuple of NotEvaluated
    left_out : Mapping of folder to str
        Runs that cannot be evaluated, and why.
    differences : tuple of Difference
        Over the given horizons.
    fitness : tuple of RunFitness
    parameters : Mapping of (robot, model) to ParameterSet
        Of the identified models, from all runs that are not held out; without those of
        `not_identified`.
    config : ComparisonConfig
    by_training_horizon : tuple of HorizonErrors
        Empty where no training horizons were given.
    notes : tuple of str
        What a reader should know of the runs.
    not_identified : Mapping of (robot, terrain, model) to tuple of str
        Why `identify` refuses the parameters of these models, which are evaluated all the same.
    apart : Mapping of (robot, terrain) to str
        Which runs do not fit one model.
    """

    models: tuple[str, ...]
    split_models: tuple[SplitModels, ...]
    evaluations: tuple[Evaluation, ...]
    not_evaluated: tuple[NotEvaluated, ...]
    left_out: Mapping[str, str]
    differences: tuple[Difference, ...]
    fitness: tuple[RunFitness, ...]
    parameters: Mapping[tuple[str, str], ParameterSet]
    config: ComparisonConfig
    by_training_horizon: tuple[HorizonErrors, ...] = ()
    notes: tuple[str, ...] = ()
    not_identified: Mapping[tuple[str, str, str], tuple[str, ...]] = field(default_factory=dict)
    apart: Mapping[tuple[str, str], str] = field(default_factory=dict)

    @property
    def robots_and_terrains(self) -> tuple[tuple[str, str], ...]:
        """In the order of the runs."""
        return tuple(
            dict.fromkeys((each.split.robot, each.split.terrain) for each in self.split_models)
        )

    def windows_left_out_at(self, place: Place) -> Counter[str]:
        """How many windows of the runs of a place there are not, by reason."""
        return summed(each.windows.left_out for each in self.evaluations_at(place))

    @property
    def places(self) -> tuple[Place, ...]:
        """Robots and terrains over the given horizons."""
        return tuple(
            Place(robot, terrain, horizon_m)
            for robot, terrain in self.robots_and_terrains
            for horizon_m in self.config.horizons_m
        )

    def evaluations_at(self, place: Place) -> tuple[Evaluation, ...]:
        """Evaluations of one place."""
        return tuple(evaluation for evaluation in self.evaluations if place.holds(evaluation))

    def differences_at(self, place: Place) -> tuple[Difference, ...]:
        """Differences at one place."""
        return tuple(each for each in self.differences if each.place == place)

    def summaries_at(self, place: Place) -> tuple[Summary, ...]:
        """One summary a model; its `windows` is 0 where it was not evaluated."""
        evaluations = self.evaluations_at(place)
        return tuple(
            replace(
                summarise(place, evaluations, self.not_evaluated, model),
                not_identified=self.not_identified.get((place.robot, place.terrain, model), ()),
            )
            for model in self.models
        )

    def remarks_at(self, place: Place, summary: Summary) -> tuple[str, ...]:
        """Why a model was not evaluated on some run, what was left open, and what else to know."""
        fits = [
            each.predictors[summary.model]
            for each in self.split_models
            if (each.split.robot, each.split.terrain) == (place.robot, place.terrain)
            and summary.model in each.predictors
        ]
        open_ = [fit.undetermined for fit in fits if fit.undetermined]
        left_open = [
            f"not determined in {len(open_)} of {len(fits)} identifications, such as "
            f"{'; '.join(words)}"
            for words in open_[:1]
        ]
        notes = dict.fromkeys(note for fit in fits for note in fit.notes)
        return (*summary.reasons, *summary.not_identified, *left_open, *notes)

    def horizon_errors_of(self, robot: str, terrain: str) -> dict[str, tuple[HorizonErrors, ...]]:
        """Errors by model, over all training and evaluation horizons."""
        found: dict[str, list[HorizonErrors]] = {}
        for each in self.by_training_horizon:
            if (each.summary.place.robot, each.summary.place.terrain) == (robot, terrain):
                found.setdefault(each.summary.model, []).append(each)
        return {model: tuple(errors) for model, errors in found.items()}

    def fitness_at(self, place: Place) -> tuple[RunFitness, ...]:
        """Of the runs that were evaluated at one place."""
        runs = {evaluation.run for evaluation in self.evaluations_at(place)}
        return tuple(f for f in self.fitness if f.robot == place.robot and f.run in runs)

    def sentences_at(self, place: Place) -> list[str]:
        """What the numbers of one place say, after what speaks against them."""
        apart = self.apart.get((place.robot, place.terrain))
        summaries = self.summaries_at(place)
        said = sentences(place, summaries, self.differences_at(place), self.fitness_at(place))
        return [*([apart] if apart else []), *said]

    def contradictions_at(self, place: Place) -> list[str]:
        """Those of `sentences_at` that contradict the order of the mean window errors."""
        return contradictions(place, self.summaries_at(place), self.fitness_at(place))
