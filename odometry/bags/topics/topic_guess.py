"""What each topic of a bag is probably used for, by its type and its name."""

import re
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from odometry.bags.files.topic import Topic
from odometry.bags.topics.imu_fields import RATE, measures
from odometry.bags.topics.message_fields import (
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
from odometry.bags.topics.odometry_kinds import (
    FUSED,
    LIDAR,
    NAMES,
    SATELLITES,
    TRUTH,
    UNKNOWN,
    VISUAL,
    WHEELS,
    kind_of,
)
from odometry.bags.topics.wheel_names import side_of, sided

COMMANDS = re.compile(
    r"cmd|command|goal|target|setpoint|set_point|plan|desired|waypoint|initialpose|joy|teleop",
    re.IGNORECASE,
)
NO_COLOUR = re.compile(
    r"depth|infra|(^|[/_])ir([/_]|$)|thermal|disparity|mask|debug", re.IGNORECASE
)
RECTIFIED = re.compile(r"(?i:(^|[/_.-])rect)|Rect")  # not: direct, unrectified
ON_ROBOT = re.compile(r"optical|(^|[/_])base_(link|footprint)$", re.IGNORECASE)
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
GUESSED = 50  # wheels that nothing tells from another odometry: the last to be taken, with a note
# Poses of satellites alone have the ranks 30 and 35: visual odometry drifts, they do not
REFERENCE_RANKS = {TRUTH: 2, LIDAR: 15, SATELLITES: 15, VISUAL: 45}


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
        return [_poses(topic)]
    if kind in TWISTS:
        return _twist(topic)
    return _fields(topic)


def _poses(topic: Topic) -> Guess:
    frame = topic.sample.header.frame_id
    if ON_ROBOT.search(frame):
        return Guess("", LIKELY, f"poses in {frame}, a frame of the robot: of what it sees")
    fused = 20 if NAMES[FUSED].search(topic.name) else 10
    return Guess("reference", 1 if NAMES[TRUTH].search(topic.name) else fused, "poses")


def best(topics: Mapping[str, Topic], role: str) -> str | None:
    """Name of the topic that fits a role best; None where none is likely to."""
    names = candidates(topics, role)
    return names[0] if names else None


def candidates(topics: Mapping[str, Topic], role: str) -> list[str]:
    """Names of the topics that fit a role best, that of most messages first; equals otherwise.

    Images of a camera with a CameraInfo come first: without one no run can use them.
    """
    ranked = sorted(
        ((role == "images" and not camera_info_beside(topics, name), one.rank), -topic.count, name)
        for name, topic in topics.items()
        for one in guess(topic)
        if one.role == role and one.rank < LIKELY
    )
    return [name for rank, _, name in ranked if rank == ranked[0][0]]


def camera_info_beside(topics: Mapping[str, Topic], images: str) -> str:
    """The CameraInfo in the folder of an image topic, or in one above it; empty where none is.

    One that is in no folder belongs to images that are in none.
    """
    folder = images.removesuffix("/compressed").rpartition("/")[0]
    while True:
        name = f"{folder}/camera_info"
        if name in topics and topics[name].message_type == CAMERA_INFO:
            return name
        folder = folder.rpartition("/")[0]
        if not folder:
            return ""


def _joints(topic: Topic) -> list[Guess]:
    left, right = sided(topic.sample.name)
    if not left and sided(topic.joints)[0]:
        wheels = ", ".join(one for side in sided(topic.joints) for one in side)
        apart = f"{wheels} come in messages of their own, which are not put together: record them "
        return [
            Guess("", LIKELY, f"{apart}in one message (joint_state_publisher with source_list)")
        ]
    if not left:
        return [Guess("", LIKELY, "joints, but no wheels of a left and a right side by name")]
    return [Guess("wheels", 1, f"{', '.join(left)} | {', '.join(right)}")]


def _imu(topic: Topic) -> Guess:
    rank = 1 + ("raw" in topic.name)
    if measures(topic, RATE):
        return Guess("imu", rank, "")
    return Guess("imu", rank + GUESSED, "no angular velocities")


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
    kind = kind_of(topic)
    if kind.name in REFERENCE_RANKS:
        why = f"{kind.name}, by {kind.sign}"
        rank = REFERENCE_RANKS[kind.name]
        return [Guess("reference", rank, why), Guess("other_odometry", 50, "")]
    kept = Guess("other_odometry", 1, "kept beside the run")
    if kind.name == FUSED:
        return [kept, Guess("", LIKELY + 1, f"{kind.name}, by {kind.sign}; not of the wheels")]
    if kind.name == UNKNOWN:
        return [Guess("wheels", GUESSED, "odometry; nothing says that it is of the wheels"), kept]
    return [Guess("wheels", 30, "wheel odometry by its name"), kept]


def _twist(topic: Topic) -> list[Guess]:
    kind = kind_of(topic)
    if not kind.of_wheels:
        return [Guess("", LIKELY + 1, f"a twist of {kind.name}, by {kind.sign}")]
    if kind.name == WHEELS:
        return [Guess("wheels", 40, "a measured twist")]
    rank = GUESSED if SPEEDS.search(topic.name) or "odom" in topic.name else LIKELY + 1
    return [Guess("wheels", rank, "a twist; nothing says that it is of the wheels")]


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
    IMU: lambda topic: [_imu(topic)],
    FIX: lambda _: [Guess("reference", 30, "positions by satellites")],
    POINT: lambda topic: [
        Guess("reference", 3 if NAMES[TRUTH].search(topic.name) else 35, "positions")
    ],
    CAMERA_INFO: lambda _: [Guess("camera_info", 1, "")],
    IMAGE: _images,
    COMPRESSED_IMAGE: _images,
    ODOMETRY: _odometry,
}
