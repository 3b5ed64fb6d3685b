"""What a filter noticed and what has not ended at the last stamp of a run."""

import math

from odometry.estimation.filter_event import FilterEvent, gap_event
from odometry.estimation.watches import (
    contrary_treads,
    frozen_treads,
    gyroscope_hold,
    gyroscope_watch,
    pose_watch,
    rest_watch,
    stuck_watch,
    tread_watch,
)
from odometry.estimation.watches.sensor_watch import Events, SensorWatch


def ongoing(watch: SensorWatch, stamp_s: float) -> Events:
    """Events that have begun and not ended at the last stamp of a run."""
    found: list[FilterEvent] = []
    if not math.isnan(watch.gap_since_s):
        found.append(gap_event(watch.gap_since_s, stamp_s))
    if watch.treads.stuck >= 0:
        stuck = watch.treads._replace(same_since_s=(stamp_s, stamp_s))
        found += tread_watch.freed(stuck, stamp_s)[1]
    found += frozen_treads.ended(watch.frozen, stamp_s)
    found += contrary_treads.ended(watch.contrary, stamp_s)
    if watch.hold is not None:
        found += gyroscope_hold.ended(watch.hold, stamp_s)
    found += gyroscope_watch.ongoing(watch.gyroscope, stamp_s)
    if watch.rest is not None:
        found += rest_watch.ended(watch.rest, stamp_s)
    found += stuck_watch.ended(watch.stuck, stamp_s)
    return (*found, *pose_watch.ongoing(watch.poses, stamp_s))
