"""What a comparison says in sentences."""

from collections.abc import Sequence

from odometry.comparison.statistics import Difference, between
from odometry.comparison.summary import QUANTITIES, Place, Summary

EFFECTIVE_WIDTH = "icr_symmetric"


def sentences(place: Place, summaries: Sequence[Summary], found: Sequence[Difference]) -> list[str]:
    """Which model errs least, which cannot be told apart from it, and what was left out.

    Parameters
    ----------
    place : Place
    summaries : sequence of Summary
        Of all models at the place.
    found : sequence of Difference
        Of the place.
    """
    where = f"on {place.terrain}"
    complete = {summary.model: summary for summary in summaries if summary.complete}
    said = []
    for quantity in QUANTITIES:
        of_quantity = [each for each in found if each.quantity == quantity]
        if len(complete) > 1:
            said += _best(where, quantity, complete, of_quantity)
    if EFFECTIVE_WIDTH in complete and len(complete) > 1:
        said += _effective_width(where, list(complete), found)
    for summary in summaries:
        if not summary.complete:
            reasons = "; ".join(summary.reasons)
            said.append(f"{summary.model} is not in this comparison {where}: {reasons}.")
    return said


def _best(
    where: str, quantity: str, complete: dict[str, Summary], found: Sequence[Difference]
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
        f"{best} cannot be told apart {where} in {quantity} from {'; '.join(tied)}.",
    ]


def _effective_width(where: str, models: Sequence[str], found: Sequence[Difference]) -> list[str]:
    """Say what beats a fitted effective width, or that nothing does."""
    better = {
        quantity: [
            model
            for model in models
            if (difference := _against_width(found, model, quantity)) is not None
            and difference.interval.high < 0
        ]
        for quantity in QUANTITIES
    }
    unbeaten = [quantity for quantity, beating in better.items() if not beating]
    said = []
    if unbeaten:
        said.append(
            f"Nothing beats a fitted effective width ({EFFECTIVE_WIDTH}) {where} in "
            f"{' or '.join(unbeaten)}."
        )
    return said


def _against_width(found: Sequence[Difference], model: str, quantity: str) -> Difference | None:
    of_quantity = [each for each in found if each.quantity == quantity]
    return between(of_quantity, model, EFFECTIVE_WIDTH) if model != EFFECTIVE_WIDTH else None
