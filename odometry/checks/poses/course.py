"""Whether the yaw of pose.csv points where its positions go."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import CONSISTENT, Heading, headings
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.findings.undo import Mend, changed, times, yaw_plus
from odometry.checks.poses.course_offsets import offset_beside_arm_rad, parts_apart
from odometry.checks.poses.position_frame import position_frame
from odometry.checks.turns.turn_signs import Sense, gyroscope_sense, pose_sense

OFF_RAD = np.radians(15)  # a lateral ICR may be less
# Beside what turns and slopes move a robot aside; 1.8 degrees at most in the real recordings of
# which it is known within one
LEAST_OFF_RAD = np.radians(3)
SURELY = 4.0  # standard deviations
LEAST_FORWARDS = 0.5
FULL_DEGREES, FULL_GON = 360.0, 400.0
WRAP, LEAST_WRAPS = 0.7, 3  # of a full turn; a robot turns less from row to row
OTHER_TURN = 0.05  # by which the step of a wrap differs, in which the robot turns a little
NEAR_90 = 5.0  # degrees: farther off, a sensor may be turned by another angle


def course(evidence: Evidence) -> Iterator[Finding]:
    """Yaw in degrees, yaw off by a constant, positions mirrored."""
    if evidence.yaw_in_degrees:
        yield _in_degrees(evidence.run.pose["yaw"] if evidence.run.pose else np.empty(0))
    heading = evidence.heading
    if heading is None:
        return
    if heading.reading == "radians":
        yield from _offset(evidence, heading)
    elif _turns_agree(evidence):
        yield _finding(
            "positions_mirrored",
            "the course of pose.csv turns against its own yaw, which agrees with the other "
            f"sensors (concentration {heading.concentration:.2f})",
            "The positions are mirrored: x and y are swapped (north before east), or one of them "
            "has the wrong sign",
            "Exchange x and y, or negate y",
            times("pose", -1.0, "y"),
        )


def _in_degrees(yaw: FloatArray) -> Finding:
    """Yaw in degrees, or in another unit: where it wraps it steps by a full turn."""
    steps = np.abs(np.diff(yaw[np.isfinite(yaw)]))
    wraps = steps[steps > WRAP * FULL_DEGREES]
    turn = float(np.median(wraps)) if len(wraps) else FULL_DEGREES
    if turn < FULL_DEGREES and len(wraps) < LEAST_WRAPS:
        turn = FULL_DEGREES  # a jump over the border is less; none is more
    if abs(turn / FULL_GON - 1) < OTHER_TURN:
        turn = FULL_GON
    seen = f"yaw of pose.csv goes from {np.nanmin(yaw):.1f} to {np.nanmax(yaw):.1f}"
    if abs(turn / FULL_DEGREES - 1) > OTHER_TURN:
        return _finding(
            "yaw_in_degrees",
            f"{seen}, and steps by {turn:.0f} where it wraps",
            f"Yaw counts {turn:.0f} to a full turn, not {FULL_DEGREES:.0f}"
            + " (it is in gon)" * (turn == FULL_GON),
            f"Convert: yaw times 2 pi / {turn:.0f}",
            times("pose", 2 * np.pi / turn, "yaw"),
        )
    return _finding(
        "yaw_in_degrees",
        f"{seen}; its turns and its course fit only when read as degrees",
        "Yaw is in degrees",
        "Convert yaw to radians",
        changed("pose", "yaw", np.radians),
    )


def _turns_agree(evidence: Evidence) -> bool:
    """Whether measured turns are those of the gyroscope, else of the treads."""
    by_gyroscope = evidence.pose_turn_by_gyroscope
    known = by_gyroscope is not None and by_gyroscope.correlation > 0.5 and by_gyroscope.certain()
    if by_gyroscope is not None and known and gyroscope_sense(evidence) is not Sense.OPPOSITE:
        return by_gyroscope.slope > 0
    return pose_sense(evidence) is Sense.AGREES


def _offset(evidence: Evidence, heading: Heading) -> Iterator[Finding]:
    offset, degrees = heading.offset_rad, float(np.degrees(heading.offset_rad))
    beside_arm = offset_beside_arm_rad(evidence, heading)
    arm_rad = float(np.arctan(evidence.arm_share)) if beside_arm is None else 0.0
    if abs(offset if beside_arm is None else beside_arm) < OFF_RAD + arm_rad:
        yield from _slightly_off(evidence)
        return
    if heading.forwards < LEAST_FORWARDS:
        return
    seen = (
        f"the course of pose.csv lies {degrees:.0f} degrees from its yaw while the treads drive "
        f"forwards ({heading.windows} windows, concentration {heading.concentration:.2f})"
    )
    if differ := parts_apart(evidence, heading):
        yield disagreement(f"{seen}; {differ}")
    elif abs(abs(degrees) - 180) < 20:
        if pose_sense(evidence) is Sense.OPPOSITE:
            return  # both treads reversed: said with the turns
        yield _finding(
            "yaw_backwards",
            seen,
            "Yaw is off by 180 degrees (sensor mounted backwards), or the treads are swapped and "
            f"both have the wrong sign: these have the same effect{_as_well(evidence)}",
            "Add pi to yaw, or correct the treads",
            yaw_plus(offset),
        )
    elif abs(abs(degrees) - 90) < 20:
        yield _finding(
            "yaw_off_by_90",
            seen,
            f"Yaw is off by {round(degrees / 90) * 90:.0f} degrees (another axis is called "
            f"forward, yaw counts from another axis, or x and y are swapped)"
            f"{_or_turned(degrees)}{_as_well(evidence)}",
            f"Add {np.sign(degrees) * np.pi / 2:+.4f} rad to yaw",
            yaw_plus(offset),
        )
    else:
        yield _finding(
            "yaw_offset",
            seen,
            f"Yaw is off by {degrees:.0f} degrees: the sensor is turned on the robot, or yaw "
            "counts from another axis than x (a compass not corrected, grid against true north); "
            f"or the robot slides to one side all the time{_as_well(evidence)}",
            f"Add {offset:+.4f} rad to yaw, or let `gap` name a heading_offset",
            yaw_plus(offset),
        )


def _slightly_off(evidence: Evidence) -> Iterator[Finding]:
    """A yaw that is turned by less, on drives that tell it from all that moves a robot aside."""
    frame = position_frame(evidence)
    if frame is None or not LEAST_OFF_RAD < abs(frame.turned_rad) < 2 * OFF_RAD:
        return
    if abs(frame.turned_rad) < SURELY * frame.turned_sd_rad:
        return
    degrees, sd = np.degrees([frame.turned_rad, frame.turned_sd_rad])
    yield _finding(
        "yaw_offset",
        f"the treads drive the robot {degrees:+.1f} +- {sd:.1f} degrees from the yaw of pose.csv, "
        "in each direction, beside what moves it aside in turns and on a slope",
        f"Yaw is off by {degrees:.1f} degrees: the sensor is turned a little on the robot, or yaw "
        "counts from another axis than x (declination, grid against true north); or the robot "
        "pulls to one side all the time",
        f"Add {frame.turned_rad:+.4f} rad to yaw",
        yaw_plus(frame.turned_rad),
    )


def _or_turned(degrees: float) -> str:
    off = abs(abs(degrees) - 90) > NEAR_90
    return f"; or the sensor is turned by {degrees:.0f} degrees on the robot" if off else ""


def _as_well(evidence: Evidence) -> str:
    """Other causes, where the drive does not distinguish them from an offset."""
    more = ""
    found = headings(evidence.motion, evidence.turn_rad(evidence.motion))
    if found and found["radians, reversed"].concentration > CONSISTENT:
        more += (
            "; or yaw is reversed or positions are mirrored: one straight line does not "
            "distinguish these"
        )
    if pose_sense(evidence) is Sense.UNKNOWN:
        more += "; or both treads have the wrong sign, if it is by 180 degrees"
    if evidence.arm_share > np.tan(OFF_RAD) / 2:
        more += "; or positions are late against yaw, as the robot turns to one side all the time"
    return more


def _finding(name: str, seen: str, cause: str, remedy: str, mend: Mend) -> Finding:
    return Finding(name, Level.WARNING, seen, cause, remedy, mend=mend)
