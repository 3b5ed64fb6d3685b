"""Fits on one part of the recordings, evaluated on the other: runs held out, and both halves."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from odometry.arrays import FloatArray, IntArray
from odometry.errors import IdentificationError
from odometry.identification.fit import Fit
from odometry.identification.fitters import FitTo
from odometry.windows.stretches import Stretches
from odometry.windows.window_errors import WindowErrors, errors_over
from odometry.windows.windows import Windows

MOST_FOLDS = 10  # fits of an evaluation: more of them take time and change little


def by_runs(windows: Windows | Stretches) -> IntArray:
    """Parts (K,) to hold out in turn: the runs, or ten groups of runs where there are more.

    Runs that were given one after the other are in one group: they are often parts of one drive.
    """
    runs = {run: i for i, run in enumerate(dict.fromkeys(windows.run))}
    groups = np.arange(len(runs)) * min(len(runs), MOST_FOLDS) // len(runs)
    return np.asarray(groups[[runs[run] for run in windows.run]], dtype=np.int64)


def by_halves(windows: Windows | Stretches) -> IntArray:
    """Parts (K,) to hold out in turn: the first and the second half of every run.

    Windows that reach into the other half are in neither: -1.
    """
    parts = np.zeros(len(windows), dtype=np.int64)
    for run in dict.fromkeys(windows.run):
        here = np.flatnonzero(windows.run == run)
        second = here[len(here) // 2 :]
        parts[second] = 1
        first = here[: len(here) // 2]
        parts[first[windows.last[first] > windows.first[second[0]]]] = -1
    return parts


def held_out_errors(
    windows: Windows | Stretches,
    parts: IntArray,
    fit_to: Callable[[Windows | Stretches], Fit],
) -> WindowErrors:
    """Errors of every window that is in a part, under the model fitted to the other parts.

    Parameters
    ----------
    windows : Windows or Stretches
    parts : (K,)
        -1 for windows that take no part.
    fit_to : callable
        From windows to a fit.

    Raises
    ------
    IdentificationError
        If there is one part, or the others cannot be fitted.
    """
    numbers = np.unique(parts[parts >= 0])
    if len(numbers) < 2:
        raise IdentificationError("there is one part, and nothing to fit on but what is held out")
    translation, rotation = np.full((2, len(windows)), np.nan)
    for part in numbers:
        here = parts == part
        fitted = fit_to(windows.where((parts >= 0) & ~here))
        errors = errors_over(fitted.model, fitted.packed, windows.where(here))
        translation[here], rotation[here] = errors.translation_per_m, errors.rotation_per_m
    held_out = parts >= 0
    return WindowErrors(translation[held_out], rotation[held_out])


BY_CHANCE = 1e-6  # probability below which halves differ
WORSE = 1.2  # how much farther off each half must be under the parameters of the other
NAMED_SIGMAS = 3.0  # of a difference that is named


@dataclass(frozen=True)
class Halves:
    """Fits to the first and to the second half of every run.

    Attributes
    ----------
    first, second : Fit
    """

    first: Fit
    second: Fit

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters that both halves determine."""
        determined = [
            {*fit.names} - fit.open_names - {*fit.at_bound} for fit in (self.first, self.second)
        ]
        return tuple(name for name in self.first.names if name in determined[0] & determined[1])

    @property
    def by_chance(self) -> float:
        """Probability of a difference as large if the parameters were the same (Wald's test)."""
        if not self.names:
            return 1.0
        squared = float(self._difference @ np.linalg.solve(self._covariance, self._difference))
        return float(chi2.sf(squared, len(self.names)))

    @property
    def worse(self) -> float:
        """How many times farther off a half is under the other's parameters: of the better half.

        By the mean error of position or of yaw, whichever shows more.
        """
        shares = []
        for own, other in ((self.first, self.second), (self.second, self.first)):
            here, there = (errors_over(f.model, f.packed, own.windows) for f in (own, other))
            shares.append(
                max(
                    float(theirs.mean() / max(ours.mean(), np.finfo(float).tiny))
                    for ours, theirs in (
                        (here.translation_per_m, there.translation_per_m),
                        (here.rotation_per_m, there.rotation_per_m),
                    )
                )
            )
        return min(shares)

    def note(self) -> str | None:
        """A sentence where the halves give different parameters, and what to do.

        The probability was chosen on the 19 recordings of data/motion that are not among the
        seven on which the odometer is evaluated: it is 5e-6 and more on each.
        """
        if self.by_chance >= BY_CHANCE or self.worse < WORSE:
            return None
        sigmas = np.sqrt(np.diag(self._covariance))
        clear = np.abs(self._difference) / sigmas
        named = [
            f"{name} {self.first.values[name]:.3g} and {self.second.values[name]:.3g}"
            for name, size in zip(self.names, clear.tolist(), strict=True)
            if size > min(NAMED_SIGMAS, clear.max() * 0.999)
        ]
        return (
            "the first and the second half of the runs give different parameters "
            f"({', '.join(named)}); with those of the other, the error of each half is "
            f"{self.worse:.1f} times as large: the values are an average of both. Identify parts "
            "alone (--from, --to), or name the terrain of each row (column terrain of odometry.csv)"
        )

    @property
    def _difference(self) -> FloatArray:
        return np.array([self.second.values[n] - self.first.values[n] for n in self.names])

    @property
    def _covariance(self) -> FloatArray:
        return _of(self.first, self.names) + _of(self.second, self.names)


def _of(fit: Fit, names: Iterable[str]) -> FloatArray:
    rows = [fit.names.index(name) for name in names]
    return fit.normal_covariance[np.ix_(rows, rows)]


def halves_of(
    windows: Windows | Stretches, fit_to: FitTo, near: Mapping[str, float]
) -> Halves | None:
    """Fits to both halves, searched near some values; None where one cannot be fitted."""
    parts = by_halves(windows)
    try:
        first, second = (fit_to(windows.where(parts == part), near) for part in (0, 1))
    except IdentificationError:
        return None
    return Halves(first, second)
