"""What a record of tread speeds says by itself of values that it repeats."""

import numpy as np

from odometry.arrays import FloatArray


def between_new_values(stamps_s: FloatArray, speeds: FloatArray) -> FloatArray | None:
    """What lines between new values add to speeds (N, 2) [m/s] that repeat the one before them.

    A value that is the same to the last digit is seldom measured anew: a frame was lost, or speeds
    are computed less often than they are written. Nothing to a tread that stands; None where no
    speed is repeated.

    Examples
    --------
    >>> import numpy as np
    >>> from odometry.recording.repeated_speeds import between_new_values
    >>> speeds = np.array([[0.1, 0.2], [0.1, 0.3], [0.3, 0.4]])
    >>> between_new_values(np.arange(3.0), speeds).round(2).tolist()
    [[0.0, 0.0], [0.1, 0.0], [0.0, 0.0]]
    """
    added = np.stack([_drawn(stamps_s, own) - own for own in speeds.T], axis=-1)
    return added if added.any() else None


def _drawn(stamps_s: FloatArray, speeds: FloatArray) -> FloatArray:
    new = np.flatnonzero(np.diff(speeds, prepend=np.nan) != 0)
    lines = np.interp(stamps_s, stamps_s[new], speeds[new])
    return np.asarray(np.where(speeds == 0, speeds, lines))
