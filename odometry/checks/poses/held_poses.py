"""Poses that repeat the one before, or follow it at once: a lost reference, stamps of arrival."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, counted
from odometry.windows.recorded.spans import constant_spans, runs_of, within

FROZEN_S = 1.5
FILTERED_S = 3.0  # a median of 15 poses at 10 Hz holds them for 1.5 s where a robot slips
HALF = 0.5  # share of the held positions, from which their yaw is no held one
FROZEN_M = 5.0  # that the robot drives meanwhile by its treads, however slowly
SHORT, MOVING = 0.25, 0.2  # of the usual period, and of the ordinary fastest tread speed
BURSTS, LEAST_BURSTS = 0.05, 20  # share of the poses in motion, and their number
ALONG = (0.1, 2.0)  # of the travel of the faster tread: less is no motion, more is noise
LEAP, TIMES = 0.4, 5.0  # of a usual step, and of the travel of the treads in so short a time
OFTEN = 10  # stretches of repeated poses, from which the log repeats by habit
REPEATED = 0.3  # share of poses equal to the one before while the treads move


@dataclass(frozen=True)
class PoseTrack:
    """M measured positions in the order of time.

    Attributes
    ----------
    stamps_s : (M,)
    positions : (M, 2)
    travel_m : (M,)
        Of the treads, up to each pose.
    """

    stamps_s: FloatArray
    positions: FloatArray
    travel_m: FloatArray


def frozen_poses(evidence: Evidence, track: PoseTrack) -> Iterator[Finding]:
    """Times in which poses stay and the treads go on."""
    period_s = float(np.median(np.diff(track.stamps_s)))
    spans = constant_spans(track.stamps_s, track.positions, max(FROZEN_S, 3 * period_s))
    driven_m = np.interp(spans, track.stamps_s, track.travel_m)
    moved_m = driven_m[:, 1] - driven_m[:, 0] if len(spans) else np.empty(0)
    odd = moved_m > 0.15 * evidence.fastest_m_s * (spans[:, 1] - spans[:, 0])
    odd |= _along_m(evidence, spans) > FROZEN_M
    spans, moved_m = spans[odd], moved_m[odd]
    if not len(spans):
        return
    lasts_s = float(np.sum(spans[:, 1] - spans[:, 0]))
    yield Finding(
        "frozen_poses",
        Level.WARNING,
        f"poses repeat the same position for {lasts_s:.1f} s in {counted(len(spans), 'place')} "
        f"(first at {evidence.run_time_s(spans[0, 0]):.1f} s) while the treads travel "
        f"{moved_m.sum():.2f} m",
        _cause(evidence, spans),
        "Leave these poses empty",
        tuple((evidence.run_time_s(b), evidence.run_time_s(e)) for b, e in spans),
    )


def _cause(evidence: Evidence, spans_s: FloatArray) -> str:
    """Why poses stay in the times (K, 2)."""
    if not _yaw_goes_on(evidence, spans_s):
        return (
            "Poses are frozen: the reference was lost and its last value went on; or the robot "
            "was stuck while its treads turned"
        )
    held = "Positions are held while yaw goes on: their receiver was lost, or they end at a border"
    short = np.diff(spans_s, axis=1).max() < FILTERED_S
    return f"{held}, or a filter holds them (a median) while the robot slips" if short else held


def _yaw_goes_on(evidence: Evidence, spans_s: FloatArray) -> bool:
    """Whether the yaw of the poses changes from row to row in most of the times (K, 2)."""
    pose = evidence.run.pose
    if pose is None or not evidence.yaw_measured:
        return False
    inside = within(pose.stamps_s, spans_s)
    return bool(np.mean(np.diff(pose["yaw"][inside]) != 0) > HALF)


def pose_bursts(evidence: Evidence, track: PoseTrack) -> Iterator[Finding]:
    """Poses that follow the one before at once, and lie as far from it as usual."""
    lasts_s, driven_m = np.diff(track.stamps_s), np.diff(track.travel_m)
    moved_m = np.hypot(*np.diff(track.positions, axis=0).T)
    short = lasts_s < SHORT * np.median(lasts_s)
    speed_m_s = driven_m / lasts_s
    moving = speed_m_s > MOVING * evidence.fastest_m_s
    at_once, usual = short & moving, ~short & moving
    if at_once.sum() < max(LEAST_BURSTS, BURSTS * moving.sum()) or usual.sum() < LEAST_BURSTS:
        return
    step_m = float(np.median(moved_m[usual]))
    along = ALONG[0] < step_m / max(float(np.median(driven_m[usual])), 1e-9) < ALONG[1]
    leap_m = float(np.median(moved_m[at_once]))
    if along and leap_m > LEAP * step_m and leap_m > TIMES * float(np.median(driven_m[at_once])):
        yield Finding(
            "pose_bursts",
            Level.WARNING,
            f"{100 * at_once.sum() / moving.sum():.0f} % of the poses follow the one before within "
            f"{lasts_s[at_once].max():.2g} s, and lie {leap_m:.2g} m from it, as in a usual step",
            "Stamps of pose.csv are those of arrival: poses were sent in bursts (buffered), not "
            "when they were measured",
            "Use the stamps of the sensor (header time), or spread the rows evenly",
        )


def _along_m(evidence: Evidence, spans_s: FloatArray) -> FloatArray:
    """Way (K,) of the middle between the treads in each of the times (K, 2), without sign."""
    speed_m_s = np.abs(evidence.speeds_m_s.mean(axis=1))
    way_m = np.append(0.0, np.cumsum(speed_m_s[:-1] * np.diff(evidence.stamps_s)))
    return np.asarray(np.diff(np.interp(spans_s, evidence.stamps_s, way_m), axis=1)[:, 0])


def repeated_poses(track: PoseTrack) -> Iterator[Finding]:
    """Many poses that repeat the one before, again and again: no single loss of the reference."""
    driven_m = np.diff(track.travel_m)
    moving = driven_m > 0.2 * np.quantile(driven_m, 0.9)
    same = (np.diff(track.positions, axis=0) == 0).all(axis=1)
    if moving.sum() < 20:
        return
    share = float(same[moving].mean())
    stretches = [(first, last) for first, last in runs_of(same) if moving[first:last].any()]
    if share > REPEATED and len(stretches) > OFTEN:
        longest = int(np.max(np.diff(stretches, axis=1)))
        yield Finding(
            "repeated_poses",
            Level.WARNING,
            f"{100 * share:.0f} % of the poses repeat the one before while the treads move (up to "
            f"{counted(longest, 'time')})",
            "Poses are repeated: the reference is slower than its log, or reports only once the "
            "robot has moved by so much; the log holds the last value (frozen between updates)",
            "Keep the rows in which the pose is new",
        )
