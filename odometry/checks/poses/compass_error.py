"""Yaw that is bent by its own direction, and positions that are longer one way than another."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import middle_yaw
from odometry.checks.evidence.motion import Motion
from odometry.checks.evidence.scatter import scattered
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.undo import Mend, changed
from odometry.checks.poses.position_frame import position_frame
from odometry.checks.statistics.relation import Relation, relation
from odometry.checks.turns.heading_spans import HeadingSpans, heading_spans
from odometry.recording.run import Run

SPANS_S = (5.0, 1.5)
LEAST_BEND_RAD = np.radians(6)
MOST_BEND_RAD = np.radians(60)
CERTAIN = 6.0  # standard deviations
LEFT = 0.5  # share of the residual that is left once yaw is straightened
OCTANTS = 5  # of the compass, in which the robot was: else a bend is a drift
ROUNDS = 20
LEAST_WINDOWS = 30
STRETCHED = 1.2  # ratio of scales; recordings with good poses have up to 1.1
OFF_AXIS = 20.0  # degrees from an axis of the frame, beyond which its axes have no scale each
HALF = 0.6  # of the stretch, that each half of the recording has
SHARP = 0.3  # turn in a window [rad] from which its distance says little
TIGHT = 0.9  # correlation
# Windows within so much of either axis of a stretch. Where none is, it is extrapolated: on lanes
# over two terrains, whose courses stay within 60 degrees.
NEAR_RAD, LEAST_NEAR = np.radians(30), 10
# By all windows at once; 1.05 at most in real recordings whose deviation is as small
SLIGHTLY, SLIGHT_CERTAIN, SLIGHT_SD = 1.06, 5.0, 0.02


def bent(evidence: Evidence) -> Iterator[Finding]:
    """A compass on iron, and a projection of the Earth that was forgotten."""
    yield from _yaw_bent(evidence)
    much = list(_stretched(evidence))
    yield from much or _slightly_stretched(evidence)


def _yaw_bent(evidence: Evidence) -> Iterator[Finding]:
    """Yaw less the gyroscope's heading goes with the sine of the heading.

    These are the coefficients B and C of the deviation of a compass.
    """
    spans = heading_spans(evidence, *SPANS_S)
    if spans is None or not _all_round(spans):
        return
    turns = spans.gyroscope_rad, spans.lasts_s
    plain = relation(spans.pose_rad, *turns)
    sine, cosine = 0.0, 0.0
    found: Relation | None = None
    for _ in range(3):  # of the true heading, that is known ever better
        heading = _straightened(spans.yaw_rad, sine, cosine)
        ends = (np.diff(way(heading), axis=1)[:, 0] for way in (np.sin, np.cos))
        found = relation(spans.pose_rad, *turns, *ends)
        if found is None:
            return
        sine, cosine = found.coefficients[2:]
    size = float(np.hypot(sine, cosine))
    if plain is None or found is None or not LEAST_BEND_RAD < size < MOST_BEND_RAD:
        return
    if size < CERTAIN * found.sigmas[2:].max() or not found.distinct:
        return
    before, after = (_size(of.residuals) for of in (plain, found))
    if after > LEFT * before:
        return
    yield Finding(
        "yaw_bent",
        Level.WARNING,
        f"yaw of pose.csv deviates from the gyroscope by up to {np.degrees(size):.0f} degrees, "
        f"with the direction in which the robot points (they differ by {np.degrees(before):.1f} "
        f"degrees in {np.median(spans.lasts_s):.2g} s, without this by {np.degrees(after):.1f})",
        "Yaw is distorted by magnetism: iron of the robot deflects its compass",
        "Calibrate the compass on the robot (hard iron), or leave yaw empty",
        mend=changed("pose", "yaw", lambda yaw: _straightened(yaw, sine, cosine)),
    )


def _both_ways(off_rad: FloatArray) -> bool:
    """Whether courses (K,) less an axis are often along it and often across it."""
    along, across = np.abs(np.cos(off_rad)), np.abs(np.sin(off_rad))
    return all(int(np.sum(of > np.cos(NEAR_RAD))) >= LEAST_NEAR for of in (along, across))


def _all_round(spans: HeadingSpans) -> bool:
    octants = np.floor((spans.yaw_rad[:, 0] % (2 * np.pi)) / (np.pi / 4)).astype(int)
    counts = np.bincount(np.clip(octants, 0, 7), minlength=8)
    return int(np.sum(counts > 0.02 * len(spans))) >= OCTANTS


def _straightened(yaw_rad: FloatArray, sine: float, cosine: float) -> FloatArray:
    """Heading h of which yaw = h + sine sin h + cosine cos h, by repeated substitution."""
    heading = yaw_rad
    if sine == 0 == cosine:
        return heading
    for _ in range(ROUNDS):
        before, heading = heading, yaw_rad - sine * np.sin(heading) - cosine * np.cos(heading)
        if (heading == before).all():
            break
    return heading


def _size(residuals: FloatArray) -> float:
    return float(np.sqrt(np.nanmean(residuals**2)))


def _stretched(evidence: Evidence) -> Iterator[Finding]:
    """Distance for each metre of travel that goes with twice the course."""
    m = evidence.motion
    if len(m) < LEAST_WINDOWS or scattered(m, evidence.run.robot.track_width):
        return
    if evidence.yaw_measured and evidence.heading is None:
        return  # yaw and course part: a sensor far from the centre, or yaw is another
    sharp = np.abs(m.difference_m) > np.abs(m.mean_m)
    sharp |= np.abs(evidence.turn_rad(m)) > SHARP
    distance_m = np.where(sharp, np.nan, m.distance_m)
    plain, found = relation(distance_m, np.abs(m.mean_m)), _by_course(m, distance_m)
    if plain is None or found is None or found.measured < LEAST_WINDOWS or not found.distinct:
        return
    share = float(np.hypot(*found.coefficients[1:]) / found.slope)
    ratio = (1 + share) / (1 - share) if 0 < share < 0.8 else 1.0
    sure = share * found.slope > CERTAIN * found.sigmas[1:].max() and found.correlation > TIGHT
    if ratio < STRETCHED or not sure or _size(found.residuals) > 0.8 * _size(plain.residuals):
        return
    along_rad = float(np.arctan2(found.coefficients[2], found.coefficients[1]) / 2)
    off_rad = m.course_rad[np.isfinite(distance_m)] - along_rad
    if not (_both_ways(off_rad) and _lasts(m, distance_m, found)):
        return
    by_yaw = _ratio_by_yaw(evidence, along_rad, sharp)
    if by_yaw is not None and by_yaw < 1 + HALF * (ratio - 1):
        return
    off_axis = abs((np.degrees(along_rad) + 45) % 90 - 45) > OFF_AXIS
    turned = (
        ", before the frame was turned; or its axes are not at right angles" if off_axis else ""
    )
    yield Finding(
        "positions_stretched",
        Level.WARNING,
        f"the robot moves {ratio:.2f} times as far for each metre of tread travel where it drives "
        f"along {np.degrees(along_rad):.0f} degrees of the frame of pose.csv as across it",
        "Positions are stretched along one axis: longitude was taken for as long as latitude "
        f"(without the cosine of the latitude), or x and y have different scales{turned}",
        "Convert positions by a projection (UTM, east and north in metres)",
        mend=_shortened(along_rad, ratio),
    )


def _slightly_stretched(evidence: Evidence) -> Iterator[Finding]:
    """Less of it, on drives that tell it from slopes, arms and a yaw that is turned."""
    if evidence.yaw_measured and evidence.heading is None:
        return
    frame = position_frame(evidence)
    if frame is None or not SLIGHTLY < frame.ratio < STRETCHED or frame.ratio_sd > SLIGHT_SD:
        return
    if frame.ratio - 1 < SLIGHT_CERTAIN * frame.ratio_sd:
        return
    yield Finding(
        "positions_stretched",
        Level.WARNING,
        f"the robot moves {frame.ratio:.3f} +- {frame.ratio_sd:.3f} times as far for each metre of "
        f"tread travel along {np.degrees(frame.axis_rad):.0f} degrees of the frame of pose.csv as "
        "across it, on all headings, beside what slopes and turns do",
        "Positions are stretched along one axis (longitude by the cosine of another latitude), or "
        "their axes are not at right angles; or the terrain, and with it the slip, is another "
        "where the robot drives along this axis",
        "Measure a known distance along both axes, and convert positions by a projection (UTM)",
        mend=_shortened(frame.axis_rad, frame.ratio),
    )


def _by_course(motion: Motion, distance_m: FloatArray) -> Relation | None:
    travel_m = np.abs(motion.mean_m)
    ways = (travel_m * way(2 * motion.course_rad) for way in (np.cos, np.sin))
    return relation(distance_m, travel_m, *ways)


def _ratio_by_yaw(evidence: Evidence, along_rad: float, sharp: BoolArray) -> float | None:
    """The ratio of both scales where yaw says how far the robot drove along each axis."""
    m, heading = evidence.motion, evidence.heading
    if heading is None:
        return None
    scales = []
    for axis_rad in (along_rad, along_rad + np.pi / 2):
        moved_m = m.moved_m @ np.array([np.cos(axis_rad), np.sin(axis_rad)])
        driven_m = m.mean_m * np.cos(middle_yaw(m, heading) + heading.offset_rad - axis_rad)
        scales.append(relation(np.where(sharp, np.nan, moved_m), driven_m))
    along, across = scales
    if along is None or across is None or not across.certain():
        return None
    return abs(along.slope / across.slope)


def _lasts(motion: Motion, distance_m: FloatArray, whole: Relation) -> bool:
    """Whether both halves of the recording, where they suffice, give the scale of the whole."""
    known = np.flatnonzero(np.isfinite(distance_m))
    halves = [_by_course(motion.rows(rows), distance_m[rows]) for rows in np.array_split(known, 2)]
    size = float(np.sum(whole.coefficients[1:] ** 2))
    shares = [
        float(half.coefficients[1:] @ whole.coefficients[1:]) / size
        for half in halves
        if half is not None and half.distinct
    ]
    return len(shares) > 0 and min(shares) > HALF


def _shortened(along_rad: float, ratio: float) -> Mend:
    def mend(run: Run) -> Run:
        assert run.pose is not None  # noqa: S101 - the cause is one of poses
        cos, sin = float(np.cos(along_rad)), float(np.sin(along_rad))
        excess = (1 - 1 / ratio) * (run.pose["x"] * cos + run.pose["y"] * sin)
        run = changed("pose", "x", lambda x: x - excess * cos)(run)
        return changed("pose", "y", lambda y: y - excess * sin)(run)

    return mend
