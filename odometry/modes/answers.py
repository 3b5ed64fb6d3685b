"""What the probabilities of modes say: a mode, none of these, or undetermined; and how well."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.modes.mode_set import NO_MODES, NONE_OF_THESE, UNDETERMINED
from odometry.modes.mode_track import ModeTrack
from odometry.run import UNKNOWN

AGREED = 0.6  # probability from which on the rolling test takes a mode for the one that fits
BOUND = 2.0  # standard deviations: 95 % of what is left of a mode that is true


@dataclass(frozen=True)
class Detection:
    """A stretch of one true mode, and how soon it was detected.

    Attributes
    ----------
    mode : str
    from_s, to_s : float
    after_s : float
        From its beginning to the first answer that names it; NaN where it never was named.
    right, wrong, undetermined, none_of_these : float
        Shares of the time after that: with its name, with another, with none, and where no mode
        is said to fit. NaN where it was never named.
    """

    mode: str
    from_s: float
    to_s: float
    after_s: float
    right: float
    wrong: float
    undetermined: float
    none_of_these: float


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


def named_modes(track: ModeTrack, sure: float) -> AnyArray:
    """The answer (N,): a mode, "none of these", or "undetermined".

    A mode is named whose probability among the modes is `sure` or more, and against "none of
    these" as well; which the rolling test takes for the one that fits, too; and whose bias of the
    gyroscope is one that is expected. Neither turns to one side nor the distance that was measured
    contradict it. A gyroscope whose scale is off tells no mode, and where every mode travels by
    another distance than was measured none fits.
    """
    most = track.probabilities.argmax(axis=1)
    named = track.probabilities.max(axis=1) >= sure
    none = np.zeros(len(most), dtype=np.bool_)
    if track.fit is not None:
        of_most = (np.arange(len(most)), most)
        named &= track.fit.against_none[of_most] >= sure
        named &= np.exp(track.fit.log_probabilities[of_most]) >= AGREED
        named &= ~track.fit.lasts
        none = track.fit.none >= sure
    if track.gyroscope is not None:
        named &= ~track.gyroscope.bias_is_open
        none = none | np.isfinite(track.gyroscope.scale)
    if track.alike is not None:
        named &= ~track.alike.any(axis=1)
    if track.turns_are_off is not None:
        named &= ~track.turns_are_off
    if track.travel is not None:
        named &= ~track.travel.off[np.arange(len(most)), most]
        none = none | track.travel.off.all(axis=1)
    answers = np.where(named, np.array(track.names, dtype=object)[most], UNDETERMINED)
    return np.where(none, NONE_OF_THESE, answers)


def candidates(track: ModeTrack, sure: float) -> BoolArray:
    """The fewest modes (N, M) at each stamp that have a probability of `sure` together."""
    order = np.argsort(-track.probabilities, axis=1, kind="stable")
    summed = np.cumsum(np.take_along_axis(track.probabilities, order, axis=1), axis=1)
    before = np.concatenate([np.zeros((len(summed), 1)), summed[:, :-1]], axis=1)
    chosen = np.empty(track.probabilities.shape, dtype=np.bool_)
    np.put_along_axis(chosen, order, before < sure, axis=1)
    return chosen


def detections(track: ModeTrack, sure: float) -> tuple[Detection, ...]:
    """One for each stretch of a label that is a mode."""
    answers = named_modes(track, sure)
    lasts_s = np.append(np.diff(track.stamps_s), 0.0)
    cuts = np.flatnonzero(track.labels[1:] != track.labels[:-1]) + 1
    found = []
    for rows in np.split(np.arange(len(answers)), cuts):
        mode = str(track.labels[rows[0]])
        if mode == UNKNOWN or mode not in track.names:
            continue
        named = np.flatnonzero(answers[rows] == mode)
        begin, end = float(track.stamps_s[rows[0]]), float(track.stamps_s[rows[-1]])
        if not len(named):
            found.append(Detection(mode, begin, end, *[float("nan")] * 5))
            continue
        after = rows[named[0] :]
        shares = _shares(answers[after], lasts_s[after], mode)
        found.append(Detection(mode, begin, end, float(track.stamps_s[after[0]]) - begin, *shares))
    return tuple(found)


def false_switches(track: ModeTrack, sure: float) -> int:
    """How often the answer turned to a mode that is not the true one."""
    answers = named_modes(track, sure)
    rows = np.flatnonzero(~np.isin(answers, NO_MODES) & (track.labels != UNKNOWN))
    names, truth = answers[rows], track.labels[rows]
    turned = np.append(True, names[1:] != names[:-1])
    return int((turned & (names != truth)).sum())


def disagreements(
    track: ModeTrack, sight: AnyArray, sure: float, lasting_s: float
) -> tuple[tuple[float, float, str, str], ...]:
    """Where sight and feel name different terrains for long: from, to [s], seen, felt.

    While one of them says nothing, a disagreement neither ends nor lasts.

    Parameters
    ----------
    track : ModeTrack
        Of motion alone.
    sight : (N,) of str
        The terrain that vision says the robot is on; "unknown" where it says nothing.
    sure, lasting_s : float
    """
    felt = named_modes(track, sure)
    lasts_s = np.append(np.diff(track.stamps_s), 0.0)
    both = np.flatnonzero(~np.isin(felt, NO_MODES) & (sight != UNKNOWN))
    changes = (felt[both][1:] != felt[both][:-1]) | (sight[both][1:] != sight[both][:-1])
    found = []
    for rows in np.split(both, np.flatnonzero(changes) + 1):
        if not len(rows) or felt[rows[0]] == sight[rows[0]]:
            continue
        if lasts_s[rows].sum() >= lasting_s:
            begin, end = track.stamps_s[rows[[0, -1]]].tolist()
            found.append((begin, end, str(sight[rows[0]]), str(felt[rows[0]])))
    return tuple(found)


def confusion(track: ModeTrack, sure: float, names: Sequence[str]) -> FloatArray:
    """Seconds (M, M + 2) by true mode or label (row) and answer (column).

    The last columns are "none of these" and "undetermined". `names` are the rows.
    """
    answers = named_modes(track, sure)
    lasts_s = np.append(np.diff(track.stamps_s), 0.0)
    columns = [*track.names, *NO_MODES]
    return np.array(
        [
            [lasts_s[(track.labels == row) & (answers == column)].sum() for column in columns]
            for row in names
        ]
    )


def misfits(track: ModeTrack, sure: float) -> tuple[Misfit, ...]:
    """The stretches in which the rolling test says "none of these"."""
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


def _shares(answers: AnyArray, lasts_s: FloatArray, mode: str) -> tuple[float, float, float, float]:
    if not lasts_s.any():  # the last stamp alone
        lasts_s = np.ones(len(answers))
    whole = float(lasts_s.sum())
    others = ~np.isin(answers, (mode, *NO_MODES))
    chosen = (answers == mode, others, answers == UNDETERMINED, answers == NONE_OF_THESE)
    right, wrong, open_, none = (float(lasts_s[of].sum()) / whole for of in chosen)
    return right, wrong, open_, none
