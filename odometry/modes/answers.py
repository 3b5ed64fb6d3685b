"""What the probabilities of modes say: a mode, none of these, or undetermined; and how well."""

import numpy as np

from odometry.arrays import AnyArray, BoolArray
from odometry.modes.mode_set import NO_MODES, NONE_OF_THESE, UNDETERMINED
from odometry.modes.mode_track import ModeTrack
from odometry.run import UNKNOWN

AGREED = 0.6  # probability from which on the rolling test takes a mode for the one that fits


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
