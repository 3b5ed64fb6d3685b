"""Stretches in which no mode of the set fits."""

from dataclasses import dataclass

import numpy as np

from odometry.modes.mode_track import ModeTrack

BOUND = 2.0  # standard deviations: 95 % of what is left of a mode that is true


@dataclass(frozen=True)
class Misfit:
    """A stretch in which no mode of the set fits.

    Attributes
    ----------
    from_s, to_s : float
        From the last stamp before at which all of the nearest mode was within BOUND.
    signal : int
        Place of the measured entry that fits least.
    sigmas : float
        Root mean square of what is left of it in a window where the nearest mode is taken: 1 where
        that mode is true.
    """

    from_s: float
    to_s: float
    signal: int
    sigmas: float


def misfits(track: ModeTrack, sure: float) -> tuple[Misfit, ...]:
    """The stretches in which the answer of the rolling test is "none of these"."""
    if track.fit is None:
        return ()
    none, best = track.fit.none, track.fit.best
    rows = np.flatnonzero(none >= sure)
    fitted = np.flatnonzero(none < 1 - sure)
    quiet = np.flatnonzero(~(np.abs(best) > BOUND).any(axis=1))
    found: list[Misfit] = []
    # stretches between which a mode was not as probable as ever are one
    cuts = np.flatnonzero(np.diff(np.searchsorted(fitted, rows))) + 1
    for stretch in np.split(rows, cuts) if len(rows) else []:
        before = np.searchsorted(quiet, stretch[0])
        first = int(quiet[before - 1]) if before else 0
        squares = best[first : stretch[-1] + 1] ** 2
        measured = np.isfinite(squares).any(axis=0)
        sizes = np.full(best.shape[1], -1.0)
        sizes[measured] = np.sqrt(np.nanmean(squares[:, measured], axis=0))
        signal = int(sizes.argmax())
        begin, end = track.stamps_s[[first, stretch[-1]]].tolist()
        found.append(Misfit(begin, end, signal, float(sizes[signal])))
    return tuple(found)
