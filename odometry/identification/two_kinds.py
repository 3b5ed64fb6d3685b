"""Windows that two parameter sets explain far better than one: something changes while driving."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import IdentificationError, OdometryError
from odometry.identification.fit import Fit
from odometry.identification.fit_pair import FitPair
from odometry.identification.fitters import FitTo
from odometry.identification.plausibility import FAR_RESIDUALS
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows
from odometry.windows.window_errors import errors_over

LEAST_WINDOWS = 20  # fewer are explained by two sets where nothing changes
PIECES = 8  # of the windows, on which searches start
LEAST_PIECE = 5  # windows
ROUNDS = 8
MUCH_LESS = 0.5  # of the median error
LEAST_SHARE = 0.1  # of the windows
SHOWN = 4  # stretches of time


@dataclass(frozen=True)
class TwoKinds:
    """Windows of two kinds, each with its own parameters.

    Attributes
    ----------
    pair : FitPair
        The fits to either.
    is_second : (K,)
        Which windows of the whole are of the second kind.
    windows : Windows
        The whole.
    less : float
        Median error of windows under the set of their kind, as a share of that under one set.
    """

    pair: FitPair
    is_second: BoolArray
    windows: Windows
    less: float

    def note(self) -> str:
        """A sentence on what changes and when, and what to do."""
        return (
            f"something changes within the runs: with two parameter sets ({self.pair.values_named})"
            f" the median error is {1 / self.less:.1f} times less than with one, whose values are "
            f"an average that is true of neither. The second set fits {self._times()}. Name the "
            "terrain of each row (column terrain of odometry.csv), or identify parts alone (--from,"
            " --to)"
        )

    def _times(self) -> str:
        """When windows of the second kind start, by run."""
        starts = self.is_second & ~np.append(False, self.is_second[:-1] & self._goes_on)
        ends = self.is_second & ~np.append(self.is_second[1:] & self._goes_on, False)
        spans = [
            f"{self.windows.run[a]} {self.windows.start_s[a]:.0f} to {self.windows.start_s[b]:.0f}"
            for a, b in zip(np.flatnonzero(starts), np.flatnonzero(ends), strict=True)
        ]
        more = f" and {len(spans) - SHOWN} more" if len(spans) > SHOWN else ""
        return f"windows that start at {', '.join(spans[:SHOWN])} s{more}"

    @property
    def _goes_on(self) -> BoolArray:
        return np.asarray(self.windows.run[1:] == self.windows.run[:-1])


def two_kinds(windows: Windows | Stretches, fit_to: FitTo, whole: Fit) -> TwoKinds | None:
    """Two kinds of windows; None where one parameter set explains them about as well.

    Nothing is searched where the residuals are near the stated noise.

    A regression that switches between two sets: searches start on pieces of the windows; each
    window then goes to the set under which it and its neighbours err less, and the sets are
    fitted again, in turns. On the 26 recordings of data/motion with poses two sets leave 0.60 of
    the error of one and more.

    Parameters
    ----------
    windows : Windows or Stretches
        Of one terrain. Stretches are too few for two sets.
    fit_to : callable
        From windows to a fit.
    whole : Fit
        To all windows.

    References
    ----------
    Quandt 1958, "The estimation of the parameters of a linear regression system obeying two
    separate regimes"; Spaeth 1979, "Algorithm 39: clusterwise linear regression".
    """
    if isinstance(windows, Stretches) or len(windows) < LEAST_WINDOWS or not whole.names:
        return None
    if whole.scale <= FAR_RESIDUALS:
        return None
    try:
        return _divided(windows, fit_to, whole)
    except OdometryError:  # a part that determines nothing, or values out of bounds
        return None


def _divided(windows: Windows, fit_to: FitTo, whole: Fit) -> TwoKinds | None:
    pieces = _pieces(windows, fit_to, whole.values)
    if len(pieces) < 2:
        return None
    errors = {n: _errors(fit, windows) for n, fit in enumerate(pieces)}
    first, second = min(
        combinations(errors, 2),
        key=lambda pair: float(np.sum(np.minimum(errors[pair[0]], errors[pair[1]]) ** 2)),
    )
    pair, is_second = _in_turns(windows, fit_to, FitPair(pieces[first], pieces[second]))
    under_own = np.where(is_second, _errors(pair.second, windows), _errors(pair.first, windows))
    less = float(np.median(under_own) / np.median(_errors(whole, windows)))
    rarer = min(is_second.mean(), 1 - is_second.mean())
    if less > MUCH_LESS or rarer < LEAST_SHARE or not pair.differs:
        return None
    return TwoKinds(pair, is_second, windows, less)


def _pieces(windows: Windows, fit_to: FitTo, near: Mapping[str, float]) -> list[Fit]:
    """Fits to pieces, one after the other."""
    length = max(LEAST_PIECE, len(windows) // PIECES)
    found, places = [], np.arange(len(windows))
    for start in range(0, len(windows) - length + 1, length):
        try:
            here = (places >= start) & (places < start + length)
            found.append(fit_to(windows.where(here), near))
        except IdentificationError:
            continue
    return found


def _in_turns(windows: Windows, fit_to: FitTo, pair: FitPair) -> tuple[FitPair, BoolArray]:
    """Both fits and which windows are of the second, until no window changes sides.

    Raises
    ------
    IdentificationError
        If too few windows are left on one side.
    """
    is_second = np.zeros(len(windows), dtype=np.bool_)
    for _ in range(ROUNDS):
        excess = _errors(pair.first, windows) - _errors(pair.second, windows)
        now = np.convolve(excess, np.ones(3) / 3, "same") > 0
        if np.array_equal(now, is_second):
            break
        is_second = now
        parts = (windows.where(~is_second), windows.where(is_second))
        pair = FitPair(fit_to(parts[0], pair.first.values), fit_to(parts[1], pair.second.values))
    return pair, is_second


def _errors(fit: Fit, windows: Windows) -> FloatArray:
    """Error (K,) of each window per metre, a radian as a metre."""
    errors = errors_over(fit.model, fit.packed, windows)
    return np.hypot(errors.translation_per_m, errors.rotation_per_m)
