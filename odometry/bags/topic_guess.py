"""What each topic of a bag is probably used for, by its type and its name."""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from odometry.bags.message_fields import (
    CAMERA_INFO,
    COMPRESSED_IMAGE,
    FIX,
    IMAGE,
    IMU,
    JOINTS,
    ODOMETRY,
    POINT,
    POSES,
    TRANSFORM_LISTS,
    TWISTS,
    number_paths,
)
from odometry.bags.topic import Topic
from odometry.bags.wheel_names import side_of, sided

COMMANDS = re.compile(
    r"cmd|command|goal|target|setpoint|set_point|plan|desired|waypoint|initialpose|joy|teleop",
    re.IGNORECASE,
)
TRUTH = re.compile(
    r"truth|mocap|vicon|optitrack|qualisys|vrpn|rtk|total_station|prism|leica|natnet", re.IGNORECASE
)
LOCALISED = re.compile(
    r"slam|lio|loam|icp|lidar|laser|gps|gnss|utm|map|amcl|cartographer|visual|vins|orb|global",
    re.IGNORECASE,
)
FUSED = re.compile(r"filter|ekf|ukf|fus|estimat|local_?iz", re.IGNORECASE)
NO_COLOUR = re.compile(
    r"depth|infra|(^|[/_])ir([/_]|$)|thermal|disparity|mask|debug", re.IGNORECASE
)
RECTIFIED = re.compile(r"rect", re.IGNORECASE)
SPEEDS = re.compile(r"wheel|encoder|track|tread|motor|speed|veloc|rpm|drive", re.IGNORECASE)
UNIT_MARKS = (
    ("rpm", r"rpm"),
    ("rad/s", r"rad(ian)?s?(_per)?_s|rad_?s\b|rads|angular|omega"),
    ("m/s", r"\bmps\b|_mps|m_s\b|met(er|re)s?_per|linear"),
)
SIMPLE_ARRAY = re.compile(r"std_msgs/msg/(Float|U?Int)\d+MultiArray")


class Guess(NamedTuple):
    """What a topic may be used for.

    Attributes
    ----------
    role : str
        "wheels", "imu", "reference", "images" or "camera_info"; "other_odometry" for poses that
        are kept beside the run, "" for nothing.
    rank : int
        Smaller is better among topics of one role; above LIKELY it is not taken by itself.
    why : str
        For the list of topics.
    """

    role: str
    rank: int
    why: str


LIKELY = 100


def guess(topic: Topic) -> list[Guess]:
    """What a topic may be used for; empty where it is of no use here."""
    kind, name = topic.message_type, topic.name
    if topic.sample is None or kind in TRANSFORM_LISTS:
        return []
    if COMMANDS.search(name):
        return [Guess("", LIKELY, "a command, which is not measured")] if kind in TWISTS else []
    if kind in _BY_TYPE:
        return _BY_TYPE[kind](topic)
    if kind in POSES:
        rank = 1 if TRUTH.search(name) else 20 if FUSED.search(name) else 10
        return [Guess("reference", rank, "poses")]
    if kind in TWISTS:
        rank = 40 if SPEEDS.search(name) or "odom" in name else LIKELY + 1
        return [Guess("wheels", rank, "a measured twist")]
    return _fields(topic)


def best(topics: Mapping[str, Topic], role: str) -> str | None:
    """Name of the topic that fits a role best; None where none is likely to."""
    ranked = [
        (one.rank, -topic.count, name)
        for name, topic in topics.items()
        for one in guess(topic)
        if one.role == role and one.rank < LIKELY
    ]
    return min(ranked)[2] if ranked else None


def _joints(topic: Topic) -> list[Guess]:
    left, right = sided(topic.sample.name)
    if not left:
        return [Guess("", LIKELY, "joints, but no wheels of a left and a right side by name")]
    return [Guess("wheels", 1, f"{', '.join(left)} | {', '.join(right)}")]


def _images(topic: Topic) -> list[Guess]:
    rank = 10 + (topic.message_type == IMAGE)
    if NO_COLOUR.search(topic.name) or "ompressedDepth" in topic.name:
        return [Guess("", LIKELY, "images, but no colours or greys of the terrain")]
    if RECTIFIED.search(topic.name):
        rank += 2
    if re.search(r"front|color|colour|rgb|left", topic.name, re.IGNORECASE):
        rank -= 4
    return [Guess("images", rank, "")]


def _odometry(topic: Topic) -> list[Guess]:
    if TRUTH.search(topic.name):
        return [Guess("reference", 2, "poses"), Guess("other_odometry", 50, "")]
    if LOCALISED.search(topic.name):
        return [Guess("reference", 15, "poses"), Guess("other_odometry", 50, "")]
    rank = 60 if FUSED.search(topic.name) else 30
    why = "a fused odometry" if rank == 60 else "wheel odometry by its name"
    return [Guess("wheels", rank, why), Guess("other_odometry", 1, "kept beside the run")]


def _fields(topic: Topic) -> list[Guess]:
    paths = list(number_paths(topic.sample))
    if not SPEEDS.search(" ".join((topic.name, *paths))):
        return []
    unit = unit_of(topic.name, paths)
    rank = 20 if unit else 70
    unknown = "" if unit else "; the unit is not named"
    if SIMPLE_ARRAY.match(topic.message_type):
        if len(topic.sample.data) != 2:
            return [Guess("wheels", LIKELY + 1, f"{len(paths)} numbers; say which are left")]
        return [Guess("wheels", rank, f"two speeds, taken as left and right{unknown}")]
    left, right = sided(path for path in paths if SPEEDS.search(path) or side_of(path))
    if not left:
        return [Guess("wheels", LIKELY + 2, "numbers; say which are left and right")]
    return [Guess("wheels", rank, f"{', '.join(left)} | {', '.join(right)}{unknown}")]


def unit_of(name: str, paths: Iterable[str]) -> str:
    """Unit of wheel speeds by the names of a topic and its fields; empty where none names one."""
    words = " ".join((name, *paths)).lower()
    for unit, mark in UNIT_MARKS:
        if re.search(mark, words):
            return unit
    return ""


_BY_TYPE: dict[str, Callable[[Topic], list[Guess]]] = {
    JOINTS: _joints,
    IMU: lambda topic: [Guess("imu", 1 + ("raw" in topic.name), "")],
    FIX: lambda _: [Guess("reference", 30, "positions by satellites")],
    POINT: lambda topic: [Guess("reference", 3 if TRUTH.search(topic.name) else 35, "positions")],
    CAMERA_INFO: lambda _: [Guess("camera_info", 1, "")],
    IMAGE: _images,
    COMPRESSED_IMAGE: _images,
    ODOMETRY: _odometry,
}
