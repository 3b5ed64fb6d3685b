"""The result of a comparison."""

from collections.abc import Mapping
from dataclasses import dataclass

from odometry.comparison.config import ComparisonConfig
from odometry.comparison.differences import Difference
from odometry.comparison.judgement import Judgement, RunFitness, Shortfall
from odometry.comparison.prepare import Prepared
from odometry.comparison.summary import Place, Summary, summarise
from odometry.comparison.words import sentences
from odometry.parameters import ParameterSet


@dataclass(frozen=True)
class Comparison:
    """Models judged on what they have not seen.

    Attributes
    ----------
    models : tuple of str
    prepared : tuple of Prepared
        The models of each split.
    judgements : tuple of Judgement
        Over all horizons.
    shortfalls : tuple of Shortfall
    left_out : Mapping of folder to str
        Runs that cannot be judged, and why.
    differences : tuple of Difference
        Over the horizons that were asked for.
    fitness : tuple of RunFitness
    parameters : Mapping of (robot, model) to ParameterSet
        Of the identified models, from all that they may see.
    config : ComparisonConfig
    """

    models: tuple[str, ...]
    prepared: tuple[Prepared, ...]
    judgements: tuple[Judgement, ...]
    shortfalls: tuple[Shortfall, ...]
    left_out: Mapping[str, str]
    differences: tuple[Difference, ...]
    fitness: tuple[RunFitness, ...]
    parameters: Mapping[tuple[str, str], ParameterSet]
    config: ComparisonConfig

    @property
    def robots_and_grounds(self) -> tuple[tuple[str, str], ...]:
        """In the order of the runs."""
        return tuple(dict.fromkeys((each.split.robot, each.split.ground) for each in self.prepared))

    @property
    def places(self) -> tuple[Place, ...]:
        """Robots and grounds over the horizons that were asked for."""
        return tuple(
            Place(robot, ground, horizon_m)
            for robot, ground in self.robots_and_grounds
            for horizon_m in self.config.horizons_m
        )

    def judgements_at(self, place: Place) -> tuple[Judgement, ...]:
        """Judgements of one place."""
        return tuple(judgement for judgement in self.judgements if place.holds(judgement))

    def differences_at(self, place: Place) -> tuple[Difference, ...]:
        """Differences at one place."""
        return tuple(each for each in self.differences if each.place == place)

    def summaries_at(self, place: Place) -> tuple[Summary, ...]:
        """One summary a model; its `windows` is 0 where it was not judged."""
        judgements = self.judgements_at(place)
        return tuple(summarise(place, judgements, self.shortfalls, m) for m in self.models)

    def remarks_at(self, place: Place, summary: Summary) -> tuple[str, ...]:
        """Why a model was not judged on some run, what was left open, and what else to know."""
        fits = [
            prepared.predictors[summary.model]
            for prepared in self.prepared
            if (prepared.split.robot, prepared.split.ground) == (place.robot, place.ground)
            and summary.model in prepared.predictors
        ]
        open_ = [fit.undetermined for fit in fits if fit.undetermined]
        left_open = [
            f"not determined in {len(open_)} of {len(fits)} identifications, such as "
            f"{'; '.join(words)}"
            for words in open_[:1]
        ]
        notes = dict.fromkeys(note for fit in fits for note in fit.notes)
        return (*summary.reasons, *left_open, *notes)

    def sentences_at(self, place: Place) -> list[str]:
        """What the numbers of one place say."""
        return sentences(place, self.summaries_at(place), self.differences_at(place))
