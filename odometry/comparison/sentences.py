"""What a comparison says in sentences."""

from collections.abc import Mapping, Sequence
from itertools import permutations

from odometry.comparison.statistics import Difference, between
from odometry.comparison.summary import QUANTITIES, Place, Summary
from odometry.comparison.whole_runs import RunFitness
from odometry.evaluation.fitness import Fitness, pooled_fitness

EFFECTIVE_WIDTH = "icr_symmetric"
CLEARLY_LESS = 0.95  # of a median: less than this share of it says another order than the means


def sentences(
    place: Place,
    summaries: Sequence[Summary],
    found: Sequence[Difference],
    fitness: Sequence[RunFitness] = (),
) -> list[str]:
    """Which model errs least, which cannot be distinguished from it, and what contradicts that.

    Parameters
    ----------
    place : Place
    summaries : sequence of Summary
        Of all models at the place.
    found : sequence of Difference
        Of the place.
    fitness : sequence of RunFitness
        Of the runs of the place.
    """
    where = f"on {place.terrain}"
    complete = _complete(summaries)
    said = []
    for quantity in QUANTITIES:
        of_quantity = [each for each in found if each.quantity == quantity]
        if len(complete) > 1:
            said += _best(where, quantity, complete, of_quantity)
    said += contradictions(place, summaries, fitness)
    if EFFECTIVE_WIDTH in complete and len(complete) > 1:
        said += _effective_width(where, list(complete), found)
    for summary in summaries:
        if not summary.complete:
            reasons = "; ".join(summary.reasons)
            said.append(f"{summary.model} is not in this comparison {where}: {reasons}.")
    return said


def contradictions(
    place: Place, summaries: Sequence[Summary], fitness: Sequence[RunFitness]
) -> list[str]:
    """Where medians, or errors of whole runs, order models otherwise than mean window errors."""
    complete = _complete(summaries)
    return [
        *(said for quantity in QUANTITIES for said in _medians(place, quantity, complete)),
        *_whole_runs(place, complete, fitness),
    ]


def _complete(summaries: Sequence[Summary]) -> dict[str, Summary]:
    return {summary.model: summary for summary in summaries if summary.complete}


def _best(
    where: str, quantity: str, complete: Mapping[str, Summary], found: Sequence[Difference]
) -> list[str]:
    best = min(complete, key=lambda model: complete[model].means[quantity])
    error = f"{complete[best].means[quantity]:.4f} {QUANTITIES[quantity]}"
    tied = [
        f"{model} (difference {difference.words()})"
        for model in complete
        if (difference := between(found, best, model)) is not None
        and difference.interval.holds_zero
    ]
    if not tied:
        return [f"{best} errs least {where} in {quantity}, {error}; every other model errs more."]
    return [
        f"{best} errs least {where} in {quantity}, {error}.",
        f"{best} cannot be distinguished {where} in {quantity} from {'; '.join(tied)}.",
    ]


def _medians(place: Place, quantity: str, complete: Mapping[str, Summary]) -> list[str]:
    """The pair of models whose order differs most between mean and median."""
    ratios = {
        (first, second): complete[second].medians[quantity] / complete[first].medians[quantity]
        for first, second in permutations(complete, 2)
        if complete[first].means[quantity] < complete[second].means[quantity]
        and complete[second].medians[quantity] < CLEARLY_LESS * complete[first].medians[quantity]
    }
    if not ratios:
        return []
    first, second = (complete[model] for model in min(ratios, key=lambda pair: ratios[pair]))
    return [
        f"Mean and median disagree on {place.terrain} in {quantity}: {first.model} errs less than "
        f"{second.model} by the mean ({first.means[quantity]:.4f} against "
        f"{second.means[quantity]:.4f} {QUANTITIES[quantity]}) and more by the median "
        f"({first.medians[quantity]:.4f} against {second.medians[quantity]:.4f}): a few windows "
        "with large errors decide the means."
    ]


def _whole_runs(
    place: Place, complete: Mapping[str, Summary], fitness: Sequence[RunFitness]
) -> list[str]:
    """Models that err less than others over windows, and more on whole runs."""
    runs: dict[str, dict[str, Fitness]] = {}
    for each in fitness:
        runs.setdefault(each.run, {})[each.model] = each.fitness
    of_all = [of_run for of_run in runs.values() if set(complete) <= set(of_run)]
    if not of_all:
        return []
    pooled = {m: pooled_fitness([of_run[m] for of_run in of_all]) for m in complete}
    said = []
    for model, summary in complete.items():
        better = [
            f"{other} ({pooled[other]:.3g}; on "
            f"{sum(of_run[model].mean > of_run[other].mean for of_run in of_all)} of "
            f"{len(of_all)} runs)"
            for other in complete
            if summary.means["translation"] < complete[other].means["translation"]
            and pooled[other] < pooled[model]
        ]
        if better:
            said.append(
                f"On whole runs on {place.terrain} {model} (J/N {pooled[model]:.3g}) errs more "
                f"than {', '.join(better)}, although its mean translation error over "
                f"{place.horizon_m:g} m is less."
            )
    return said


def _effective_width(where: str, models: Sequence[str], found: Sequence[Difference]) -> list[str]:
    """Say in which quantities nothing beats a fitted effective width."""
    beaten = {
        each.quantity
        for each in found
        for model in models
        if (difference := between([each], model, EFFECTIVE_WIDTH)) is not None
        and difference.interval.high < 0
    }
    unbeaten = [quantity for quantity in QUANTITIES if quantity not in beaten]
    if not unbeaten:
        return []
    return [
        f"Nothing beats a fitted effective width ({EFFECTIVE_WIDTH}) {where} in "
        f"{' or '.join(unbeaten)}."
    ]
