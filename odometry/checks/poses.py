"""What is odd about single stretches and samples of the measured poses, steps of yaw included."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import IntArray
from odometry.checks.course import OFF_RAD
from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level, counted
from odometry.checks.held_poses import PoseTrack, frozen_poses, pose_bursts, repeated_poses
from odometry.checks.pose_jumps import jumps
from odometry.checks.relation import pieces, relation
from odometry.checks.steps import FAR_S, JITTER_S, JUMP_TIMES, SHOWN, moments, rate_of, step_sizes
from odometry.checks.undo import moved
from odometry.windows.gaps import odometry_gaps
from odometry.windows.spans import runs_of, within

LEAST_ARM_M = 0.6
LASTING = 0.4  # share of the swing that each piece of the recording has
OUTLIERS = 0.01  # share of poses that go out and back, from which it is a warning
LEAST_S, LEAST_PERIODS = 5.0, 10.0  # an outage is longer than both
LEAST_M = 1.0  # that the treads travel meanwhile


def poses(evidence: Evidence) -> Iterator[Finding]:
    """Frozen and repeated poses, jumps and outliers."""
    if evidence.positions_measured is None or evidence.run.pose is None:
        return
    yield from _outliers(evidence)
    rows = np.flatnonzero(evidence.positions_measured & ~evidence.pose_outliers)
    stamps_s = evidence.run.pose.stamps_s[rows]
    positions = evidence.run.pose.stack("x", "y")[rows]
    travel_m = evidence.travel_m(stamps_s)
    track = PoseTrack(stamps_s, positions, travel_m)
    repeated = list(repeated_poses(track))
    frozen = list(frozen_poses(evidence, track))
    yield from repeated or frozen
    yield from pose_bursts(evidence, track)
    spans_s = [*evidence.left_out_s, *(span for finding in frozen for span in finding.spans_s)]
    yield from yaw_jumps(evidence, rows)
    yield from _lever_arm(evidence)
    yield from jumps(evidence, rows, travel_m, np.array(spans_s).reshape(-1, 2))


def _outliers(evidence: Evidence) -> Iterator[Finding]:
    pose, found = evidence.run.pose, np.flatnonzero(evidence.pose_outliers)
    if pose is None or evidence.positions_measured is None or not len(found):
        return
    measured = np.flatnonzero(evidence.positions_measured)
    beside = measured[np.clip(np.searchsorted(measured, found) - 3, 0, None)]
    away = np.hypot(*(pose.stack("x", "y")[found] - pose.stack("x", "y")[beside]).T)
    share = len(found) / len(measured)
    yield Finding(
        "pose_outliers",
        Level.WARNING if share > OUTLIERS or len(found) > 5 else Level.NOTE,
        f"{counted(len(found), 'pose')} ({100 * share:.3g} %) up to {away.max():.3g} m away from "
        "the neighbours, and back again",
        "Outliers of the reference (multipath, a wrong match)",
        "Leave these poses empty; the filter's gate refuses them and fits weigh them down",
        tuple((evidence.run_time_s(s),) * 2 for s in pose.stamps_s[found]),
    )


def _place(x_m: float, y_m: float) -> str:
    """A place in the robot frame in words, up to "the centre"."""
    along = f"{abs(x_m):.2f} m {'ahead of' if x_m >= 0 else 'behind'}"
    return f"{along} and {abs(y_m):.2f} m to the {'left' if y_m >= 0 else 'right'} of"


def _axis_rad(evidence: Evidence) -> float:
    """From yaw to the robot's axis; nothing where an offset of yaw has a name of its own."""
    offset = evidence.heading.offset_rad if evidence.heading is not None else 0.0
    return offset if abs(offset) < OFF_RAD else 0.0


def _lever_arm(evidence: Evidence) -> Iterator[Finding]:
    """A sensor far from the centre swings sideways, or forwards, with every turn."""
    m = evidence.motion
    turn = m.gyroscope_rad if evidence.yaw_rate is not None else m.turn_rad
    sideways = relation(evidence.sideways_m, turn)
    forward = relation(evidence.forward_m, m.mean_m, turn)
    if sideways is None or forward is None:
        return
    x_m, y_m = sideways.slope, -float(forward.coefficients[1])
    sure = sideways.certain(0, 8.0), forward.certain(1, 8.0)
    far = max(abs(x_m) * sure[0], abs(y_m) * sure[1])
    limit_m = max(LEAST_ARM_M, (evidence.run.robot.length or 1.0) / 2)
    place = 0 if far == abs(x_m) else 1
    columns = (turn,) if place == 0 else (m.mean_m, turn)
    fits = pieces((evidence.sideways_m, evidence.forward_m)[place], *columns)
    size = (x_m, -y_m)[place]
    swings = [of.coefficients[place] / size for of in fits if of.certain(place)]
    if far > limit_m and len(swings) > 1 and min(swings) > LASTING:
        yield Finding(
            "far_sensor",
            Level.WARNING,
            f"measured positions swing in turns like a point that lies {_place(x_m, y_m)} the "
            f"centre of the robot; more than {limit_m:.2f} m is far",
            "The sensor is mounted far from the centre (a lever arm), or the frame of the poses is "
            "not that of the robot, or positions are late against yaw (filtered)",
            f"State its place: [sensors] pose = [{x_m:.2f}, {y_m:.2f}, 0.0]",
            mend=moved(x_m, y_m, _axis_rad(evidence)),
        )


def pose_outages(evidence: Evidence) -> Iterator[Finding]:
    """A reference that was lost, and said nothing meanwhile."""
    if evidence.run.pose is None or evidence.positions_measured is None:
        return
    stamps_s = evidence.run.pose.stamps_s[evidence.positions_measured]
    inside = (stamps_s >= evidence.stamps_s[0]) & (stamps_s <= evidence.stamps_s[-1])
    stamps_s = stamps_s[inside]
    if len(stamps_s) < 2:
        return
    lasts_s = np.diff(stamps_s)
    driven_m = np.diff(evidence.travel_m(stamps_s))
    long = lasts_s > max(LEAST_S, LEAST_PERIODS * float(np.median(lasts_s)))
    rows = np.flatnonzero(long & (driven_m > LEAST_M))
    if not len(rows):
        return
    spans = [(evidence.run_time_s(stamps_s[i]), evidence.run_time_s(stamps_s[i + 1])) for i in rows]
    yield Finding(
        "pose_outage",
        Level.NOTE,
        f"pose.csv has no positions for {lasts_s[rows].sum():.1f} s in "
        f"{counted(len(rows), 'place')} (first from {spans[0][0]:.1f} s on, for "
        f"{lasts_s[rows[0]]:.1f} s) while the treads travel {driven_m[rows].sum():.3g} m",
        "The reference was lost for a while (an outage), or its rows were",
        "Nothing to do: windows do not cross it, and the filter goes on by the odometer",
        tuple(spans),
    )


LEAST_YAW_JUMP_RAD = np.radians(25)
HALF_TURN_RAD = np.radians(30)  # a jump that is off by less is half a turn
WAY_M = 0.05  # from a jump on, of the treads' travel that says which way the robot drives
AS_COURSE = (
    "Yaw is the course over ground, which turns round where the robot reverses: not the heading "
    "(a receiver without a second antenna or a compass)",
    "Leave yaw empty: positions alone are used then",
)


def yaw_jumps(evidence: Evidence, rows: IntArray) -> Iterator[Finding]:
    """Steps of the measured yaw against the gyroscope."""
    pose = evidence.run.pose
    if pose is None or not evidence.yaw_measured or evidence.yaw_rate is None:
        return
    by_gyroscope = evidence.pose_turn_by_gyroscope
    if by_gyroscope is None or by_gyroscope.correlation < 0.9:
        return
    of_rate_s = evidence.yaw_rate[0]
    rows = rows[within(pose.stamps_s[rows], np.array([[of_rate_s[0], of_rate_s[-1]]]))]
    stamps_s = pose.stamps_s[rows]
    yaw = np.radians(pose["yaw"][rows]) if evidence.yaw_in_degrees else pose["yaw"][rows]
    heading = evidence.integrals.gyroscope_rad(stamps_s) * by_gyroscope.slope
    known = np.isfinite(yaw) & np.isfinite(heading)
    stamps_s, off = stamps_s[known], np.unwrap((yaw - heading)[known])
    step = step_sizes(stamps_s, np.stack([off, np.zeros_like(off)], axis=-1))
    measured = np.isfinite(step)
    if evidence.gyroscope_file == "odometry.csv":
        gaps_s = odometry_gaps(evidence.run).spans_s
        measured &= ~within(stamps_s, gaps_s + np.array([-FAR_S, FAR_S]))
    if measured.sum() < 20:
        return
    usual = 1.4826 * float(np.median(step[measured]))
    rate = np.abs(rate_of(heading[known], stamps_s))
    odd = measured & (step > np.maximum(JUMP_TIMES * usual, LEAST_YAW_JUMP_RAD + JITTER_S * rate))
    peaks = [begin + int(np.argmax(step[begin:end])) for begin, end in runs_of(odd)]
    if not peaks:
        return
    turned = [i for i in peaks if abs(step[i] - np.pi) < HALF_TURN_RAD]
    reverses = sum(_reverses(evidence, float(stamps_s[i])) for i in turned)
    yield Finding(
        "yaw_jumps",
        Level.WARNING,
        f"yaw of pose.csv jumps against the gyroscope, and stays, {counted(len(peaks), 'time')}: "
        + ", ".join(
            f"{np.degrees(step[i]):.0f} degrees at {evidence.run_time_s(stamps_s[i]):.1f} s"
            for i in peaks[:SHOWN]
        ),
        *(
            AS_COURSE
            if 2 * reverses > len(peaks)
            else (
                "Yaw jumps: the heading of the reference was corrected or lost (magnetometer, "
                "antennas)",
                "Number the stretches between jumps in a column `window`, or cut with --from and "
                "--to",
            )
        ),
        moments(evidence, stamps_s[peaks]),
    )


def _reverses(evidence: Evidence, stamp_s: float) -> bool:
    """Whether the robot drives the other way after a stamp than it did before, with any pause."""
    of, here = evidence.integrals, int(np.searchsorted(evidence.stamps_s, stamp_s))
    travel_m = (of.left_m(evidence.stamps_s) + of.right_m(evidence.stamps_s)) / 2
    ahead_m = travel_m - travel_m[min(here, len(travel_m) - 1)]
    far = np.abs(ahead_m) > WAY_M
    before, after = np.flatnonzero(far[:here]), np.flatnonzero(far[here:]) + here
    return bool(len(before) and len(after) and ahead_m[before[-1]] * ahead_m[after[0]] > 0)
