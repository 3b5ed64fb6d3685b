"""What of the gyroscope keeps modes from being named."""

import numpy as np

from odometry.arrays import BoolArray
from odometry.modes.follow.followed import Followed
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.recorded.bank_inputs import yaw_rates_of
from odometry.modes.recorded.held_rates import held_rates
from odometry.modes.show.doubt import Doubt, share_of_time, when


def of_gyroscope(followed: Followed, undetermined: BoolArray) -> list[Doubt]:
    """Its scale and its bias, and readings that are held; where (N,) the answer is open."""
    track, found = followed.last_track, _held(followed)
    if track.gyroscope is not None:
        scale, open_ = track.gyroscope.scale, track.gyroscope.bias_is_open & undetermined
        off = np.isfinite(scale)
        if off.any():
            found.append(
                Doubt(
                    f"the gyroscope reads {np.median(scale[off]):.2f} times what the measured "
                    f"headings turn {when(followed, off)}",
                    "check the gyroscope (unit, scale, axes) and the stamps of the headings",
                    share_of_time(followed, off),
                )
            )
        if open_.any():
            found.append(
                Doubt(
                    f"a mode would need a gyroscope bias of {track.means[open_, -1][-1]:.3f} "
                    f"rad/s {when(followed, open_)}, which nothing else confirms",
                    "let the robot rest for a second: that determines the bias",
                    share_of_time(followed, open_),
                )
            )
    return found


def _held(followed: Followed) -> list[Doubt]:
    """Of velocity modes, which have no other evidence of a turn."""
    rates = yaw_rates_of(followed.run)
    if rates is None or not isinstance(followed.mode_set.modes, VelocityModes):
        return []
    rows = held_rates(rates, followed.signals.tread_speeds_m_s)
    if not rows.any():
        return []
    return [
        Doubt(
            f"the gyroscope repeats one reading {when(followed, rows)}",
            "check the gyroscope (its cable, its driver, what is recorded when it is silent)",
            share_of_time(followed, rows),
        )
    ]
