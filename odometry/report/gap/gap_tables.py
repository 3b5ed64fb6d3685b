"""The tables of a gap's page."""

import numpy as np

from odometry.digits import three_figures, within_interval, within_sigma
from odometry.effects.unknown.residual_of_each_run import ResidualOfEachRun
from odometry.gap.answer.result import Closing, GapResult
from odometry.gap.config import GapConfig
from odometry.gap.locate.region_words import noun_of
from odometry.gap.prepare.statistic import squared_errors
from odometry.gap.show.quantities import Share, evidence_words, percent, with_interval
from odometry.gap.show.words import Moved, moves_of
from odometry.report.drawing.html import Grid

PART_S = GapConfig.part_s
WORST = 5  # stretches that are listed


def closing_grid(result: GapResult, share: Share | None) -> Grid:
    """The gap before and after."""
    held = "-" if share is None else percent(share)
    rows = [
        ("held out", *_closing(result.holdout), "-" if result.turns else held),
        ("measured, fitted", *_closing(result.measured), "-"),
    ]
    error = "position error"
    if result.turns:
        fitted, held_out = result.turns
        other = held_out.before.measure.error
        rows.append((f"held out, {other}", *_closing(held_out), held))
        rows.append((f"measured, {other}", *_closing(fitted), "-"))
        error = f"position error, and {other}, by which the effects are judged,"
    header = ("windows", "before", "after", "noise floor", "excess closed")
    caption = f"RMS {error} over windows of {result.horizon_s:g} s, with 95 % intervals."
    return Grid(header, rows, caption)


def effect_grid(result: GapResult) -> Grid:
    """The effects in the order added."""
    rows = [
        (
            effect.added.effect.name,
            effect.added.effect.form.replace("_", " "),
            effect.added.effect.acts_on,
            effect.added.effect.equation,
            effect.added.effect.source,
            three_figures(effect.gap_before),
            three_figures(effect.gap_after),
            f"{effect.evidence:.0f}",
        )
        for effect in result.effects
    ]
    header = (
        *("effect", "form", "acts on", "equation", "source"),
        *("gap before [m]", "after [m]", "evidence"),
    )
    return Grid(header, rows, "In the order added; gaps on the measured runs.")


def parameter_grid(result: GapResult) -> Grid:
    """Parameters of the effects with intervals, but those that each run has of its own."""
    rows = []
    for effect in result.effects:
        added = effect.added
        if isinstance(added.effect, ResidualOfEachRun):
            continue  # its shape is drawn
        columns = (added.effect.parameters, added.values, effect.low, effect.high)
        for parameter, *ends in zip(*columns, strict=True):
            value, low, high = within_interval(*map(float, ends))
            unit = parameter.unit or "-"
            rows.append((added.effect.name, parameter.name, value, f"{low} to {high}", unit))
    return Grid(("effect", "parameter", "value", "95 % interval", "unit"), rows)


def base_grid(result: GapResult) -> Grid:
    """The base before, and moved within what its calibration leaves open."""
    before, after = result.calibration.base, result.base
    numbers = [
        (parameter.name, parameter.unit or "-", *values)
        for parameter, *values in zip(
            before.model.parameters, before.values, after.values, strict=True
        )
    ]
    numbers.append(("latency", "s", before.latency_s, after.latency_s))
    moves = {one.name: one for one in moves_of(result.calibration, result.base)}
    rows = [
        (name, *_moved(moves[name]), unit, f"{moves[name].sigmas:.1f}")
        if name in moves
        else (name, three_figures(old), three_figures(new), unit, "-")
        for name, unit, old, new in numbers
    ]
    caption = (
        f"The model {before.model.name}: as calibrated, with one standard deviation, and after the "
        "fit to the measured runs. Latency: by how much the robot always follows its recorded "
        "speeds late."
    )
    heads = ("parameter", "calibrated", "after", "unit", "moved by sigmas")
    return Grid(heads, rows, caption)


def _moved(move: Moved) -> tuple[str, str]:
    """Before, with its standard deviation, and after."""
    before, sigma = within_sigma(move.before, move.sigma)
    return f"{before} ± {sigma}", within_sigma(move.after, move.sigma)[0]


def rival_grid(result: GapResult) -> Grid:
    """All candidates for the first effect."""
    rows = [
        (
            r.name,
            r.form_in_words,
            f"{round(r.evidence)}",
            evidence_words(r.evidence),
            three_figures(r.gap_after),
        )
        for r in result.rivals
    ]
    caption = (
        "Candidates for the first effect. Evidence: twice the log-likelihood gained on windows not "
        "fitted, less the penalty for parameters; gaps on the measured runs."
    )
    return Grid(("candidate", "form", "evidence", "in words", "gap after [m]"), rows, caption)


def region_grid(result: GapResult) -> Grid:
    """Where the excess was."""
    rows = [
        (
            region.words,
            "; ".join(_bound(n, low, high) for n, (low, high) in region.bounds.items()) or "-",
            three_figures(region.excess_m),
            f"{100 * region.share:.0f} %",
        )
        for region in result.location.regions
    ]
    caption = (
        "Bounds were drawn on one half of the pieces of the measured runs, and all figures are of "
        "the other half. Excess: RMS position error less the noise floor; share: of the squared "
        "errors beyond noise."
    )
    return Grid(("where", "bounds (SI)", "excess [m]", "share"), rows, caption)


def worst_grid(result: GapResult) -> Grid:
    """The stretches of the measured runs with the largest gap, after the effects."""
    rows = []
    for scene in result.measured_scenes:
        before = squared_errors(result.calibration.base, (), scene)
        after = squared_errors(result.base, result.added, scene)
        piece = np.floor(scene.start_s / PART_S).astype(np.int64)
        for number in np.unique(piece):
            own = piece == number
            rms = (float(np.sqrt(of[own].mean())) for of in (before, after))
            rows.append((scene.run.name, number * PART_S, *rms))
    worst = sorted(rows, key=lambda row: -row[3])[:WORST]
    header = ("run", "run time [s]", "before [m]", "after [m]")
    caption = f"The {len(worst)} stretches of {PART_S:g} s with the largest error after the fit."
    return Grid(
        header,
        [
            (name, f"{begin:.0f} to {begin + PART_S:.0f}", three_figures(old), three_figures(new))
            for name, begin, old, new in worst
        ],
        caption,
    )


def predictor_grid(result: GapResult) -> Grid:
    """Which variables predict the residuals."""
    rows = [
        (
            noun_of(one.name),
            "yes" if one.discovered else "no",
            f"{one.p_value:.4f}",
            f"{one.strength:.2f}",
            one.predicts if one.strength > 0 else "-",
        )
        for one in result.location.predictors
    ]
    caption = (
        "Rank tests over groups of each variable, before any effect was added; false discoveries "
        "are held at 5 %. Strength: the share of the variance of ranks that it explains, of the "
        "residual named."
    )
    return Grid(("variable", "discovered", "p", "strength", "residual"), rows, caption)


def equivalent_grid(result: GapResult) -> Grid:
    """What the data cannot distinguish."""
    rows = [(one.instead_of, one.name, one.told_apart_by) for one in result.equivalent]
    return Grid(("named", "could also be", "distinguished by"), rows)


def _closing(closing: Closing) -> tuple[str, str, str]:
    return (
        with_interval(closing.before),
        with_interval(closing.after),
        with_interval(closing.noise_floor),
    )


def _bound(name: str, low: float | None, high: float | None) -> str:
    if low is None:
        return f"{name} up to {high:.3g}"
    if high is None:
        return f"{name} above {low:.3g}"
    return f"{name} {low:.3g} to {high:.3g}"
