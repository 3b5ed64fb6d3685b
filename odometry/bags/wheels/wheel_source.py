"""Where the tread speeds come from: which topic, which numbers of it, in which unit."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from odometry.bags.files.topic import PLACE, VELOCITY, Topic, farthest, moved
from odometry.bags.topics.message_fields import (
    JOINTS,
    NO_WHEELS,
    ODOMETRY,
    TWISTS,
    number_paths,
)
from odometry.bags.topics.topic_guess import unit_of
from odometry.bags.topics.wheel_names import UNITS, check_unit, gear_of
from odometry.bags.wheels.wheel_sides import dead_joints, sides_of
from odometry.errors import BagError

# Of the largest speed ahead: a skid-steer robot slides sideways by less, even about its own centre
SIDEWAYS_SHARE = 0.3
LEAST_TICKS = 100  # angles in rad are hardly ever whole at both ends of so long a way
RADIUS = "--wheel-radius METRES"
HOW_RADIUS = (
    "roll the robot straight ahead for ten turns of a wheel, and divide the way by 62.83; or "
    "measure from the centre of a wheel to the terrain, with the robot's weight on it"
)


@dataclass(frozen=True)
class WheelSource:
    """Which numbers of which topic are wheel speeds.

    Attributes
    ----------
    topic : str
    kind : str
        "joints" (of a JointState), "fields" (paths) or "twist".
    left, right : tuple of str
        Names of joints, or paths; empty for a twist.
    left_factor, right_factor : float
        Tread speed (or way) in metres for a number of one: unit, radius, gear and sign.
    speeds : bool
        Whether the numbers are speeds; else places, which are differenced.
    wraps_at : float
        Places that jump by more than half of this have wrapped; infinite where they do not.
    why : str
        In a sentence.
    unit : str
        Of the numbers, one of UNITS; "" of a twist.
    stated : bool
        Whether the user says which wheels are left and right.
    values_stated, unit_stated : bool
        Whether the user says that velocities, or positions, are taken, and their unit.
    """

    topic: str
    kind: str
    left: tuple[str, ...] = ()
    right: tuple[str, ...] = ()
    left_factor: float = 1.0
    right_factor: float = 1.0
    speeds: bool = True
    wraps_at: float = math.inf
    why: str = ""
    unit: str = ""
    stated: bool = False
    values_stated: bool = False
    unit_stated: bool = False


def wheel_source(topic: Topic, topic_map: Mapping[str, Any], radius_m: float | None) -> WheelSource:
    """Decide what of a topic is taken as wheel speeds.

    Parameters
    ----------
    topic : Topic
    topic_map : Mapping
        The table [wheels] of a map; what it does not give is guessed from names.
    radius_m : float or None
        Of the wheels; needed where the numbers are angles.

    Raises
    ------
    BagError
        If the left and right numbers or their unit cannot be determined, or the radius is not
        known: the message says which option to give.
    """
    if topic.sample is None:
        raise BagError(f"{topic.name}: no message of it can be read: {topic.problem}")
    if topic.message_type in NO_WHEELS:
        raise BagError(
            f"{topic.name}: a {topic.message_type} holds no speeds of wheels; expected joint "
            "states, odometry, a twist with a stamp, or numbers of another message"
        )
    if topic.message_type in TWISTS:
        return _twist(topic, topic_map)
    joints = topic.message_type == JOINTS
    left, right = sides_of(topic, topic_map, list(topic.sample.name) if joints else None)
    speeds, unit = (
        _joint_values(topic, topic_map, left + right) if joints else _unit(topic, topic_map)
    )
    stated = "left" in topic_map
    dead = [] if stated else dead_joints(topic, (left, right), VELOCITY if speeds else PLACE)
    left, right = (tuple(one for one in side if one not in dead) for side in (left, right))
    one, of_angle, is_speed = UNITS[unit]
    if of_angle and radius_m is None:
        raise BagError(
            f"{topic.name}: wheel speeds in {unit} need the radius of the wheels, and no robot "
            f"description in the bag gives it: add {RADIUS}. To measure it, {HOW_RADIUS}",
            (RADIUS,),
        )
    reach_m = radius_m if of_angle and radius_m is not None else 1.0
    metres = one * reach_m / gear_of(topic_map)
    return WheelSource(
        topic.name,
        "joints" if joints else "fields",
        left,
        right,
        metres * float(topic_map.get("left_sign", 1)),
        metres * float(topic_map.get("right_sign", 1)),
        is_speed,
        _wrap(topic, left + right, one) if joints and not speeds else math.inf,
        f"{'speeds' if is_speed else 'differences of places'} of {', '.join(left)} (left) and "
        f"{', '.join(right)} (right) in {unit}{_left_out(dead)}",
        unit,
        stated,
        "values" in topic_map,
        "unit" in topic_map,
    )


def _twist(topic: Topic, topic_map: Mapping[str, Any]) -> WheelSource:
    zero = not moved(topic.ranges, VELOCITY, "ahead") and not moved(topic.ranges, VELOCITY, "turn")
    side, ahead = (farthest(topic.ranges, VELOCITY, [name]) for name in ("side", "ahead"))
    of_world = side > SIDEWAYS_SHARE * ahead
    said = topic_map.get("values")
    by_pose = topic.message_type == ODOMETRY and (
        said == "position"
        or (said is None and (zero or of_world) and moved(topic.ranges, PLACE, "x"))
    )
    if of_world and not by_pose and said is None:
        raise BagError(
            f"{topic.name}: its twist goes sideways by up to {side:.2g} m/s (ahead {ahead:.2g}), "
            "as one in the world's axes does, and no wheels. Name other ones with --wheels, or "
            'write values = "velocity" in [wheels] of a map if x is ahead all the same'
        )
    what = "differences of its poses" if by_pose else "its twist"
    if by_pose and of_world and not zero:
        what += " (its twist goes sideways, as one in the world's axes does)"
    why = f"{what}, as v -/+ w * separation / 2"
    signs = (float(topic_map.get("left_sign", 1)), float(topic_map.get("right_sign", 1)))
    return WheelSource(topic.name, "twist", (), (), *signs, speeds=not by_pose, why=why)


def _left_out(dead: list[str]) -> str:
    if not dead:
        return ""
    return (
        f". Left out: {', '.join(dead)}, at zero all the time while the others of its side move "
        "(a dead encoder, or a number that is not filled in; --left and --right take what you say)"
    )


def _joint_values(
    topic: Topic, topic_map: Mapping[str, Any], names: tuple[str, ...]
) -> tuple[bool, str]:
    """Whether velocities are taken, else positions; and their unit."""
    said = topic_map.get("values")
    if said not in (None, "velocity", "position"):
        raise BagError(f"[wheels] values = {said!r}, expected velocity or position")
    has_velocity = any(moved(topic.ranges, VELOCITY, name) for name in names)
    has_place = any(moved(topic.ranges, PLACE, name) for name in names)
    speeds = said == "velocity" if said else has_velocity or not has_place
    if not speeds and "unit" not in topic_map and _are_ticks(topic, names):
        raise BagError(
            f"{topic.name}: the places of its wheels are whole numbers, as ticks of an encoder "
            "are, and no angles in rad: add --unit turns --gear TICKS (for a turn of the wheel)"
        )
    unit = str(topic_map.get("unit", "rad/s" if speeds else "rad"))
    check_unit(unit)
    if UNITS[unit][2] != speeds:
        kind = "speeds" if speeds else "places"
        raise BagError(f"{topic.name}: unit {unit!r}, expected a unit of {kind}")
    return speeds, unit


def _are_ticks(topic: Topic, names: tuple[str, ...]) -> bool:
    """Whether all places that were read are whole numbers, and moved by many."""
    ends = [topic.ranges[PLACE, name] for name in names if (PLACE, name) in topic.ranges]
    whole = all(end.is_integer() for pair in ends for end in pair)
    return whole and any(most - least >= LEAST_TICKS for least, most in ends)


def _unit(topic: Topic, topic_map: Mapping[str, Any]) -> tuple[bool, str]:
    unit = str(topic_map.get("unit") or unit_of(topic.name, number_paths(topic.sample)))
    if not unit:
        raise BagError(
            f"{topic.name}: the unit of its wheel speeds is not known: add --unit with one of "
            f"{', '.join(UNITS)}"
        )
    check_unit(unit)
    return UNITS[unit][2], unit


def _wrap(topic: Topic, names: tuple[str, ...], one: float) -> float:
    """Places that all stay within one turn are taken as wrapped ones."""
    turn = 2 * math.pi / one
    ranges = [topic.ranges[PLACE, name] for name in names if (PLACE, name) in topic.ranges]
    within = all(most - least <= turn * 1.001 for least, most in ranges)
    return turn if ranges and within else math.inf
