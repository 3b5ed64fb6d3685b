"""Yaw rates that cannot be: spikes, and a gyroscope that falls silent."""

import math
from typing import NamedTuple

from odometry.estimation.filter_event import FilterEvent

JUMP_RAD_S, JUMP_RAD_S2 = 1.5, 20.0  # a change of rate by more is held out ...
HELD_OUT_S = 0.2  # ... for so long; after that it is used
SILENT_S = 1.0


class GyroscopeWatch(NamedTuple):
    """What is remembered of the gyroscope.

    Attributes
    ----------
    last_rad_s, last_s : float
        The last rate that was used, and when; NaN before the first.
    held_out_since_s : float
        Stamp since when rates are held out; NaN if they are not.
    largest_rad_s : float
        Of those held out.
    """

    last_rad_s: float = math.nan
    last_s: float = math.nan
    held_out_since_s: float = math.nan
    largest_rad_s: float = 0.0


def watched(
    watch: GyroscopeWatch, yaw_rate: float, begin_s: float, stamp_s: float
) -> tuple[GyroscopeWatch, float, tuple[FilterEvent, ...]]:
    """The yaw rate to use over a step from `begin_s` to `stamp_s`.

    While a rate is held out, the last one goes on.
    """
    if math.isnan(yaw_rate):
        return watch, yaw_rate, ()
    events: tuple[FilterEvent, ...] = ()
    if begin_s - watch.last_s > SILENT_S:
        events = ongoing(watch, begin_s)
    elif abs(yaw_rate - watch.last_rad_s) > JUMP_RAD_S + JUMP_RAD_S2 * (stamp_s - watch.last_s):
        since_s = begin_s if math.isnan(watch.held_out_since_s) else watch.held_out_since_s
        if stamp_s - since_s <= HELD_OUT_S:
            largest = max(watch.largest_rad_s, yaw_rate, key=abs)
            held = GyroscopeWatch(watch.last_rad_s, watch.last_s, since_s, largest)
            return held, watch.last_rad_s, ()
    elif not math.isnan(watch.held_out_since_s):
        size = f"{watch.largest_rad_s:.2f} rad/s"
        text = f"a yaw rate of {size} is a single outlier: the one before it was held"
        events = (FilterEvent("gyroscope_spike", watch.held_out_since_s, begin_s, text),)
    return GyroscopeWatch(yaw_rate, stamp_s), yaw_rate, events


def ongoing(watch: GyroscopeWatch, stamp_s: float) -> tuple[FilterEvent, ...]:
    """The event of a silence that lasts at a stamp."""
    if not stamp_s - watch.last_s > SILENT_S:
        return ()
    text = "the gyroscope was silent: the treads turned the robot"
    return (FilterEvent("gyroscope_silence", watch.last_s, stamp_s, text),)
