"""By how much the robot turns more or less than the mode that is not named for it, in words."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.modes.checks.gain_check import GainCheck
from odometry.modes.follow.mode_track import ModeTrack


def gain_words(track: ModeTrack, gain: GainCheck, gains: FloatArray, rows: BoolArray) -> str:
    """The mode that led for most of the rows (N,), and where the turns lie among the modes.

    Parameters
    ----------
    track : ModeTrack
    gain : GainCheck
    gains : (M,)
        Mean yaw rate of each mode by the difference of the treads [rad/m].
    rows : (N,)
        Some of those where the gain is off.
    """
    leading = track.probabilities.argmax(axis=1)
    place = int(np.bincount(leading[rows]).argmax())
    excess = float(np.nanmedian(gain.excess[rows & (leading == place)]))
    more = excess > 0
    said = f"{abs(100 * excess):.0f} % {'more' if more else 'less'} than on {track.names[place]}"
    if track.between is None:  # sets of wheels: one turns more in some turns, less in others
        return said
    apart = gains / gains[place] - 1
    beside = np.flatnonzero(apart > 0 if more else apart < 0)
    if not len(beside):
        return f"{said}, beyond all modes"
    following = int(beside[np.abs(apart[beside]).argmin()])
    share = excess / apart[following]
    if share >= 1:
        return f"{said}, beyond {track.names[following]}"
    return f"{said}, {share:.1f} of the way to {track.names[following]}"
