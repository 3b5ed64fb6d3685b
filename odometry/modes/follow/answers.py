"""Answers by the probabilities of modes, each test that refuses to name one, and their scores."""

import numpy as np

from odometry.arrays import AnyArray, BoolArray, FloatArray, IntArray
from odometry.modes.follow.mode_track import ModeTrack
from odometry.modes.models.mode_set import NO_MODES, NONE_OF_THESE, UNDETERMINED
from odometry.recording.run import UNKNOWN


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
    track: ModeTrack, by_camera: AnyArray, sure: float, lasting_s: float
) -> tuple[tuple[float, float, str, str], ...]:
    """Where camera and motion name different terrains for long: from, to [s], and both names.

    While one of them has no answer, a disagreement neither ends nor lasts.

    Parameters
    ----------
    track : ModeTrack
        Of motion alone.
    by_camera : (N,) of str
        The terrain under the robot by the camera; "unknown" where there is no label.
    sure, lasting_s : float
    """
    by_motion = named_modes(track, sure)
    lasts_s = np.append(np.diff(track.stamps_s), 0.0)
    both = np.flatnonzero(~np.isin(by_motion, NO_MODES) & (by_camera != UNKNOWN))
    changes = np.any([n[both][1:] != n[both][:-1] for n in (by_motion, by_camera)], axis=0)
    found = []
    for rows in np.split(both, np.flatnonzero(changes) + 1):
        if not len(rows) or by_motion[rows[0]] == by_camera[rows[0]]:
            continue
        if lasts_s[rows].sum() >= lasting_s:
            begin, end = track.stamps_s[rows[[0, -1]]].tolist()
            found.append((begin, end, str(by_camera[rows[0]]), str(by_motion[rows[0]])))
    return tuple(found)


def refusals(track: ModeTrack, sure: float) -> dict[str, BoolArray]:
    """Where (N,) each test refuses; a mode is named where none does.

    "probability" is that of the mode among the modes and against "none of these": `sure` or more
    where a mode begins to be named, and from there on, while that mode leads, down to
    `config.most_doubt` times the doubt (`ModesConfig`). In "alike" motion cannot distinguish the
    modes. The "rolling test" does not refuse a mode because another fits as well where feel
    says which it is.

    Parameters
    ----------
    track : ModeTrack
    sure : float
        Probability from which a mode is named.
    """
    config = track.config
    most = track.probabilities.argmax(axis=1)
    of_most = (np.arange(len(most)), most)
    confirmed = np.zeros(len(most), dtype=np.bool_)
    if track.felt is not None:
        confirmed = track.felt[of_most] >= config.agreed
    least = track.probabilities[of_most]
    found = {}
    if track.fit is not None:
        least = np.minimum(least, track.fit.against_none[of_most])
        agreed = np.exp(track.fit.log_probabilities[of_most]) >= config.agreed
        found["rolling test"] = ~(agreed | confirmed)
        found["six seconds"] = (np.abs(track.fit.lasting) > config.long_sigmas).any(axis=1)
    found["probability"] = ~_held(least, most, sure, config.most_doubt)
    if track.gyroscope is not None:
        found["bias of the gyroscope"] = track.gyroscope.bias_is_open
    if track.alike is not None:
        found["alike"] = track.alike.any(axis=1)
    others = {
        "turns": track.turns_are_off,
        "contradicted": track.contradicted,
        "gain": None if track.gain is None else track.gain.off,
        "centre": track.centre,
        "drift": track.drifts,
        "headings": track.headings_disagree,
        "blocked": track.blocked,
    }
    if track.travel is not None:
        found["travel"] = track.travel.off[of_most]
    return found | {name: refused for name, refused in others.items() if refused is not None}


def _held(probabilities: FloatArray, most: IntArray, sure: float, most_doubt: float) -> BoolArray:
    """Where (N,) a probability of the leading mode reached `sure` and did not fall far since.

    A threshold with hysteresis (Schmitt 1938): near one threshold an answer comes and goes.
    """
    rows = np.arange(len(most))
    kept = max(1 - most_doubt * (1 - sure), 0.5)
    led = np.append(False, most[1:] != most[:-1])
    begun = np.maximum.accumulate(np.where(probabilities >= sure, rows, -1))
    ended = np.maximum.accumulate(np.where((probabilities < kept) | led, rows, -1))
    return np.asarray((begun >= ended) & (begun >= 0))
