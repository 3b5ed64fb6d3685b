"""What a comparison says in sentences: each names the errors of which it speaks."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import permutations

from odometry.comparison.evaluation import RunFitness
from odometry.comparison.statistics import Difference, between
from odometry.comparison.summary import NOT_IDENTIFIED, QUANTITIES, Place, Summary
from odometry.evaluation.open_loop import Fitness, pooled_fitness

EFFECTIVE_WIDTH = "icr_symmetric"
CLEARLY_LESS = 0.95  # of a median or of J/N: less than this share of it says another order


def sentences(
    place: Place,
    summaries: Sequence[Summary],
    found: Sequence[Difference],
    fitness: Sequence[RunFitness] = (),
) -> list[str]:
    """Which model has the smallest error, which cannot be distinguished, what contradicts it.

    Parameters
    ----------
    place : Place
    summaries : sequence of Summary
        Of all models at the place; only those whose parameters are identified are ranked.
    found : sequence of Difference
        Of the place.
    fitness : sequence of RunFitness
        Of the runs of the place.
    """
    ranked = _ranked(summaries)
    unranked = any(not summary.ranked for summary in summaries)
    others = "every other ranked model" if unranked else "every other model"
    said = []
    for quantity in QUANTITIES:
        of_quantity = [each for each in found if each.quantity == quantity]
        if len(ranked) > 1:
            said += _best(place, quantity, ranked, of_quantity, others)
    said += contradictions(place, summaries, fitness)
    if EFFECTIVE_WIDTH in ranked and len(ranked) > 1:
        said += _effective_width(place, list(ranked), found, fitness)
    for summary in summaries:
        if not summary.complete:
            reasons = "; ".join(summary.reasons)
            said.append(f"{summary.model} is not in this comparison on {place.terrain}: {reasons}.")
        elif summary.not_identified:
            said.append(_not_identified(place, summary, ranked))
    return said


def contradictions(
    place: Place, summaries: Sequence[Summary], fitness: Sequence[RunFitness]
) -> list[str]:
    """Where medians, or errors of whole runs, order models otherwise than mean window errors."""
    ranked = _ranked(summaries)
    return [
        *(said for quantity in QUANTITIES for said in _medians(place, quantity, ranked)),
        *_whole_runs(place, ranked, fitness),
    ]


def _ranked(summaries: Sequence[Summary]) -> dict[str, Summary]:
    """Models evaluated on all windows, with parameters that `identify` would write."""
    return {summary.model: summary for summary in summaries if summary.ranked}


def _not_identified(place: Place, summary: Summary, ranked: Mapping[str, Summary]) -> str:
    """The errors of a model whose parameters are no answer, beside the best that is one."""
    errors = []
    for quantity, unit in QUANTITIES.items():
        said = f"{summary.means[quantity]:.4f} {unit} in {quantity}"
        if ranked:
            best = min(ranked.values(), key=lambda each: each.means[quantity])
            said += f" ({best.model}, the least of those that are ranked: "
            said += f"{best.means[quantity]:.4f})"
        errors.append(said)
    return (
        f"{summary.model} is not ranked, and its parameters are not written: "
        f"{'; '.join(summary.not_identified)} ({NOT_IDENTIFIED}). It predicts all the same, over "
        f"{place.horizon_m:g} m on {place.terrain}: {' and '.join(errors)}."
    )


def _best(
    place: Place,
    quantity: str,
    ranked: Mapping[str, Summary],
    found: Sequence[Difference],
    others: str,
) -> list[str]:
    where = f"over {place.horizon_m:g} m on {place.terrain} in {quantity}"
    best = min(ranked, key=lambda model: ranked[model].means[quantity])
    error = f"{ranked[best].means[quantity]:.4f} {QUANTITIES[quantity]}"
    tied = [
        f"{model} (difference {difference.words()})"
        for model in ranked
        if (difference := between(found, best, model)) is not None
        and difference.interval.holds_zero
    ]
    if not found:
        return [
            f"{best} has the smallest error {where}, {error}, in one window: that shows no order."
        ]
    if not tied:
        return [f"{best} has the smallest error {where}, {error}; {others} has a larger one."]
    return [
        f"{best} has the smallest error {where}, {error}.",
        f"{best} cannot be distinguished {where} from {'; '.join(tied)}.",
    ]


def _medians(place: Place, quantity: str, ranked: Mapping[str, Summary]) -> list[str]:
    """The pair of models whose order differs most between mean and median."""
    ratios = {
        (first, second): ranked[second].medians[quantity] / ranked[first].medians[quantity]
        for first, second in permutations(ranked, 2)
        if ranked[first].means[quantity] < ranked[second].means[quantity]
        and ranked[second].medians[quantity] < CLEARLY_LESS * ranked[first].medians[quantity]
    }
    if not ratios:
        return []
    first, second = (ranked[model] for model in min(ratios, key=lambda pair: ratios[pair]))
    return [
        f"Mean and median disagree on {place.terrain} in {quantity}: {first.model} has a smaller "
        f"error than {second.model} by the mean ({first.means[quantity]:.4f} against "
        f"{second.means[quantity]:.4f} {QUANTITIES[quantity]}) and a larger one by the median "
        f"({first.medians[quantity]:.4f} against {second.medians[quantity]:.4f}): windows with "
        "large errors count for more in the means."
    ]


def _whole_runs(
    place: Place, ranked: Mapping[str, Summary], fitness: Sequence[RunFitness]
) -> list[str]:
    """Models with smaller errors than others over windows, and larger ones on whole runs."""
    of_all = _whole_runs_of_all(list(ranked), fitness)
    if not of_all:
        return []
    pooled = _pooled(ranked, of_all)
    said = []
    for model, summary in ranked.items():
        better = [
            f"{other} ({pooled[other]:.3g}; on {_lost(model, other, of_all)})"
            for other in ranked
            if summary.means["translation"] < ranked[other].means["translation"]
            and pooled[other] < CLEARLY_LESS * pooled[model]
        ]
        if better:
            said.append(
                f"On whole runs on {place.terrain} {model} (J/N {pooled[model]:.3g}) has a larger "
                f"error than {', '.join(better)}, although its mean translation error over "
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
    also = f"; on whole runs these have smaller errors: {', '.join(better)}" if better else ""
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
    """On how many runs the error of a model is larger than that of another one."""
    lost = sum(of_run[model].mean > of_run[other].mean for of_run in of_all)
    return f"{lost} of {len(of_all)} runs"
