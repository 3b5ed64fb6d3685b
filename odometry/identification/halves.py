"""Fits on one part of the recordings, evaluated on the other: runs held out, and both halves."""

from collections.abc import Callable, Mapping

import numpy as np

from odometry.arrays import IntArray
from odometry.errors import IdentificationError
from odometry.identification.fit import Fit
from odometry.identification.fit_pair import FitPair
from odometry.identification.fitters import FitTo
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows
from odometry.windows.window_errors import WindowErrors, errors_over

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


class Halves(FitPair):
    """Fits to the first and to the second half of every run."""

    def note(self) -> str | None:
        """A sentence where the halves give different parameters, and what to do."""
        if not self.differs:
            return None
        return (
            "the first and the second half of the runs give different parameters "
            f"({self.values_named}); with those of the other, the error of each half is "
            f"{self.worse:.1f} times as large: the values are an average of both. Identify parts "
            "alone (--from, --to), or name the terrain of each row (column terrain of odometry.csv)"
        )


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
