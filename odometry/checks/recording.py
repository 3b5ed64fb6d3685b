"""Check a recording before anything is fitted to it."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import chain
from pathlib import Path

import numpy as np

from odometry.checks.confirmed import alone, confirmed
from odometry.checks.copies.computed_poses import computed_poses
from odometry.checks.copies.copied_columns import copied_columns
from odometry.checks.copies.one_encoder import one_encoder
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.consequences import without_consequences
from odometry.checks.findings.finding import CheckReport, Finding, Level, in_order
from odometry.checks.findings.unreadable import no_run_folder, unreadable
from odometry.checks.imu.attitude import attitude
from odometry.checks.imu.gyroscope import gyroscope
from odometry.checks.imu.gyroscope_by_poses import gyroscope_scale
from odometry.checks.imu.rate_wander import headings_wander
from odometry.checks.imu.turned_axes import turned_axes
from odometry.checks.imu.turning import turning
from odometry.checks.parts.part_changes import part_changes
from odometry.checks.poses.coarse_yaw import coarse_yaw
from odometry.checks.poses.compass_error import bent
from odometry.checks.poses.course import course
from odometry.checks.poses.pose_values import pose_values
from odometry.checks.poses.poses import pose_outages, poses
from odometry.checks.poses.poses_stay import poses_stay
from odometry.checks.poses.position_axes import position_axes
from odometry.checks.poses.smoothed_poses import smoothed_poses
from odometry.checks.poses.ticking_poses import ticking_poses
from odometry.checks.poses.yaw_drift import yaw_drifts
from odometry.checks.settings.settings import columns, settings
from odometry.checks.settings.settings_names import robot_sizes, settings_names
from odometry.checks.stamps.bursts import spread_bursts
from odometry.checks.stamps.changing_latency import changing_latency
from odometry.checks.stamps.clock_offsets import clock_offsets
from odometry.checks.stamps.empty_cells import empty_cells
from odometry.checks.stamps.explained_lags import explained_lags
from odometry.checks.stamps.gaps import gaps
from odometry.checks.stamps.held_treads import held_treads
from odometry.checks.stamps.interleaved import interleaved
from odometry.checks.stamps.joined_recordings import joined_recordings, without_seams
from odometry.checks.stamps.late_by_chance import spread_late, without_explained_lags
from odometry.checks.stamps.late_positions import late_positions, position_lag
from odometry.checks.stamps.one_column_late import one_column_late
from odometry.checks.stamps.repeated_stamps import repeated_stamps
from odometry.checks.stamps.set_back import set_back
from odometry.checks.stamps.short_delay import slightly_late
from odometry.checks.stamps.silent_rows import silent_rows
from odometry.checks.stamps.stamp_pace import stamp_pace
from odometry.checks.stamps.stamps import stamps, unreadable_stamps
from odometry.checks.stamps.stepping_clocks import stepping_clocks
from odometry.checks.treads.blocked_turns import blocked_turns
from odometry.checks.treads.equal_in_turns import equal_in_turns
from odometry.checks.treads.one_motion import one_motion
from odometry.checks.treads.opposed import opposed
from odometry.checks.treads.proportion import proportion
from odometry.checks.treads.scale_change import scale_change
from odometry.checks.treads.sides import sides
from odometry.checks.treads.smoothed_treads import smoothed_treads
from odometry.checks.treads.stuck_encoders import stuck_encoders
from odometry.checks.treads.tread_motion import tread_motion
from odometry.checks.treads.tread_samples import tread_samples
from odometry.checks.treads.treads import equal_treads, treads
from odometry.checks.treads.unsigned import unsigned
from odometry.checks.treads.wrapped_counts import unwrapped
from odometry.checks.unexplained.disagreement import sensors_disagree
from odometry.checks.unexplained.unrelated_turns import agreement, yaw_against_course
from odometry.checks.units.units import units
from odometry.checks.velocity.velocity import velocity
from odometry.errors import RunFolderError
from odometry.recording.run import Run

Check = Callable[[Evidence], Iterator[Finding]]

# Findings of one level are reported in this order: a cause before its consequences.
CHECKS: tuple[Check, ...] = (
    repeated_stamps,
    stamps,
    stamp_pace,
    set_back,
    interleaved,
    computed_poses,
    joined_recordings,
    pose_values,
    coarse_yaw,
    smoothed_poses,
    part_changes,
    agreement,
    yaw_against_course,
    turning,
    course,
    yaw_drifts,
    position_axes,
    robot_sizes,
    equal_treads,
    equal_in_turns,
    one_encoder,
    held_treads,
    one_column_late,
    unsigned,
    scale_change,
    units,
    bent,
    sides,
    proportion,
    tread_motion,
    opposed,
    blocked_turns,
    tread_samples,
    treads,
    smoothed_treads,
    gaps,
    silent_rows,
    changing_latency,
    stepping_clocks,
    clock_offsets,
    explained_lags,
    slightly_late,
    late_positions,
    poses,
    ticking_poses,
    gyroscope,
    headings_wander,
    gyroscope_scale,
    pose_outages,
    empty_cells,
    attitude,
    turned_axes,
    settings,
    columns,
    settings_names,
    one_motion,
)
LEAST_ROWS = 10


def check_recording(run: Run | str | Path) -> CheckReport:
    """What is odd about a recording: likeliest cause and remedy, most important first.

    Treads, gyroscope and poses measure one motion three times. Each relation between two of them
    (turn by turn, distance by distance, yaw by course, lag) is estimated robustly, and a sensor
    that is alone against two others is the likeliest to be wrong. What cannot be distinguished is
    said to be so.

    Parameters
    ----------
    run : Run or path of a run folder
        A folder that cannot be read is a finding, not an error.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> [finding.name for finding in odometry.check_recording(run).findings]
    []
    """
    if not isinstance(run, Run):
        if (nothing := no_run_folder(Path(run))) is not None:
            return CheckReport(Path(run), (nothing,))
        try:
            run = Run.read(run)
        except RunFolderError as error:
            return CheckReport(Path(str(run)), (unreadable(error),))
    shared, run, shared_late_s = spread_late(run, shared=True)
    refused = tuple(unreadable_stamps(run))
    if any(finding.level is Level.REFUSED for finding in refused):
        return CheckReport(run.folder, refused)
    if len(run.odometry) < LEAST_ROWS:
        return CheckReport(run.folder, refused, ("fewer than ten rows of odometry.csv",))
    with np.errstate(over="ignore", invalid="ignore"):
        bursts, run = spread_bursts(run)
        late, run, most_late_s = spread_late(run, shared=False)
        wrapped, run = unwrapped(run)
        copies, evidence = copied_columns(run)
        found = alone(evidence, [*refused, *_found(evidence)], _found)
        found = without_explained_lags(found, evidence, {**shared_late_s, **most_late_s})
        confirmed_ones = confirmed(evidence, without_consequences(without_seams(found)), _found)
        of_stamps = [*shared, *bursts, *late]
        said = [*wrapped, *copies, *without_consequences([*of_stamps, *confirmed_ones])]
        stays = list(poses_stay(evidence, said))
        of_velocity = list(velocity(evidence))  # which no other check uses
    findings = in_order([*said, *stays, *of_velocity])
    return CheckReport(run.folder, findings, tuple(_skipped(evidence)))


def _found(evidence: Evidence) -> Iterator[Finding]:
    """All findings; where one tread was lost, nothing else is said of that time."""
    found = list(stuck_encoders(evidence))
    yield from found
    spans = [span for finding in found for span in finding.spans_s]
    left = replace(evidence, left_out_s=(*evidence.left_out_s, *spans)) if found else evidence
    for finding in chain.from_iterable(check(left) for check in CHECKS):
        found.append(finding)
        yield finding
    yield from sensors_disagree(left, found)


def _skipped(evidence: Evidence) -> Iterator[str]:
    if evidence.positions_measured is None:
        yield "no measured poses: distances, yaw and delays were not checked against them"
    elif not evidence.yaw_measured:
        delays = "" if position_lag(evidence) is not None else " and delays"
        yield f"poses without yaw: headings{delays} were not checked against them"
    if evidence.yaw_rate is None:
        yield "no gyroscope: turns were not checked against it"
