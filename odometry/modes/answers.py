"""Answers by the probabilities of modes: a mode, none of these, or undetermined; their scores."""

import numpy as np

from odometry.arrays import AnyArray, BoolArray
from odometry.modes.mode_set import NO_MODES, NONE_OF_THESE, UNDETERMINED
from odometry.modes.mode_track import ModeTrack
from odometry.modes.refusals import refusals
from odometry.run import UNKNOWN


def named_modes(track: ModeTrack, sure: float) -> AnyArray:
    """The answer (N,): a mode, "none of these", or "undetermined".

    A mode is named that no test refuses (see `refusals`). None fits where the rolling test refuses
    all with a probability of `sure`, where the gyroscope's scale is off, where every mode travels
    by another distance than was measured, and where the robot turns by more than one mode and by
    less than the next.
    """
    most = track.probabilities.argmax(axis=1)
    named = ~np.any(list(refusals(track, sure).values()), axis=0)
    answers = np.where(named, np.array(track.names, dtype=object)[most], UNDETERMINED)
    return np.where(_none_fits(track, sure), NONE_OF_THESE, answers)


def _none_fits(track: ModeTrack, sure: float) -> BoolArray:
    none = np.zeros(len(track.stamps_s), dtype=np.bool_)
    if track.fit is not None:
        none |= track.fit.none >= sure
    if track.gyroscope is not None:
        none |= np.isfinite(track.gyroscope.scale)
    if track.travel is not None:
        none |= track.travel.off.all(axis=1)
    if track.between is not None:
        none |= track.between.holds
    return none


def candidates(track: ModeTrack, sure: float) -> BoolArray:
    """The fewest modes (N, M) at each stamp that have a probability of `sure` together.

    With them those that the drive does not distinguish from the most probable one, whatever their
    probability: that comes of errors of models alone.
    """
    order = np.argsort(-track.probabilities, axis=1, kind="stable")
    summed = np.cumsum(np.take_along_axis(track.probabilities, order, axis=1), axis=1)
    before = np.concatenate([np.zeros((len(summed), 1)), summed[:, :-1]], axis=1)
    chosen = np.empty(track.probabilities.shape, dtype=np.bool_)
    np.put_along_axis(chosen, order, before < sure, axis=1)
    return chosen if track.alike is None else chosen | track.alike


def disagreements(
    track: ModeTrack, sight: AnyArray, sure: float, lasting_s: float
) -> tuple[tuple[float, float, str, str], ...]:
    """Where camera and feel name different terrains for long: from, to [s], seen, felt.

    While one of them has no answer, a disagreement neither ends nor lasts.

    Parameters
    ----------
    track : ModeTrack
        Of motion alone.
    sight : (N,) of str
        The terrain under the robot by the camera; "unknown" where there is no label.
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
