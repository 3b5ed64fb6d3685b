"""Poses whose stamps are late: by a delay that is given, or by one that is certain.

Poses of the 19 recordings of data/motion that are not among the seven of the final evaluation
are up to 0.2 s early against the gyroscope and at most 0.03 s late.
"""

from dataclasses import replace

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.lag import Lag
from odometry.checks.stamps.explained_lags import explained_lags
from odometry.checks.stamps.late_positions import sure_lag
from odometry.checks.stamps.timing import (
    CERTAIN,
    TOGETHER,
    found_in,
    lags_of,
    pose_period_s,
    timing,
)
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.run import Run
from odometry.table import Table

FINDING, PARTS = "pose_late", {"yaw_late", "positions_late"}
LEAST_LATE_S, LEAST_LATE_PERIODS = 0.05, 0.25  # a shorter delay is not reported by `check` either
OF_GYROSCOPE = 0.5  # of a delay, by which treads may be late too; then it is the gyroscope's
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
        by their speed and that of treads that turn in step with it, and used only where that is
        certain.

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
    searched = config.watch_sensors and not config.causal
    if searched and (parted := _of_two_times(run)) is not None:
        return parted
    delay_s = _certain_delay_s(run) if searched else None
    if delay_s is not None:
        return _moved(run, pose, delay_s, f"by {delay_s:.3f} s against the gyroscope")
    of_positions = sure_lag(Evidence(run)) if searched and run.yaw_rate is not None else None
    if of_positions is None:
        return run, ()
    text = f"by {of_positions.seconds:.3f} s against the treads, which turn as the gyroscope does"
    return _moved(run, pose, of_positions.seconds, text)


def _of_two_times(run: Run) -> Moved | None:
    """The run with the part of its poses that is late, or early, alone moved; None without one."""
    if run.pose is None or run.yaw_rate is None:
        return None
    part = next((one for one in explained_lags(Evidence(run)) if one.name in PARTS), None)
    if part is None or part.mend is None:
        return None
    begin_s, end_s = run.pose.stamps_s[[0, -1]]
    text = f"{part.seen}: that part of the poses was taken at the stamps at which it was measured"
    return part.mend(run), (FilterEvent("late_poses", float(begin_s), float(end_s), text),)


def _certain_delay_s(run: Run) -> float | None:
    if run.pose is None or run.yaw_rate is None:
        return None
    evidence = Evidence(run)
    lags = lags_of(evidence)
    found = list(found_in(evidence, lags))
    if not found:
        return _short_delay_s(evidence, lags)
    late = [finding for finding in found if finding.name == FINDING]
    if not late or late[0].mend is None:
        return None
    mended = late[0].mend(run)
    if mended.pose is None or not any(one.name == FINDING for one in explained_lags(evidence)):
        return None  # yaw alone may be late
    delay_s = float(run.pose.stamps_s[0] - mended.pose.stamps_s[0])
    remains = any(finding.name == FINDING for finding in timing(Evidence(mended)))
    return delay_s if delay_s > 0 and not remains else None


def _short_delay_s(evidence: Evidence, lags: dict[tuple[str, str], Lag]) -> float | None:
    """A delay too short for `check`, which may come early as well as late, of late poses alone."""
    lag, of_treads = lags.get(("pose", "gyroscope")), lags.get(("treads", "gyroscope"))
    if lag is None or lag.together < TOGETHER:
        return None
    least_s = max(LEAST_LATE_S, LEAST_LATE_PERIODS * pose_period_s(evidence), CERTAIN * lag.sigma_s)
    if lag.seconds < least_s:
        return None
    if of_treads is not None and of_treads.seconds > OF_GYROSCOPE * lag.seconds:
        return None
    return lag.seconds


def _moved(run: Run, pose: Table, delay_s: float, text: str) -> Moved:
    columns = {**pose.columns, "t": pose.stamps_s - delay_s}
    event = FilterEvent(
        "late_poses",
        float(pose.stamps_s[0]),
        float(pose.stamps_s[-1]),
        f"the poses are late: {text}; they were taken at the stamps at which they were measured",
        (delay_s,),
    )
    return replace(run, pose=replace(pose, columns=columns)), (event,)
