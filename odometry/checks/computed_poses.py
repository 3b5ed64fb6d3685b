"""Poses that were computed from the treads which they are to judge, and so are no reference."""

from collections.abc import Iterator

import numpy as np

from odometry.checks.evidence import Evidence
from odometry.checks.finding import Finding, Level
from odometry.checks.relation import Relation, relation

# Share of the squares explained. Measured poses of 26 real recordings: 0.992 at most along the
# way, 0.998 in turns; a simulated robot with noise of 1 cm: 0.999.
COPIED = 0.9999
COPIED_WAY = 0.99995  # of the way; poses of a filter with four digits have 0.999999
SAME = 0.001  # factor of the way, less one: no wheel rolls so exactly as its radius says
LEAST_TURN_RAD = 2.0  # in all
OWN_WIDTH = 0.02  # of a width, less one: it is the track_width of run.toml


def computed_poses(evidence: Evidence) -> Iterator[Finding]:
    """Wheel odometry, or a filter that mixes treads and gyroscope, in place of a reference.

    No robot rolls exactly as far as its treads say. Where poses do, over each half second, and
    turn as the difference of the treads over one width or as the gyroscope, they are computed
    from these. Turns by the track_width of run.toml alone are enough. Simulated runs (truth.csv)
    may move so exactly without noise: of them only the latter is said.
    """
    if evidence.run.pose is None:
        return
    way = _way(evidence)
    width_m = _width_m(evidence.pose_turn_by_difference) if evidence.yaw_measured else None
    track_m = evidence.run.robot.track_width
    of_track = width_m is not None and abs(track_m / width_m - 1) < OWN_WIDTH
    rolls = way is not None and way.explained > COPIED_WAY and abs(way.slope - 1) < SAME
    rolls = rolls and _turned_rad(evidence) > LEAST_TURN_RAD
    if not of_track and (not rolls or evidence.run.truth is not None):
        return
    seen, source = [], "wheel odometry itself, computed from these treads"
    if rolls and way is not None:
        seen.append(
            f"the poses move {way.slope:.4f} m for each m of tread travel "
            f"({100 * way.explained:.3f} % explained)"
        )
    if width_m is not None:
        seen.append(f"turns of pose.csv are those of the treads over a width of {width_m:.4g} m")
    elif (of := evidence.pose_turn_by_gyroscope) is not None and _copied(of):
        seen.append("they turn as the gyroscope does")
        source = "computed from these treads and the gyroscope (a filter that mixes them)"
    else:
        source = "computed from these treads (wheel odometry, or a filter that mixes them in)"
    yield Finding(
        "poses_are_wheel_odometry",
        Level.WARNING,
        ", and ".join(seen),
        f"pose.csv is {source}: no reference",
        "Use a measured reference (GNSS, SLAM, motion capture): what is identified or compared "
        "with these poses is what their program assumed",
    )


def _turned_rad(evidence: Evidence) -> float:
    """How far the robot turned in all: on a straight line at one speed all is proportional."""
    turns = evidence.motion.turn_rad if evidence.yaw_measured else evidence.uniform.gyroscope_rad
    return float(np.nansum(np.abs(turns)))


def _way(evidence: Evidence) -> Relation | None:
    """Measured way along the robot's axis, round its turn, from the mean travel of the treads.

    Half of the turn is between the chord of a circle and its tangent. A base ahead of or behind
    the middle moves sideways of it alone.
    """
    m = evidence.motion
    if not evidence.yaw_measured:
        half_rad = np.clip(np.nan_to_num(evidence.turn_rad(m)) / 2, -np.pi / 2, np.pi / 2)
        return relation(m.distance_m / np.sinc(half_rad / np.pi), np.abs(m.mean_m))
    half_rad = m.turn_rad / 2
    middle_rad = m.yaw_rad[:, 0] + half_rad
    chord_m = m.moved_m[:, 0] * np.cos(middle_rad) + m.moved_m[:, 1] * np.sin(middle_rad)
    return relation(chord_m / np.sinc(half_rad / np.pi), m.mean_m)


def _width_m(turn: Relation | None) -> float | None:
    """The width over which the treads' difference is the turn; None where it is not exact."""
    return 1 / abs(turn.slope) if turn is not None and _copied(turn) else None


def _copied(found: Relation) -> bool:
    return found.explained > COPIED and found.certain()
