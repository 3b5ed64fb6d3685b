"""What the probabilities of modes say: a mode, or that it cannot be told; and how well."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray
from odometry.modes.track import ModeTrack
from odometry.run import UNKNOWN

UNDETERMINED = "undetermined"


@dataclass(frozen=True)
class Detection:
    """A stretch of one true mode, and how soon it was told.

    Attributes
    ----------
    mode : str
    from_s, to_s : float
    after_s : float
        From its beginning to the first answer that names it; NaN where it never was named.
    right, wrong, undetermined : float
        Shares of the time after that: with its name, with another, with none. NaN where it was
        never named.
    """

    mode: str
    from_s: float
    to_s: float
    after_s: float
    right: float
    wrong: float
    undetermined: float


def named_modes(track: ModeTrack, sure: float) -> AnyArray:
    """The mode (N,) whose probability is `sure` or more; "undetermined" where there is none."""
    most = track.probabilities.argmax(axis=1)
    names = np.array(track.names, dtype=object)[most]
    return np.where(track.probabilities.max(axis=1) >= sure, names, UNDETERMINED)


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
            found.append(Detection(mode, begin, end, *[float("nan")] * 4))
            continue
        after = rows[named[0] :]
        shares = _shares(answers[after], lasts_s[after], mode)
        found.append(Detection(mode, begin, end, float(track.stamps_s[after[0]]) - begin, *shares))
    return tuple(found)


def false_switches(track: ModeTrack, sure: float) -> int:
    """How often the answer turned to a mode that is not the true one."""
    answers = named_modes(track, sure)
    told = answers != UNDETERMINED
    told_rows = np.flatnonzero(told & (track.labels != UNKNOWN))
    names, truth = answers[told_rows], track.labels[told_rows]
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
    both = np.flatnonzero((felt != UNDETERMINED) & (sight != UNKNOWN))
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
    """Seconds (M, M + 1) by true mode (row) and answer (column), the last "undetermined"."""
    answers = named_modes(track, sure)
    lasts_s = np.append(np.diff(track.stamps_s), 0.0)
    columns = [*names, UNDETERMINED]
    return np.array(
        [
            [lasts_s[(track.labels == row) & (answers == column)].sum() for column in columns]
            for row in names
        ]
    )


def _shares(answers: AnyArray, lasts_s: FloatArray, mode: str) -> tuple[float, float, float]:
    if not lasts_s.any():  # the last stamp alone
        lasts_s = np.ones(len(answers))
    whole = float(lasts_s.sum())
    right = float(lasts_s[answers == mode].sum()) / whole
    open_ = float(lasts_s[answers == UNDETERMINED].sum()) / whole
    return right, 1 - right - open_, open_
