"""Notes on a filter after the end of its run."""

import math

import numpy as np

from odometry.estimation.estimate import Estimate
from odometry.estimation.filter_event import FilterEvent, gap_event
from odometry.estimation.filter_start import REINITIALISED
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
from odometry.estimation.watches.sensor_watch import SensorWatch
from odometry.recording.run import Run
from odometry.replays.estimates import Replay
from odometry.replays.gyroscope_bias import bias_events

REFUSED_SHARE = 0.03  # of the poses; fewer are usual
LAST_POSES = 20  # whose median distance is the error at the end
OFF_AT_END = "off_at_end"


def run_end_events(run: Run, replay: Replay) -> tuple[FilterEvent, ...]:
    """Events that last at the end, and those that only the whole run shows."""
    found = [*lasting_events(replay.estimates[-1]), *_refused(replay)]
    found += bias_events(replay)
    found += _off_at_end(run, replay)
    return tuple(found)


def lasting_events(last: Estimate) -> list[FilterEvent]:
    """Events that have begun and not ended at an estimate."""
    lasting = () if last.watch is None else ongoing(last.watch, last.stamp_s)
    return [*lasting, *_heading(last)]


def ongoing(watch: SensorWatch, stamp_s: float) -> tuple[FilterEvent, ...]:
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


def _heading(last: Estimate) -> list[FilterEvent]:
    if last.course is None:
        return []
    text = (
        "the heading cannot be determined: no yaw is measured, and the course of the "
        f"{last.course.count} positions over {last.course.travel_m:.1f} m of dead reckoning does "
        "not determine it; the estimate follows the positions, do not use its yaw"
    )
    return [FilterEvent("heading_unknown", last.course.begin_s, last.stamp_s, text)]


def _refused(replay: Replay) -> list[FilterEvent]:
    """Refusals that did not end with a new start."""
    measured = int(np.isfinite(replay.innovations_squared).sum())
    anew = [event for event in replay.events if event.kind == REINITIALISED]
    refused = measured - int(replay.accepted.sum())
    refused -= int(sum(event.values[0] for event in anew))
    if refused <= REFUSED_SHARE * measured:
        return []
    begin_s, end_s = replay.stamps_s[[0, -1]].tolist()
    text = f"{refused} of {measured} poses were refused as outliers"
    return [FilterEvent("refused_poses", begin_s, end_s, text)]


def _off_at_end(run: Run, replay: Replay) -> list[FilterEvent]:
    """The estimate ends farther from the poses than the ideal differential drive.

    And is off by more than these poses scatter: where the robot stands, both are in their noise.
    """
    if run.pose is None or replay.estimates[-1].course is not None:
        return []
    measured = run.pose.stack("x", "y")
    stamps_s = run.pose.stamps_s
    estimate = replay.trajectory()
    usable = np.isfinite(measured).all(axis=1) & estimate.covers(stamps_s)
    last = np.flatnonzero(usable)[-LAST_POSES:]
    if len(last) < LAST_POSES:
        return []
    ideal = replay.differential_drive(run.robot.track_width)
    ours, of_ideal = (
        one.at(stamps_s[last]).poses[:, :2] - measured[last] for one in (estimate, ideal)
    )
    ours_m, ideal_m = (float(np.median(np.hypot(*off.T))) for off in (ours, of_ideal))
    in_noise = np.hypot(*ours.mean(axis=0)) <= np.sqrt(ours.var(axis=0).sum())
    if ours_m <= ideal_m or in_noise:
        return []
    text = (
        f"the estimate ends {ours_m:.2f} m from the last {LAST_POSES} poses, the ideal drive "
        f"{ideal_m:.2f} m: do not trust the estimate at the end of this run"
    )
    return [FilterEvent(OFF_AT_END, float(stamps_s[last[0]]), float(replay.stamps_s[-1]), text)]
