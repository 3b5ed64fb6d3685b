"""What a live filter noticed of its sensors, in sentences."""

import math
from collections.abc import Collection

from odometry.estimation.estimate import ALPHAS, Estimate
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.transition import Y_LEFT, Y_RIGHT
from odometry.replays.run_end import lasting_events
from terrain.result.evaluation_notes import HARMLESS

SILENT_GYROSCOPE = "gyroscope_silence"
# Robots that were measured turn as if 1.0 to 3.1 track widths wide, and move 0.24 (on ice) to 1.05
# times as far as their treads
NARROW, WIDE = 0.6, 4.5
SLOW, FAST = 0.15, 1.7
SIGMAS = 2.0


class NoticedSoFar:
    """Keeps the latest misleading event of each kind; memory does not grow with the events.

    Parameters
    ----------
    track_width_m : float
    stated : collection of str
        Terrains whose parameters the user states: an odd motion by these is no surprise.
    """

    def __init__(self, track_width_m: float, stated: Collection[str]) -> None:
        self._track_width_m, self._stated = track_width_m, stated
        self._odd_as_stated: dict[str, bool] = {}
        self._latest: dict[str, tuple[int, FilterEvent]] = {}

    def add(self, estimate: Estimate) -> None:
        """Take in the events of a step."""
        terrain = estimate.terrain
        if terrain in self._stated and terrain not in self._odd_as_stated:
            self._odd_as_stated[terrain] = bool(_odd_motion(estimate, self._track_width_m))
        for event in estimate.events:
            if event.kind not in HARMLESS:
                count, _ = self._latest.get(event.kind, (0, event))
                self._latest[event.kind] = (count + 1, event)

    def notes(self, estimate: Estimate) -> list[str]:
        """What makes the answers doubtful up to an estimate."""
        found = dict(self._latest)
        for event in lasting_events(estimate):
            if event.kind not in HARMLESS or event.kind == SILENT_GYROSCOPE:
                count, _ = found.get(event.kind, (0, event))
                found[event.kind] = (count + 1, event)
        lines = [_line(*one) for one in found.values()]
        if self._odd_as_stated.get(estimate.terrain):
            return lines
        return [*lines, *_odd_motion(estimate, self._track_width_m)]


def _line(count: int, event: FilterEvent) -> str:
    when = f"from {event.begin_s:.2f} to {event.end_s:.2f} s"
    times = f", the latest of {count} times" if count > 1 else ""
    return f"{event.text} ({when}{times})"


def _odd_motion(estimate: Estimate, track_width_m: float) -> list[str]:
    """That the robot moves or turns as no skid-steer robot does, by what the filter learned."""
    covariance = estimate.covariance
    sides = [Y_LEFT, Y_RIGHT]
    variance = float(covariance[sides, sides].sum() - 2 * covariance[Y_LEFT, Y_RIGHT])
    apart_m = float(estimate.mean[Y_LEFT] - estimate.mean[Y_RIGHT])
    ahead = float(estimate.mean[ALPHAS].mean())
    margin_m = SIGMAS * math.sqrt(max(variance, 0.0))
    narrow = apart_m + margin_m < NARROW * ahead * track_width_m
    wide = apart_m - margin_m > WIDE * ahead * track_width_m
    if not SLOW <= ahead <= FAST:
        seen = f"moves {ahead:.2g} m for each metre of tread travel, where 0.2 to 1.1 are usual"
        of = "poses or velocities"
    elif narrow or wide:
        width = apart_m / (ahead * track_width_m)
        seen = f"turns as if {width:.2g} track widths wide, where 1 to 3 are usual"
        of = "the gyroscope, or track_width"
    else:
        return []
    return [
        f"the robot {seen}: the unit, sign or axes of the tread speeds or of {of} are wrong, or "
        "treads are swapped, if this is no ice. Record a minute, and run `check` on it"
    ]
