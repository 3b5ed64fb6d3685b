"""Poses whose stamps are late: by a delay that is given, or by one that is certain."""

from dataclasses import replace

from odometry.checks.evidence import Evidence
from odometry.checks.timing import timing
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.filter_event import FilterEvent
from odometry.run import Run
from odometry.table import Table

FINDING = "pose_late"
Moved = tuple[Run, tuple[FilterEvent, ...]]


def without_pose_delay(run: Run, config: IcrEkfConfig) -> Moved:
    """The run with the stamps of pose.csv at which its poses were measured.

    Parameters
    ----------
    run : Run
    config : IcrEkfConfig
        `pose_delay_s` says by how much the stamps are late. With 0, and with `watch_sensors`, it
        is searched for: where the run has a gyroscope, by the correlation of its yaw rate with
        that of the poses (`odometry.checks.timing`), and believed only where that is certain and
        leaves no delay once it is undone.

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
    delay_s = _certain_delay_s(run) if config.watch_sensors else None
    if delay_s is None:
        return run, ()
    return _moved(run, pose, delay_s, f"by {delay_s:.3f} s against the gyroscope")


def _certain_delay_s(run: Run) -> float | None:
    if run.pose is None or run.yaw_rate is None:
        return None
    late = [finding for finding in timing(Evidence(run)) if finding.name == FINDING]
    if not late or late[0].mend is None:
        return None
    mended = late[0].mend(run)
    if mended.pose is None:
        return None
    delay_s = float(run.pose.stamps_s[0] - mended.pose.stamps_s[0])
    remains = any(finding.name == FINDING for finding in timing(Evidence(mended)))
    return delay_s if delay_s > 0 and not remains else None


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
