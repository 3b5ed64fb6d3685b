"""The tests that refuse to name the most probable mode, each by itself."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.modes.mode_track import ModeTrack


def refusals(track: ModeTrack, sure: float) -> dict[str, BoolArray]:
    """Where (N,) each test refuses; a mode is named where none does.

    "probability" is that of the mode among the modes and against "none of these": `sure` or more
    where a mode begins to be named, and from there on, while that mode leads, down to
    `config.most_doubt` times the doubt (`ModesConfig`). In "alike" motion cannot tell the modes
    apart. The "rolling test" does not refuse a mode because another fits as well where feel says
    which it is.

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
    if track.turns_are_off is not None:
        found["turns"] = track.turns_are_off
    if track.headings_disagree is not None:
        found["headings"] = track.headings_disagree
    if track.travel is not None:
        found["travel"] = track.travel.off[of_most]
    return found


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
