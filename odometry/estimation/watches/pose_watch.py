"""Poses that stay away, or that stay the same while the robot moves."""

import math
from typing import NamedTuple

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent

OUTAGE_S, OUTAGE_PERIODS = 2.0, 10.0  # longer than both is an outage
FROZEN_TRAVEL_M = 0.1  # of the wheels, or ...
FROZEN_TURN_RAD = 0.1  # ... of the gyroscope, since a pose that is repeated to the last digit
FROZEN_STEPS = 2.0  # of rounded positions, that the robot goes ahead
FROZEN_S = 1.0  # for an event; a pose or two that were written twice are none
NOTHING = math.nan, math.nan, math.nan


class PoseWatch(NamedTuple):
    """What is remembered of the measured poses.

    Attributes
    ----------
    pose : (x, y, yaw) or None
        The last one.
    changed_s, seen_s, fresh_s : float
        Stamps at which it came first and last, and of the last one that was used.
    period_s : float
        Usual time between poses; 0 before the second.
    travel_m, turn_rad : float
        Travel of the wheels and turn of the gyroscope since it came first.
    rounded_m : float
        Step to which positions are rounded; 0 for none. They stay the same on a turn on the spot.
    """

    pose: tuple[float, ...] | None = None
    changed_s: float = math.nan
    seen_s: float = math.nan
    fresh_s: float = math.nan
    period_s: float = 0.0
    travel_m: float = 0.0
    turn_rad: float = 0.0
    rounded_m: float = 0.0


def moved(
    watch: PoseWatch, speeds_m_s: FloatArray, yaw_rate: float, step_s: float
) -> tuple[float, float]:
    """Travel [m] and turn [rad] over a step that show in poses; what is not known counts as none.

    Travel of the wheels; of rounded positions the way ahead alone.
    """
    left, right = speeds_m_s.tolist()
    travel_m, turn_rad = (abs(left) + abs(right)) / 2 * step_s, yaw_rate * step_s
    if watch.rounded_m:
        travel_m, turn_rad = abs(left + right) / 2 * step_s, 0.0
    return (
        0.0 if math.isnan(travel_m) else travel_m,
        0.0 if math.isnan(turn_rad) else turn_rad,
    )


def watched(
    watch: PoseWatch, pose: FloatArray | None, stamp_s: float, moved_by: tuple[float, float]
) -> tuple[PoseWatch, FloatArray | None, tuple[FilterEvent, ...]]:
    """The watch after a step, the pose (3,) to use at its end, and events that ended there.

    Parameters
    ----------
    watch : PoseWatch
    pose : (3,) or None
        Measured at the end.
    stamp_s : float
        Of the end.
    moved_by : (m, rad)
        Of `moved`, over the step.
    """
    last, changed_s, seen_s, fresh_s, period_s, gone_m, turned_rad, rounded_m = watch
    gone_m, turned_rad = gone_m + moved_by[0], turned_rad + moved_by[1]
    cells = NOTHING if pose is None else tuple(pose.tolist())
    x, y, yaw = cells
    if math.isnan(x) and math.isnan(y) and math.isnan(yaw):
        after = PoseWatch(last, changed_s, seen_s, fresh_s, period_s, gone_m, turned_rad, rounded_m)
        return after, None, ()
    if last is None:
        after = PoseWatch(cells, stamp_s, stamp_s, stamp_s, rounded_m=rounded_m)
        return after, pose, ()
    if _are_same(cells, last):
        least_m = max(FROZEN_TRAVEL_M, FROZEN_STEPS * rounded_m)
        frozen = gone_m > least_m or abs(turned_rad) > FROZEN_TURN_RAD
        fresh_s = fresh_s if frozen else stamp_s
        after = watch._replace(
            pose=cells, seen_s=stamp_s, fresh_s=fresh_s, travel_m=gone_m, turn_rad=turned_rad
        )
        return after, None if frozen else pose, ()
    away_s = stamp_s - seen_s
    events: tuple[FilterEvent, ...] = ()
    if away_s > OUTAGE_S or seen_s > fresh_s:
        ended = watch._replace(travel_m=gone_m, turn_rad=turned_rad)
        events = ongoing(ended, stamp_s)
    if away_s <= max(OUTAGE_S, OUTAGE_PERIODS * period_s) or period_s == 0:
        period_s = away_s if period_s == 0 else 0.9 * period_s + 0.1 * away_s
    after = PoseWatch(cells, stamp_s, stamp_s, stamp_s, period_s, rounded_m=rounded_m)
    return after, pose, events


def ongoing(watch: PoseWatch, stamp_s: float) -> tuple[FilterEvent, ...]:
    """Events of poses that were frozen, or that stay away at a stamp."""
    found = []
    if watch.seen_s - watch.fresh_s > FROZEN_S:
        text = (
            f"the poses stayed the same to the last digit while the wheels went "
            f"{watch.travel_m:.2f} m: they were not used"
        )
        found.append(FilterEvent("frozen_poses", watch.changed_s, watch.seen_s, text))
    away_s = stamp_s - watch.seen_s
    if watch.period_s > 0 and away_s > max(OUTAGE_S, OUTAGE_PERIODS * watch.period_s):
        text = f"no pose came for {away_s:.1f} s"
        found.append(FilterEvent("pose_outage", watch.seen_s, stamp_s, text))
    return tuple(found)


def _are_same(one: tuple[float, ...], other: tuple[float, ...]) -> bool:
    """Whether two poses are the same to the last digit, parts that were not measured included."""
    if not math.isnan(sum(one)):
        return one == other
    return all(a == b or (math.isnan(a) and math.isnan(b)) for a, b in zip(one, other, strict=True))
