"""Poses whose stamps are late: by a delay that is given, or by one that is certain."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.undo import restamped
from odometry.checks.stamps.explained_lags import explained_lags
from odometry.checks.stamps.late_positions import path_delay_s
from odometry.checks.stamps.latencies import PAIRS, Changing, changing
from odometry.checks.stamps.short_delay import short_delay
from odometry.checks.stamps.timing import found_in, lags_of, timing
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.preparation.row_rates import EARLY_S
from odometry.recording.run import Run, with_stamps
from odometry.tables.table import Table

FINDING, PARTS = "pose_late", {"yaw_late", "positions_late"}
Moved = tuple[Run, tuple[FilterEvent, ...]]


def without_pose_delay(run: Run, config: IcrEkfConfig) -> Moved:
    """The run with the stamps of pose.csv at which its poses were measured.

    Parameters
    ----------
    run : Run
    config : IcrEkfConfig
        `pose_delay_s` is the delay of the stamps. With 0, and with `watch_sensors`, it
        is searched for unless `causal`: where the run has a gyroscope, by the correlation of its
        yaw rate with that of the poses (`odometry.checks.stamps.timing`), of positions without yaw
        by the shape of their path (`odometry.positions.timing`), and used only where that is
        certain. Of positions and yaw that are of two times (`yaw_late`, `positions_late` of the
        check) the part that is late, or early, is moved alone.

    Returns
    -------
    Run
    tuple of FilterEvent
        One where stamps were changed.
    """
    pose, given_s = run.pose, config.pose_delay_s
    if pose is None or not len(pose):
        return run, ()
    if given_s:
        return _moved(run, pose, given_s, f"by {given_s:.3f} s, as given")
    if not config.watch_sensors or config.causal or run.yaw_rate is None:
        return run, ()
    return _searched(run, pose)


def _searched(run: Run, pose: Table) -> Moved:
    evidence = Evidence(run)
    change = changing(evidence)
    if change is not None and change.pair == PAIRS[0]:
        return _along(run, pose, change)
    named = list(explained_lags(evidence))
    for part in named:
        if part.name in PARTS and part.mend is not None:
            text = f"{part.seen}; that part was taken at the stamps at which it was measured"
            return part.mend(run), (_event(pose, text),)
    delay_s = _certain_delay_s(evidence, {finding.name for finding in named})
    if delay_s is not None:
        return _moved(run, pose, delay_s, f"by {delay_s:.3f} s against the gyroscope")
    late_s = path_delay_s(evidence)
    if late_s <= 0:
        return run, ()
    text = f"by {late_s:.3f} s against the path of treads and gyroscope"
    return _moved(run, pose, late_s, text)


def _along(run: Run, pose: Table, change: Changing) -> Moved:
    """Stamps less a latency that changes, where the treads show that it is that of the poses.

    The usual lead of poses before the gyroscope, EARLY_S, is kept.
    """
    if change.odd != "pose":
        return run, ()

    def late_s(stamps_s: FloatArray) -> FloatArray:
        return change.late_s(stamps_s) + EARLY_S

    by_s = late_s(pose.stamps_s)
    text = (
        f"the poses are late by a time that changes, {by_s.min():.3f} to {by_s.max():.3f} s beside "
        "the gyroscope; they were taken at the stamps at which they were measured"
    )
    return restamped("pose", late_s)(run), (_event(pose, text, float(np.median(by_s))),)


def _certain_delay_s(evidence: Evidence, named: set[str]) -> float | None:
    """The delay of all of the poses; None where the check, which `named` others, does not know."""
    run, lags = evidence.run, lags_of(evidence)
    found = list(found_in(evidence, lags))
    if not found:
        short = short_delay(evidence, lags)
        return None if short is None else short.seconds
    late = [finding for finding in found if finding.name == FINDING]
    if not late or late[0].mend is None or FINDING not in named:
        return None
    mended = late[0].mend(run)
    if run.pose is None or mended.pose is None:
        return None
    delay_s = float(run.pose.stamps_s[0] - mended.pose.stamps_s[0])
    remains = any(finding.name == FINDING for finding in timing(Evidence(mended)))
    return delay_s if delay_s > 0 and not remains else None


def _moved(run: Run, pose: Table, delay_s: float, text: str) -> Moved:
    taken = "they were taken at the stamps at which they were measured"
    event = _event(pose, f"the poses are late: {text}; {taken}", delay_s)
    return with_stamps(run, "pose", pose.stamps_s - delay_s), (event,)


def _event(pose: Table, text: str, *delay_s: float) -> FilterEvent:
    begin_s, end_s = pose.stamps_s[[0, -1]].tolist()
    return FilterEvent("late_poses", begin_s, end_s, text, delay_s)
