"""What is taken from which topic: guesses, and what the user says instead."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from odometry.bags.errors import BagError
from odometry.bags.guess import LIKELY, best, guess
from odometry.bags.message_kinds import (
    CAMERA_INFO,
    FIX,
    IMAGES,
    IMU,
    POSES,
    TRANSFORM_LISTS,
    body_frame,
)
from odometry.bags.robot_frame import HOW_TRACK, RobotFrame, robot_frame
from odometry.bags.survey import Survey, Topic
from odometry.bags.wheel_source import WheelSource, wheel_source
from odometry.bags.wishes import NONE, Wishes

SAME_CLOCK_S = 2.0  # header stamps and times of reception that differ by less share a clock


@dataclass(frozen=True)
class Plan:
    """What is taken from which topic.

    Attributes
    ----------
    robot : RobotFrame
    wheels : WheelSource
    separation_m : float
        Between the sides, by which a twist is parted into tread speeds.
    imu, reference, images, camera_info : str
        Names of topics; empty where none is taken.
    frames : Mapping of topic to str
        The frame whose motion or readings a topic tells.
    world : str
        Of a reference taken from transforms: the frame in which poses are wanted.
    other_odometry : tuple of str
    by_header : bool
        Whether header stamps are taken where messages have them; else times of reception.
    notes : tuple of str
        What was decided, and why.
    """

    robot: RobotFrame
    wheels: WheelSource
    separation_m: float
    imu: str
    reference: str
    images: str
    camera_info: str
    world: str
    other_odometry: tuple[str, ...]
    by_header: bool
    notes: tuple[str, ...]
    frames: Mapping[str, str] = field(default_factory=dict)


def make_plan(survey: Survey, wishes: Wishes) -> Plan:
    """Decide what is taken from which topic.

    Raises
    ------
    BagError
        If there are no wheel speeds, a number of the robot is missing, or the user names a topic
        that is not there or of another kind: it says what to give.
    """
    topics = survey.topics
    reference = _topic(topics, wishes.reference, "reference", (*POSES, FIX, *TRANSFORM_LISTS))
    bodies = [body_frame(one.sample) for one in topics.values() if one.sample is not None]
    robot = robot_frame(survey.robot, wishes.robot, filter(None, bodies))
    wheels = _wheels(topics, wishes.wheels, reference, robot)
    separation = wishes.wheels.get("separation", robot.track_width_m)
    if robot.track_width_m is None:
        raise BagError(
            "the track width of the robot is not known, and no robot description in the bag gives "
            f"it: add --track-width METRES. To measure it, {HOW_TRACK}"
        )
    imu = _topic(topics, wishes.imu, "imu", (IMU,))
    images = _topic(topics, wishes.images, "images", IMAGES)
    info = _camera_info(topics, wishes.images, images)
    named = {imu: wishes.imu, reference: wishes.reference, images: wishes.images}
    frames = {
        name: str(said.get("frame") or _frame_of(topics[name], robot)).lstrip("/")
        for name, said in named.items()
        if name
    }
    other = _other_odometry(topics, wishes.other_odometry, reference)
    used = [topics[name] for name in (wheels.topic, imu, reference, images) if name]
    by_header, said = _clock(used, wishes.time)
    notes = [
        *robot.notes,
        f"wheel speeds: {wheels.topic}: {wheels.why}",
        *(f"{role}: {name}" for role, name in _named(imu, reference, images, info) if name),
        *said,
    ]
    return Plan(
        robot,
        wheels,
        float(separation or robot.track_width_m),
        imu,
        reference,
        images,
        info,
        str(wishes.reference.get("world", "map")),
        other,
        by_header,
        tuple(notes),
        frames,
    )


def _frame_of(topic: Topic, robot: RobotFrame) -> str:
    """The frame that a topic tells of; a list of transforms tells of the robot's."""
    lists = topic.message_type in TRANSFORM_LISTS
    return robot.base if lists else body_frame(topic.sample)


def _named(imu: str, reference: str, images: str, info: str) -> list[tuple[str, str]]:
    return [("imu", imu), ("reference", reference), ("images", images), ("camera", info)]


def _topic(
    topics: Mapping[str, Topic], wishes: Mapping[str, Any], role: str, kinds: tuple[str, ...]
) -> str:
    """Name of the topic for a role; empty where there is none, or none is wanted."""
    said = wishes.get("topic")
    if said is None:
        return best(topics, role) or ""
    if said == NONE:
        return ""
    topic = _there(topics, said)
    if topic.message_type not in kinds:
        raise BagError(
            f"{said}: {topic.message_type} cannot be used as {role}; expected {', '.join(kinds)}"
        )
    if topic.sample is None:
        raise BagError(f"{said}: no message of it can be read: {topic.problem}")
    return topic.name


def _there(topics: Mapping[str, Topic], name: str) -> Topic:
    found = topics.get(name) or topics.get(f"/{name}")
    if found is None:
        raise BagError(f"there is no topic {name!r} in the bag; topics: {', '.join(topics)}")
    return found


def _wheels(
    topics: Mapping[str, Topic], wishes: Mapping[str, Any], reference: str, robot: RobotFrame
) -> WheelSource:
    named = wishes.get("topic")
    left = {name: topic for name, topic in topics.items() if name != reference}
    name = _there(topics, named).name if named else best(left, "wheels")
    if name is None:
        near = [
            f"{name} ({topic.message_type}: {one.why})"
            for name, topic in left.items()
            for one in guess(topic)
            if one.rank >= LIKELY
        ]
        seen = f"; perhaps one of {', '.join(near)}" if near else ""
        raise BagError(
            f"no topic is known to hold measured wheel speeds{seen}. Name it with --wheels TOPIC; "
            "--list shows all topics"
        )
    return wheel_source(topics[name], wishes, robot.wheel_radius_m)


def _camera_info(topics: Mapping[str, Topic], wishes: Mapping[str, Any], images: str) -> str:
    """The CameraInfo that goes with an image topic: said, else the one of the same folder."""
    if not images:
        return ""
    said = wishes.get("camera_info")
    if said == NONE:
        return ""
    if said is not None:
        return _there(topics, said).name
    folder = images.rsplit("/", 1)[0]
    while folder:
        name = f"{folder}/camera_info"
        if name in topics and topics[name].message_type == CAMERA_INFO:
            return name
        folder = folder.rsplit("/", 1)[0]
    return ""


def _other_odometry(
    topics: Mapping[str, Topic], said: tuple[str, ...] | None, reference: str
) -> tuple[str, ...]:
    if said is not None:
        names = [_there(topics, name) for name in said]
        wrong = [topic.name for topic in names if topic.message_type not in POSES]
        if wrong:
            raise BagError(f"{wrong[0]}: there are no poses in it to keep as other odometry")
        return tuple(topic.name for topic in names)
    return tuple(
        name
        for name, topic in topics.items()
        if name != reference and any(one.role == "other_odometry" for one in guess(topic))
    )


def _clock(used: list[Topic], wished: str) -> tuple[bool, list[str]]:
    """Whether header stamps are taken, and what is to be said of it."""
    if wished != "auto":
        return wished == "header", []
    offsets = [one.header_offset_s for one in used if one.header_offset_s is not None]
    if not offsets:
        return False, []
    unstamped = [one.name for one in used if one.header_offset_s is None]
    spread = max([*offsets, *(0.0 for _ in unstamped)]) - min([*offsets, *(0.0 for _ in unstamped)])
    if spread <= SAME_CLOCK_S:
        return True, []
    return False, [
        f"times: those of reception, as the clocks of header stamps differ by {spread:.3g} s "
        "(--time header takes the stamps all the same)"
    ]
