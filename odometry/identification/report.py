"""An identification on one terrain as lines of text, in the order of lmfit's `fit_report`."""

from collections.abc import Sequence
from math import degrees

import numpy as np

from odometry.digits import within_interval, within_sigma
from odometry.effects.tables import effects_of
from odometry.identification.fit import Fit
from odometry.identification.identification import Identified
from odometry.windows.travel.windows import Windows

LEAST_CORRELATION = 0.3  # that is reported
NO_HELD_OUT = (
    "  No held-out error: no part of the windows determines the model without the others, so the "
    "error of predictions is not known; add a run"
)


def report(terrain: str, found: Identified) -> list[str]:
    """Lines: statistics of the fit, variables, correlations, and errors per metre."""
    fit = found.fit
    lines = [f"[{terrain}] {fit.model.name}", "  Fit statistics", *_columns(_statistics(fit))]
    for added in effects_of(fit.model):
        held = ", ".join(f"{key} = {value:.5g}" for key, value in added.by_name.items())
        lines.append(f"    held: {added.effect.name} ({added.effect.form}): {held}")
    lines += ["  Variables", *_columns(_variables(found))]
    pairs = correlations(fit)
    lines.append(f"  Correlations (none reported below {LEAST_CORRELATION:g})")
    lines += [f"    C({first}, {second}) = {value:+.2f}" for first, second, value in pairs]
    lines += ["  Errors", *_columns(_errors(found)), *short_recording(fit)]
    return [*lines, NO_HELD_OUT] if found.held_out is None else lines


def in_short(terrain: str, found: Identified) -> str:
    """A fit in one line: windows, residuals, and identified values without intervals."""
    fit = found.fit
    values = [
        f"{name} = {fit.values[name]:.4g}{_doubt(fit, name)}"
        for name in (*fit.names, *fit.by_trial)
    ]
    return (
        f"[{terrain}] {fit.model.name}, {len(fit.windows)} {fit.noun}, residuals {fit.scale:.2f} "
        f"times the noise: {', '.join(values)}"
    )


def _doubt(fit: Fit, name: str) -> str:
    if name in fit.by_trial:
        return " (by trial)"
    if name in fit.open_names:
        return " (open)"
    return " (at its bound)" if name in fit.at_bound else ""


def correlations(fit: Fit, least: float = LEAST_CORRELATION) -> list[tuple[str, str, float]]:
    """Pairs of identified parameters and their correlation, the largest first.

    Those that are open or at a bound are left out: their variances mean nothing.

    Parameters
    ----------
    fit : Fit
    least : float
        Pairs whose correlation is nearer to zero are left out.
    """
    deviations = np.sqrt(np.diag(fit.covariance))
    units = np.maximum(np.outer(deviations, deviations), np.finfo(float).tiny)
    of = fit.covariance / units
    blurred = {*fit.open_names, *fit.at_bound}
    pairs = [
        (fit.names[i], fit.names[j], float(of[i, j]))
        for i, j in zip(*np.triu_indices(len(fit.names), 1), strict=True)
        if abs(of[i, j]) >= least and not blurred & {fit.names[i], fit.names[j]}
    ]
    return sorted(pairs, key=lambda pair: -abs(pair[2]))


def _statistics(fit: Fit) -> list[tuple[str, ...]]:
    runs = len(set(fit.windows.run))
    length = fit.windows.travel_m.mean()
    weighed_down = int(np.sum(fit.weights < 1))
    rows: list[tuple[str, ...]] = [
        ("data", f"{len(fit.windows)} {fit.noun} of {length:.2f} m in {runs} run(s)"),
        ("measured numbers", f"{fit.residuals.size}"),
        ("free parameters", f"{len(fit.names) + len(fit.by_trial)}"),
        ("residuals", f"{fit.scale:.2f} times {fit.compared_with}"),
        (f"outlying {fit.noun}", f"{weighed_down} weighed down"),
        ("starts", f"{fit.agreeing} of {fit.starts} agree"),
    ]
    if len(fit.names):
        least, most = fit.freedom.min(), fit.freedom.max()
        rows.insert(3, ("degrees of freedom", f"{least:.1f} to {most:.1f} behind the intervals"))
    return rows


def _variables(found: Identified) -> list[tuple[str, ...]]:
    fit, given = found.fit, found.given
    rows: list[tuple[str, ...]] = [
        ("parameter", "value", "+/-", "relative", "95 % low", "high", "start", "unit")
    ]
    sigmas, intervals = fit.sigmas, fit.intervals
    for parameter in fit.model.parameters:
        name, value = parameter.name, fit.values[parameter.name]
        number = f"{value:.5g}"
        if name in fit.by_trial:
            cells = ("by trial", "", "", "", f"{fit.start[name]:.5g}")
        elif name not in sigmas:
            cells = ("given" if name in given else "assumed", "", "", "", "")
        elif name in fit.open_names:
            cells = ("open", "", "", "", f"{fit.start[name]:.5g}")
        elif name in fit.at_bound:
            cells = ("at its bound", "", "", "", f"{fit.start[name]:.5g}")
        else:
            of, sigma = intervals[name], sigmas[name]
            share = f"{100 * sigma / abs(value):.1f} %" if value else ""
            number, low, high = within_interval(value, of.low, of.high)
            start = f"{fit.start[name]:.5g}"
            cells = (within_sigma(value, sigma)[1], share, low, high, start)
        rows.append((name, number, *cells, parameter.unit))
    return rows


def _errors(found: Identified) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [("mean error", "m per m", "degrees per m")]
    for name, errors in (
        (f"held out, by {found.held_out_by}", found.held_out),
        ("ideal differential drive", found.ideal),
    ):
        if errors is not None:
            translation, rotation = errors.translation_per_m, errors.rotation_per_m
            rows.append((name, f"{translation.mean():.4f}", f"{degrees(rotation.mean()):.3f}"))
    return rows


def _columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """Rows as lines, the first cell to the left, the others to the right of their columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    if len(widths) == 2:  # a name and words
        return [f"    {row[0].ljust(widths[0])}  {row[1]}" for row in rows]
    lines = []
    for row in rows:
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append(("    " + "  ".join(cells)).rstrip())
    return lines


# From here on tests/studies/identification/coverage.py finds 95 % or more where slip wanders.
STEADY_S = 20.0


def short_recording(fit: Fit) -> list[str]:
    """The sentence on a short recording, none for 20 s and more.

    Slip that wanders makes errors of neighbouring windows correlated. Three runs, or six stretches
    of one, show that by their spread (`spread`); the few windows of a short run do not. An
    estimate from the autocorrelation of their residuals (one lag, Newey and West 1987) leaves
    coverage as it is: in 100 runs of 13 s at 10 Hz with slip that wanders by 10 % over 3 s it is
    92 % with and without.
    """
    if not fit.names or not isinstance(fit.windows, Windows):
        return []
    lasted_s = _covered_s(fit.windows)
    if lasted_s >= STEADY_S:
        return []
    return [
        f"  The windows last {lasted_s:.0f} s in all: too short to show whether slip wanders. "
        "Where it does, 95 % intervals hold the truth less often (88 to 94 % in simulated runs of "
        f"13 s, 95 % from {STEADY_S:g} s on); add a run"
    ]


def _covered_s(windows: Windows) -> float:
    """How long the samples last that lie in any window."""
    depth = np.zeros(len(windows.steps_s) + 1, dtype=np.int64)
    np.add.at(depth, windows.first, 1)
    np.add.at(depth, windows.last, -1)
    return float(windows.steps_s[np.cumsum(depth[:-1]) > 0].sum())
