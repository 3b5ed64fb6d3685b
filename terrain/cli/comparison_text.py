"""How `compare` prints what it found."""

from typing import TYPE_CHECKING

import click

from terrain.cli.results import print_table

if TYPE_CHECKING:
    from odometry.comparison.result import Comparison
    from odometry.comparison.summary import Place


def print_comparison(comparison: "Comparison") -> None:
    """Print errors, splits, what the errors say at each place, and training horizons."""
    _print_errors(comparison)
    _print_splits(comparison)
    for place in comparison.places:
        _print_place(comparison, place)
    _print_training_horizons(comparison)


def _print_training_horizons(comparison: "Comparison") -> None:
    """Print which training horizons suit which evaluation horizon, a line a model and quantity."""
    from odometry.comparison.summary import QUANTITIES
    from odometry.comparison.training_horizons import horizon_sentence

    for robot, terrain in comparison.robots_and_terrains:
        for model, errors in comparison.horizon_errors_of(robot, terrain).items():
            for quantity in QUANTITIES:
                said = horizon_sentence(model, errors, quantity)
                click.echo(f"{robot} on {terrain}: {said}")


def _print_errors(comparison: "Comparison") -> None:
    """Print one row a place and model."""
    from odometry.comparison.summary import NOT_IDENTIFIED

    rows: list[tuple[str, ...]] = [
        (
            *("robot", "terrain", "over", "model", "windows"),
            *("m per m: mean", "median", "degrees per m: mean", "median", ""),
        )
    ]
    for place in comparison.places:
        for summary in comparison.summaries_at(place):
            errors = (
                statistic.get(quantity)
                for quantity in ("translation", "rotation")
                for statistic in (summary.means, summary.medians)
            )
            cells = ["-" if error is None else f"{error:.4f}" for error in errors]
            remark = "see below" if comparison.remarks_at(place, summary) else ""
            if not summary.ranked:
                remark = NOT_IDENTIFIED if summary.complete else "not ranked, see below"
            over = f"{place.horizon_m:g} m"
            where = (place.robot, place.terrain, over, summary.model, str(summary.windows))
            rows.append((*where, *cells, remark))
    click.echo("Held-out errors, per metre of wheel travel:")
    print_table(rows)


def _print_splits(comparison: "Comparison") -> None:
    """Print on which runs the models were identified for which others, where any were."""
    from odometry.comparison.candidates import AS_GIVEN

    predictors = [p for each in comparison.split_models for p in each.predictors.values()]
    if not any(p.covariance_order and AS_GIVEN not in p.notes for p in predictors):
        return
    click.echo("Held out, and what the models were identified on for it:")
    for models in comparison.split_models:
        split = models.split
        held_out = ", ".join(part.name for part in split.held_out)
        click.echo(f"  {split.robot} on {split.terrain}: {held_out}: {split.training_names}")


def _print_place(comparison: "Comparison", place: "Place") -> None:
    """Print what the errors of one place say, and what to know of them."""
    from odometry.windows.left_out import words

    click.echo(f"{place.title}:")
    for sentence in comparison.sentences_at(place):
        click.echo(f"  {sentence}")
    for summary in comparison.summaries_at(place):
        for remark in comparison.remarks_at(place, summary):
            if remark not in summary.reasons:  # the sentences have them
                click.echo(f"  Note: {summary.model}: {remark}")
    left_out = comparison.windows_left_out_at(place)
    if left_out:
        click.echo(f"  Note: in these runs {words(left_out)}")
