"""What a comparison says in sentences: each names the errors of which it speaks."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import permutations

from odometry.comparison.statistics import Difference, between
from odometry.comparison.summary import QUANTITIES, Place, Summary
from odometry.comparison.whole_runs import RunFitness
from odometry.evaluation.fitness import Fitness, pooled_fitness

EFFECTIVE_WIDTH = "icr_symmetric"
CLEARLY_LESS = 0.95  # of a median or of J/N: less than this share of it says another order


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
    complete = _complete(summaries)
    said = []
    for quantity in QUANTITIES:
        of_quantity = [each for each in found if each.quantity == quantity]
        if len(complete) > 1:
            said += _best(place, quantity, complete, of_quantity)
    said += contradictions(place, summaries, fitness)
    if EFFECTIVE_WIDTH in complete and len(complete) > 1:
        said += _effective_width(place, list(complete), found, fitness)
    for summary in summaries:
        if not summary.complete:
            reasons = "; ".join(summary.reasons)
            said.append(f"{summary.model} is not in this comparison on {place.terrain}: {reasons}.")
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
    place: Place, quantity: str, complete: Mapping[str, Summary], found: Sequence[Difference]
) -> list[str]:
    where = f"over {place.horizon_m:g} m on {place.terrain} in {quantity}"
    best = min(complete, key=lambda model: complete[model].means[quantity])
    error = f"{complete[best].means[quantity]:.4f} {QUANTITIES[quantity]}"
    tied = [
        f"{model} (difference {difference.words()})"
        for model in complete
        if (difference := between(found, best, model)) is not None
        and difference.interval.holds_zero
    ]
    if not tied:
        return [f"{best} errs least {where}, {error}; every other model errs more."]
    return [
        f"{best} errs least {where}, {error}.",
        f"{best} cannot be distinguished {where} from {'; '.join(tied)}.",
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
    of_all = _whole_runs_of_all(list(complete), fitness)
    if not of_all:
        return []
    pooled = _pooled(complete, of_all)
    said = []
    for model, summary in complete.items():
        better = [
            f"{other} ({pooled[other]:.3g}; on {_lost(model, other, of_all)})"
            for other in complete
            if summary.means["translation"] < complete[other].means["translation"]
            and pooled[other] < CLEARLY_LESS * pooled[model]
        ]
        if better:
            said.append(
                f"On whole runs on {place.terrain} {model} (J/N {pooled[model]:.3g}) errs more "
                f"than {', '.join(better)}, although its mean translation error over "
                f"{place.horizon_m:g} m is less."
            )
    return said


def _effective_width(
    place: Place,
    models: Sequence[str],
    found: Sequence[Difference],
    fitness: Sequence[RunFitness],
) -> list[str]:
    """In which quantities no model is shown to beat a fitted effective width over windows.

    Whole runs on which one does are named in the same sentence.
    """
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
    said = (
        f"Over {place.horizon_m:g} m no model is shown to beat a fitted effective width "
        f"({EFFECTIVE_WIDTH}) on {place.terrain} in {' or '.join(unbeaten)}"
    )
    of_all = _whole_runs_of_all(models, fitness)
    pooled = _pooled(models, of_all) if of_all else {}
    better = [
        f"{model} (J/N {pooled[model]:.3g} against {pooled[EFFECTIVE_WIDTH]:.3g}; on "
        f"{_lost(EFFECTIVE_WIDTH, model, of_all)})"
        for model in pooled
        if pooled[model] < CLEARLY_LESS * pooled[EFFECTIVE_WIDTH]
    ]
    also = f"; on whole runs these err less: {', '.join(better)}" if better else ""
    return [f"{said}{also}."]


def _whole_runs_of_all(
    models: Sequence[str], fitness: Sequence[RunFitness]
) -> list[dict[str, Fitness]]:
    """Of each run that has a fitness of all models, these by model."""
    runs: dict[str, dict[str, Fitness]] = {}
    for each in fitness:
        runs.setdefault(each.run, {})[each.model] = each.fitness
    return [of_run for of_run in runs.values() if set(models) <= set(of_run)]


def _pooled(models: Iterable[str], of_all: Sequence[Mapping[str, Fitness]]) -> dict[str, float]:
    """J / N of each model over the poses of all these runs."""
    return {model: pooled_fitness([of_run[model] for of_run in of_all]) for model in models}


def _lost(model: str, other: str, of_all: Sequence[Mapping[str, Fitness]]) -> str:
    """On how many runs a model errs more than another one."""
    lost = sum(of_run[model].mean > of_run[other].mean for of_run in of_all)
    return f"{lost} of {len(of_all)} runs"
