"""What is said of a latency that changes within a recording."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import TREADS, Mend, restamped, sooner
from odometry.checks.stamps.late_stamps import MADE_UP, NAMES, are_even
from odometry.checks.stamps.latencies import Changing, changing
from odometry.checks.stamps.stepping_clocks import stepping_clocks
from odometry.checks.stamps.timing import drifting, lags_of
from odometry.checks.statistics.latency_course import LINE, STEP, LatencyCourse

POINTS = 5  # of a course that are stated
SLIP = "; or the robot follows its treads later in parts (soft terrain, slip)"
UNDECIDED = "; no third sensor decides between these"


def changing_latency(evidence: Evidence) -> Iterator[Finding]:
    """A latency that steps, drifts or wanders, where no other check says how."""
    found = changing(evidence)
    if found is None or runs_apart(evidence, found):
        return
    if found.course.kind != STEP or not any(stepping_clocks(evidence)):
        yield _finding(evidence, found)


def runs_apart(evidence: Evidence, found: Changing) -> bool:
    """Whether it grows evenly, and enough for clocks that run apart."""
    return found.course.kind == LINE and bool(drifting(evidence, lags_of(evidence)))


def _finding(evidence: Evidence, found: Changing) -> Finding:
    course, pair = found.course, found.pair
    late, early = (NAMES[name] for name in pair)
    who = " or of ".join(NAMES[name] for name in found.suspects)
    more = UNDECIDED * (not found.odd)
    if "treads" in found.suspects:
        more += SLIP + MADE_UP * are_even(evidence)
    steps = course.kind == STEP
    is_clock = steps and _of_two_files(evidence, pair)
    clock = "a clock that was set while recording, or " * is_clock
    cause = (
        f"Stamps of {who} step: {clock}a buffer that grew or was emptied{more}"
        if steps
        else f"Stamps of {who} are late by a time that changes: a computer that falls behind, a "
        f"buffer that fills{_evenly(found)}{more}"
    )
    moment_s = evidence.run_time_s(course.moment_s)
    return Finding(
        "clock_set" if is_clock else "latency_changes",
        Level.WARNING,
        f"the lag of {late} behind {early} {_course_words(evidence, course)}",
        cause,
        "Stamp each sensor when it measures, by one clock; or use a part with one latency (--from, "
        "--to)",
        ((moment_s, moment_s),) if steps else (),
        mend=mend_of(evidence, found),
    )


def _of_two_files(evidence: Evidence, pair: tuple[str, str]) -> bool:
    return "pose" in pair or evidence.gyroscope_file != "odometry.csv"


def _evenly(found: Changing) -> str:
    course = found.course
    if course.kind != LINE:
        return ""
    rate = float(np.ptp(found.late_s(course.stamps_s)) / np.ptp(course.stamps_s))
    grows = found.late_s(course.stamps_s[-1:])[0] > found.late_s(course.stamps_s[:1])[0]
    way = f"too {'fast' if grows else 'slow'}" if found.odd else "off"
    return f", or its clock runs {100 * rate:.2g} % {way}"


def _course_words(evidence: Evidence, course: LatencyCourse) -> str:
    off = f"(+- {np.median(course.sigmas_s):.2f} s)"
    if course.kind == STEP:
        before_s, after_s = course.seconds[[0, -1]]
        at_s = evidence.run_time_s(course.moment_s)
        return (
            f"steps by {after_s - before_s:+.2f} s, from {before_s:+.2f} to {after_s:+.2f} s {off},"
            f" at about {at_s:.0f} s of run time"
        )
    points_s = np.linspace(course.stamps_s[0], course.stamps_s[-1], POINTS)
    stated = (
        f"{seconds:+.2f} s at {evidence.run_time_s(at_s):.0f} s"
        for at_s, seconds in zip(points_s.tolist(), course.at(points_s).tolist(), strict=True)
    )
    return f"changes: {', '.join(stated)} of run time {off}"


def mend_of(evidence: Evidence, found: Changing) -> Mend:
    """The stamps of the odd sensor less the course of its latency."""
    name = found.sensor
    if name == "pose":
        return restamped("pose", found.late_s)
    if name == "gyroscope" and evidence.gyroscope_file == "imu.csv":
        return restamped("imu", found.late_s)
    return sooner(TREADS if name == "treads" else ("gyro_z",), found.late_s)
