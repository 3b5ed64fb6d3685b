"""What is taken from which topic: guesses, and what the user says instead."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from odometry.bags.choice_notes import (
    equal_topics,
    reference_notes,
    restated_frames,
    wheel_notes,
)
from odometry.bags.files.topic import Topic
from odometry.bags.topics.imu_fields import not_measured
from odometry.bags.topics.message_fields import (
    FIX,
    IMAGES,
    IMU,
    POINT,
    POSES,
    TRANSFORM_LISTS,
    body_frame,
)
from odometry.bags.topics.robot_frame import HOW_TRACK, RobotFrame, robot_frame
from odometry.bags.topics.robots import own_topics
from odometry.bags.topics.survey import Survey
from odometry.bags.topics.topic_roles import (
    TopicMap,
    camera_info_of,
    clock_of,
    other_odometry_of,
    topic_for,
)
from odometry.bags.wheels.wheel_choice import wheel_topic
from odometry.bags.wheels.wheel_source import WheelSource, wheel_source
from odometry.errors import BagError

REFERENCES = (*POSES, FIX, POINT, *TRANSFORM_LISTS)


@dataclass(frozen=True)
class Plan:
    """What is taken from which topic.

    Attributes
    ----------
    robot : RobotFrame
    wheels : WheelSource
    separation_m : float
        Between the sides, by which a twist is divided into tread speeds.
    imu, reference, images, camera_info : str
        Names of topics; empty where none is taken.
    frames : Mapping of topic to str
        The frame whose motion or readings a topic holds.
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


TRACK = ("--track-width METRES",)
NO_TRACK = (
    "the track width of the robot is not known, and no robot description in the bag gives it: add "
    f"{TRACK[0]}. To measure it, {HOW_TRACK}"
)


def make_plan(survey: Survey, topic_map: TopicMap) -> Plan:
    """Decide what is taken from which topic.

    Raises
    ------
    BagError
        If there are no wheel speeds, a number of the robot is missing, or the user names a topic
        that is not there or of another kind: it says what to give.
    """
    everything = survey.topics
    taken = wheel_topic(everything, topic_map.wheels, topic_map.reference)
    own = own_topics(everything, taken)
    topics = own.topics
    survey.robot.use_robot(own.robot)
    bodies = [body_frame(one.sample) for one in topics.values() if one.sample is not None]
    robot = robot_frame(survey.robot, topic_map.robot, filter(None, bodies), own.robot)
    try:
        wheels = wheel_source(everything[taken], topic_map.wheels, robot.wheel_radius_m)
    except BagError as problem:
        if robot.track_width_m is None:
            raise BagError(f"{problem}. And {NO_TRACK}", problem.options + TRACK) from problem
        raise
    separation = topic_map.wheels.get("separation", robot.track_width_m)
    if robot.track_width_m is None:
        raise BagError(NO_TRACK, TRACK)
    reference = _reference(everything, topics, topic_map, taken)
    world = _world(everything, topic_map, reference, survey)
    imu = topic_for(everything, topic_map.imu, "imu", (IMU,), topics)
    images = topic_for(everything, topic_map.images, "images", IMAGES, topics)
    info = camera_info_of(everything, topic_map.images, images)
    named = {imu: topic_map.imu, reference: topic_map.reference, images: topic_map.images}
    frames = {
        name: str(said.get("frame") or _frame_of(everything[name], robot)).lstrip("/")
        for name, said in named.items()
        if name
    }
    other = other_odometry_of(everything, topic_map.other_odometry, reference, topics)
    used = [everything[name] for name in (wheels.topic, imu, reference, images) if name]
    by_header, said = clock_of(used, topic_map.time)
    by_role = {"imu": imu, "reference": reference, "images": images}
    notes = [
        *robot.notes,
        f"wheel speeds: {wheels.topic}: {wheels.why}",
        *(f"{role}: {name}" for role, name in {**by_role, "camera": info}.items() if name),
        *said,
        *(not_measured(everything[imu]) if imu else ()),
        *own.notes,
        *wheel_notes(everything, topic_map.wheels, taken),
        *reference_notes(topics, topic_map.reference, reference),
        *restated_frames(survey.robot, frames),
        *equal_topics(topics, topic_map, {"wheels": taken, **by_role}),
        *_no_reference(topics, topic_map, reference, survey),
    ]
    return Plan(
        robot,
        wheels,
        float(separation or robot.track_width_m),
        imu,
        reference,
        images,
        info,
        world,
        other,
        by_header,
        tuple(notes),
        frames,
    )


def _reference(
    everything: Mapping[str, Topic], own: Mapping[str, Topic], topic_map: TopicMap, wheels: str
) -> str:
    """Topic of the reference; one that is guessed is not that of the wheels."""
    others = {name: topic for name, topic in own.items() if name != wheels}
    return topic_for(everything, topic_map.reference, "reference", REFERENCES, others)


def _world(topics: Mapping[str, Topic], topic_map: TopicMap, reference: str, survey: Survey) -> str:
    """The frame in which poses from transforms are wanted; empty where no transforms are taken."""
    if not reference or topics[reference].message_type not in TRANSFORM_LISTS:
        return ""
    frames = survey.robot.all.frames
    named = str(topic_map.reference.get("world", "map"))
    if named not in frames:
        raise BagError(
            f"{reference}: there is no frame {named!r}; name the one in which poses are wanted as "
            f"world in [reference] of a map; found: {', '.join(sorted(frames)[:24])}"
        )
    return named


def _frame_of(topic: Topic, robot: RobotFrame) -> str:
    """The frame that a topic describes; for a list of transforms that of the robot."""
    if topic.message_type in TRANSFORM_LISTS:
        return robot.base
    return topic.frames[0] if topic.frames else body_frame(topic.sample)


def _no_reference(
    topics: Mapping[str, Topic], topic_map: TopicMap, reference: str, survey: Survey
) -> Iterator[str]:
    """What is said where the odometry is compared with nothing."""
    if reference or "topic" in topic_map.reference:
        return
    transforms = [name for name, one in topics.items() if one.message_type in TRANSFORM_LISTS]
    moving = [name for name in transforms if not name.endswith("static")]
    if moving and "map" in survey.robot.all.frames:
        yield (
            f"reference: none. {moving[0]} holds the robot's position in the frame map: "
            f"--reference {moving[0]} takes it (a measurement only where SLAM or satellites made "
            "it)"
        )
    else:
        yield "reference: none; the run has no pose.csv"
