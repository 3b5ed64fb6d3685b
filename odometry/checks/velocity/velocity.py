"""Velocities of velocity.csv in another unit, frame or sign, or of another motion."""

from collections.abc import Iterator

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.findings.unit_tables import SLIPS, tread_units
from odometry.checks.statistics.relation import Relation, relation
from odometry.checks.velocity.velocity_ways import VelocityWays, velocity_ways

VELOCITY_FAULTS = frozenset(
    {"velocity_unit", "velocity_reversed", "velocity_axes", "velocity_unrelated"}
)
LEAST_M, LEAST_RAD = 2.0, 1.0  # that the robot drives and turns: less says nothing
CLEAR, POOR = 0.7, 0.3  # share of the motion of other sensors that a velocity explains
UNRELATED, CHANGES = 0.2, 0.2  # correlation about the means, of speeds that change by more
# A velocity for each one of the poses or the gyroscope; of the treads, which slip.
RIGHT, OF_TREADS = (0.8, 1.25), (0.05, 1.25)
DEGREES = (0.7, 1.4)  # times 57.3
UNSCALED = (
    "Either {} has another scale, or the sensor is turned or tilted, or does not measure in "
    "proportion: these are not distinguished"
)
LEFT_OUT = "Correct velocity.csv, or leave it out, as `run` and `batch` do"


def velocity(evidence: Evidence) -> Iterator[Finding]:
    """What is wrong with vx and vy, and with wz; vy alone where poses say where left is."""
    ways = velocity_ways(evidence)
    if ways is None or float(np.nansum(np.abs(evidence.motion.mean_m))) < LEAST_M:
        return
    if (found := _driven(evidence, ways)) is not None:
        yield found
    elif (left := relation(ways.left, evidence.sideways_m)) is not None and _is_reversed(left):
        yield _finding(
            "velocity_reversed",
            f"vy of velocity.csv is {left.slope:.2f} times what the poses move to the left",
            "vy is to the right (axes with z down: NED, FRD)",
        )
    if (turned := _turned(evidence, ways)) is not None:
        yield turned


def _driven(evidence: Evidence, ways: VelocityWays) -> Finding | None:
    """The finding of vx, which the treads and, where there is a heading, the poses measure too."""
    m = evidence.motion
    if _never(ways.ahead):
        return _nothing("vx", "m")
    by_poses = relation(ways.ahead, evidence.forward_m)
    sure = by_poses is not None and by_poses.certain() and by_poses.explained > CLEAR
    by, of = (by_poses, "the poses") if sure else (relation(ways.ahead, m.mean_m), "the treads")
    if by is None:
        return None
    varies = abs(_correlation(ways.ahead, m.mean_m)) > UNRELATED
    if by.explained > CLEAR and by.certain() and varies:
        return _scaled(by, of)
    if (by.explained > POOR and varies) or not _moves_as_treads_say(evidence):
        return None
    return _other_axes(evidence, ways) or _finding(
        "velocity_unrelated",
        f"vx of velocity.csv explains {100 * max(by.explained, 0):.0f} % of what {of} drive",
        "It is of another recording or clock, was never measured, or is along other axes than "
        "those of the robot (a map, another mounting of the sensor)",
    )


def _scaled(by: Relation, of: str) -> Finding | None:
    low, high = RIGHT if of == "the poses" else OF_TREADS
    seen = f"vx of velocity.csv is {by.slope:.3g} times what {of} drive"
    if by.slope < 0:
        treads = " (or both treads have the wrong sign)" * (of == "the treads")
        cause = f"vx points backwards: the sensor is mounted the other way{treads}"
        return _finding("velocity_reversed", seen, cause)
    if low <= by.slope <= high:
        return None
    least = max(low, SLIPS)
    units = [one.words for one in tread_units(None) if least <= by.slope / one.factor <= high]
    cause = f"vx is in {' or '.join(units)}" if units else UNSCALED.format("vx")
    return _finding("velocity_unit", seen, cause)


def _correlation(ways: FloatArray, travel_m: FloatArray) -> float:
    """Correlation about the means, in which a constant speed is nothing; 1 where it hardly is one.

    That of treads whose travel (K,) changes from window to window by less than a fifth.
    """
    known = np.isfinite(ways)
    ways, travel_m = ways[known], travel_m[known]
    if len(ways) < 2 or not np.std(travel_m) > CHANGES * np.abs(np.mean(travel_m)):
        return 1.0
    return float(np.corrcoef(ways, travel_m)[0, 1]) if np.std(ways) > 0 else 0.0


def _moves_as_treads_say(evidence: Evidence) -> bool:
    """Whether poses, or at least no others, agree with the treads that vx is compared with."""
    by = evidence.forward_by_mean or evidence.distance_by_mean
    return by is None or (by.certain() and by.explained > CLEAR)


def _other_axes(evidence: Evidence, ways: VelocityWays) -> Finding | None:
    """Vx and vy exchanged, or along the axes of the map."""
    m = evidence.motion
    across = relation(ways.left, m.mean_m)
    if across is not None and across.certain() and across.explained > CLEAR:
        return _finding(
            "velocity_axes",
            f"vy of velocity.csv is {across.slope:.2f} times what the treads drive, and vx is not",
            "vx and vy are exchanged, or along other axes (a map, a sensor turned by 90 degrees)",
        )
    for x, y, order in ((0, 1, "x and y"), (1, 0, "y and x (north and east)")):
        along = relation(ways.ahead, m.moved_m[:, x]), relation(ways.left, m.moved_m[:, y])
        if all(one is not None and one.slope > 0 and one.explained > CLEAR for one in along):
            return _finding(
                "velocity_axes",
                f"vx and vy of velocity.csv are what the poses move along {order} of the map",
                "They are along the axes of the map, not of the robot",
            )
    if _correlation(ways.length, np.abs(m.mean_m)) > CLEAR:
        return _finding(
            "velocity_axes",
            "the size of vx and vy of velocity.csv together goes with the treads, vx alone not",
            "They are along the axes of a map, or of a sensor that is turned",
        )
    return None


def _turned(evidence: Evidence, ways: VelocityWays) -> Finding | None:
    """The finding of wz, by the gyroscope or yaw, whichever agrees with the treads.

    None where wz goes with one of these against the treads: they are what is reversed.
    """
    m = evidence.motion
    for of, turn_rad in (
        ("the yaw of the poses", _yaw_rad(evidence)),
        ("gyro_z", evidence.turn_rad(m)),
    ):
        by_treads = relation(turn_rad, m.difference_m / evidence.run.robot.track_width)
        agrees = by_treads is not None and by_treads.explained > CLEAR and by_treads.slope > 0
        by = relation(ways.turned, turn_rad) if agrees else None
        if by is None or float(np.nansum(np.abs(turn_rad))) < LEAST_RAD:
            continue
        return _nothing("wz", "rad") if _never(ways.turned) else _of_turns(by, of)
    by = relation(ways.turned, m.difference_m / evidence.run.robot.track_width)
    if by is None or by.explained < CLEAR:
        return None
    others = [relation(ways.turned, of) for of in (_yaw_rad(evidence), evidence.turn_rad(m))]
    if by.slope < 0 and any(of and of.slope > 0 and of.explained > CLEAR for of in others):
        return None
    return _of_turns(by, "the treads")


def _yaw_rad(evidence: Evidence) -> FloatArray:
    turn_rad = evidence.motion.turn_rad
    return turn_rad if evidence.yaw_measured else np.full(len(turn_rad), np.nan)


def _of_turns(by: Relation, of: str) -> Finding | None:
    turns = "turn" if of == "the treads" else "turns"
    seen = f"wz of velocity.csv is {by.slope:.3g} times what {of} {turns}"
    low, high = RIGHT if of != "the treads" else OF_TREADS
    if by.explained < POOR:
        return _finding(
            "velocity_unrelated",
            f"wz of velocity.csv explains {100 * max(by.explained, 0):.0f} % of the turns by {of}",
            "It is of another recording or clock, or was never measured",
        )
    if by.explained < CLEAR or not by.certain():
        return None
    if by.slope < 0:
        return _finding("velocity_reversed", seen, "wz is clockwise (axes with z down: NED, FRD)")
    if DEGREES[0] < np.radians(by.slope) < DEGREES[1]:
        return _finding("velocity_unit", seen, "wz is in degrees per second")
    if low <= by.slope <= high:
        return None
    return _finding("velocity_unit", seen, UNSCALED.format("wz"))


def _never(ways: FloatArray) -> bool:
    """Whether something was measured, and is nothing all the time."""
    known = ways[np.isfinite(ways)]
    return len(known) > 0 and not known.any()


def _nothing(name: str, unit: str) -> Finding:
    seen = f"{name} of velocity.csv is 0 {unit}/s all the time, while the treads drive"
    return _finding("velocity_unrelated", seen, "It was never measured: leave its cells empty")


def _is_reversed(by: Relation) -> bool:
    return by.explained > CLEAR and by.certain() and -by.slope > RIGHT[0]


def _finding(name: str, seen: str, cause: str) -> Finding:
    return Finding(name, Level.WARNING, seen, cause, LEFT_OUT)
