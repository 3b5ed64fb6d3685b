"""Which sensors agree on the side to which the robot turns, and which do not."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level, disagreement
from odometry.checks.findings.undo import (
    Mend,
    exchanged,
    gyroscope_times,
    in_turn,
    times,
    treads_times,
)
from odometry.checks.turns.turn_signs import Sense, gyroscope_sense, pose_sense
from odometry.checks.turns.turns_in_parts import turns_flip
from odometry.fixes.origin import stated_origin

LEAST_FORWARDS = 0.5  # how clearly treads say which way is forwards


def turning(evidence: Evidence) -> Iterator[Finding]:
    """Signs of treads, gyroscope and yaw: the one that contradicts the other two is wrong."""
    gyroscope, pose = gyroscope_sense(evidence), pose_sense(evidence)
    known = [s for s in (gyroscope, pose) if s is not Sense.UNKNOWN]
    if not known or all(s is Sense.AGREES for s in known):
        return
    tread = known[0] if set(known) in ({Sense.LEFT_REVERSED}, {Sense.RIGHT_REVERSED}) else None
    one = None if tread is None else _one_tread(evidence, tread)
    flips = turns_flip(evidence)
    if one is not None and (not flips or _flips_no_more(evidence, one)):
        yield one
    elif flips:
        if Sense.UNRELATED not in known:  # said with those elsewhere
            yield disagreement(flips)
    else:
        yield from _opposite(evidence, gyroscope, pose)


def _flips_no_more(evidence: Evidence, one: Finding) -> bool:
    """Whether nothing flips once a cause is undone.

    With one tread of the wrong sign turns go with the sum of both columns, whose difference is then
    the way along: it has the sign of the turns in one part of a drive, and not in another.
    """
    mend = one.mend
    return mend is not None and not turns_flip(Evidence(mend(evidence.run), evidence.left_out_s))


def _opposite(evidence: Evidence, gyroscope: Sense, pose: Sense) -> Iterator[Finding]:
    """A sensor that turns against another one, and no tread alone that does."""
    known = [s for s in (gyroscope, pose) if s is not Sense.UNKNOWN]
    if set(known) == {Sense.OPPOSITE}:
        yield _all_opposite(evidence, gyroscope, pose)
    elif gyroscope is Sense.OPPOSITE and pose is Sense.AGREES:
        yield _finding(
            "gyroscope_reversed",
            f"gyro_z turns against treads and measured yaw ({_correlations(evidence)})",
            *_gyroscope_remedy(evidence),
            gyroscope_times(evidence.run, -1.0),
        )
    elif pose is Sense.OPPOSITE and gyroscope is Sense.AGREES:
        yield _pose_opposite(evidence, "treads and gyroscope agree", alone=True)


def _gyroscope_remedy(evidence: Evidence) -> tuple[str, str]:
    """Cause and remedy of a yaw rate of the wrong sign: what `[sensors]` says may be wrong."""
    negate = f"negate gyro_z of {evidence.gyroscope_file}"
    if evidence.gyroscope_file == "imu.csv" and evidence.run.sensors.imu_rad is not None:
        return (
            "[sensors] imu of run.toml is wrong, or the gyroscope has the wrong sign",
            "Check [sensors] imu first (an import takes it from the frames of the bag) and correct "
            f"it; where it is right, {negate}",
        )
    return "The gyroscope has the wrong sign (z down, or mounted upside down)", negate.capitalize()


def _imu_hint(evidence: Evidence) -> str:
    """Where the attitude of the inertial sensor is said, which turns the sign of its yaw rate."""
    if evidence.gyroscope_file != "imu.csv":
        return "a sensor mounted upside down has gyro_z negated"
    if evidence.run.sensors.imu_rad is not None:
        return "check [sensors] imu of run.toml first (an import takes it from the bag's frames)"
    return (
        "run.toml has no [sensors] imu: a sensor mounted upside down needs imu = [3.1416, 0, 0] "
        "there"
    )


def _all_opposite(evidence: Evidence, gyroscope: Sense, pose: Sense) -> Finding:
    forward = _forward_sign(evidence)
    if pose is gyroscope and evidence.heading is not None and not _reading_is_plain(evidence):
        return _yaw_and_gyroscope_reversed(evidence)
    if pose is Sense.UNKNOWN:
        return _finding(
            "treads_or_gyroscope_reversed",
            f"gyro_z turns against the treads ({_correlations(evidence)})",
            "Left and right treads are swapped, or the gyroscope has the wrong sign, or both "
            "treads have it: without poses these cannot be distinguished",
            "Drive one left turn by hand and see which column is wrong; " + _imu_hint(evidence),
            exchanged,
        )
    if gyroscope is Sense.UNKNOWN and not (evidence.heading and _reading_is_plain(evidence)):
        return _pose_opposite(evidence, "there is no gyroscope to say more", alone=False)
    if forward < 0:
        return _finding(
            "treads_both_reversed",
            "measured motion is against both treads, in turns and along the way "
            f"({_correlations(evidence)})",
            "Both treads have the wrong sign",
            "Negate v_left and v_right",
            treads_times(-1.0, -1.0),
        )
    sensors = "y and yaw" if gyroscope is Sense.UNKNOWN else "gyro_z, y and yaw"
    more = f"; or {sensors} are in frames with z down (NED, FRD: as autopilots log them)"
    remedy = f"Exchange v_left and v_right; where z points down, negate {sensors} instead"
    if not evidence.yaw_measured:
        remedy = "Exchange v_left and v_right"
        more = ", or both have the wrong sign: without yaw these cannot be distinguished"
    return _finding(
        "treads_swapped",
        f"measured turns are against the treads ({_correlations(evidence)})"
        + (", motion along the way is not" if evidence.yaw_measured else ""),
        f"Left and right treads are swapped{more}",
        remedy,
        exchanged,
    )


def _pose_opposite(evidence: Evidence, others: str, *, alone: bool) -> Finding:
    if evidence.heading is not None and not _reading_is_plain(evidence):
        return _yaw_reversed(evidence, others)
    if alone and _course_is_backwards(evidence):
        return disagreement(
            f"yaw of pose.csv turns against the treads ({_correlations(evidence)}; {others}), and "
            "its course is opposite to its yaw while the treads drive forwards: no frame with z "
            "down does both (stamps of pose.csv that run backwards would)"
        )
    yaw = "yaw" if evidence.yaw_measured else "the course"
    if not evidence.yaw_measured:
        cause = (
            "Positions are mirrored: x and y are swapped (north before east, NED) or one negated"
        )
        if stated_origin(evidence.run.settings.get("source")):
            cause += " (latitude and longitude are exchanged, or a south or west is not negative)"
    elif evidence.heading is None:
        cause = "The yaw of pose.csv is reversed, or all of it is in a frame with z down (NED)"
    else:
        cause = (
            "pose.csv is in a frame with z down (NED, or x and y swapped and yaw with them): "
            "its yaw and its course agree with each other"
        )
        if gyroscope_sense(evidence) is Sense.AGREES:
            cause += "; or left and right treads are swapped, and gyro_z has the wrong sign"
    if not alone:
        cause += ", or left and right treads are swapped"
        if not evidence.yaw_measured:
            cause += ", or both have the wrong sign"
        cause += ": these cannot be distinguished"
    return _finding(
        "pose_mirrored",
        f"{yaw} of pose.csv turns against the treads ({_correlations(evidence)}; {others})",
        cause,
        "Write pose.csv with x forward, y left, z up and yaw counter-clockwise",
        times("pose", -1.0, "y", "yaw"),
    )


def _course_is_backwards(evidence: Evidence) -> bool:
    """Whether poses move against their own yaw where the treads drive forwards."""
    heading = evidence.heading
    if heading is None or heading.forwards < LEAST_FORWARDS:
        return False
    return abs(heading.offset_rad) > 3 * np.pi / 4


def _yaw_and_gyroscope_reversed(evidence: Evidence) -> Finding:
    return _finding(
        "yaw_reversed",
        f"yaw of pose.csv and gyro_z turn against the treads ({_correlations(evidence)}), and its "
        "course turns against its yaw, as the treads do",
        "Yaw and gyro_z are clockwise (z down, as autopilots log an attitude) beside positions "
        "with z up; or left and right treads are swapped, and positions are mirrored as well: "
        "these have the same effect",
        "Negate yaw and gyro_z, if a left turn by hand makes them fall",
        in_turn(times("pose", -1.0, "yaw"), gyroscope_times(evidence.run, -1.0)),
    )


def _yaw_reversed(evidence: Evidence, others: str) -> Finding:
    assert evidence.heading is not None  # noqa: S101 - checked by the caller
    offset = float(np.degrees(evidence.heading.offset_rad))
    compass = abs(abs(offset) - 90) < 20
    cause = "yaw is a compass bearing (clockwise from north)" if compass else "yaw is clockwise"
    return _finding(
        "yaw_reversed",
        f"course and yaw of pose.csv agree only with the sign of yaw reversed (concentration "
        f"{evidence.heading.concentration:.2f}, offset {offset:.0f} degrees; {others})",
        f"Yaw is reversed: {cause}",
        "Convert: yaw = pi/2 - bearing [rad]" if compass else "Negate yaw",
        times("pose", -1.0, "yaw"),
    )


def _one_tread(evidence: Evidence, tread: Sense) -> Finding:
    side = "left" if tread is Sense.LEFT_REVERSED else "right"
    return _finding(
        f"tread_{side}_reversed",
        f"turns grow with the sum of the tread speeds ({_correlations(evidence)})",
        f"The {side} tread has the wrong sign",
        f"Negate v_{side}",
        treads_times(-1.0, 1.0) if side == "left" else treads_times(1.0, -1.0),
    )


def _forward_sign(evidence: Evidence) -> int:
    found = evidence.forward_by_mean
    return int(np.sign(found.slope)) if found is not None and found.certain() else 0


def _reading_is_plain(evidence: Evidence) -> bool:
    return evidence.heading is not None and evidence.heading.reading == "radians"


def _correlations(evidence: Evidence) -> str:
    words = []
    for name, found in (
        ("gyroscope", evidence.gyroscope_by_treads),
        ("yaw" if evidence.yaw_measured else "the course", evidence.pose_turn_by_treads),
    ):
        if found is not None:
            left, right = found.coefficients
            words.append(f"turn of {name} = {left:+.2f} left {right:+.2f} right [rad/m]")
    return ", ".join(words)


def _finding(name: str, seen: str, cause: str, remedy: str, mend: Mend) -> Finding:
    return Finding(name, Level.WARNING, seen, cause, remedy, mend=mend)
