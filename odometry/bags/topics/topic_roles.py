"""Which topic has which role: as the user says (a map in TOML, options), else as guessed."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from odometry.bags.files.topic import Topic
from odometry.bags.topics.message_fields import POSES
from odometry.bags.topics.topic_guess import best, camera_info_beside, guess
from odometry.errors import BagError
from odometry.io.structured import read_toml

TIMES = ("auto", "header", "log")
NONE = "none"  # as a topic: leave this out
# Keys by table, and the kinds of their values
KEYS: dict[str, dict[str, tuple[type, ...]]] = {
    "": {"time": (str,), "other_odometry": (list,)},
    "robot": {
        "name": (str,),
        "frame": (str,),
        "track_width": (int, float),
        "wheel_radius": (int, float),
        "length": (int, float),
        "width": (int, float),
        "mass": (int, float),
        "frame_height": (int, float),
    },
    "wheels": {
        "topic": (str,),
        "left": (list,),
        "right": (list,),
        "left_sign": (int, float),
        "right_sign": (int, float),
        "gear": (int, float),
        "unit": (str,),
        "values": (str,),
        "separation": (int, float),
    },
    "imu": {"topic": (str,), "frame": (str,)},
    "reference": {"topic": (str,), "frame": (str,), "world": (str,)},
    "images": {"topic": (str,), "camera_info": (str,), "frame": (str,)},
}
WHAT = {str: "a text", list: "a list", int: "a number", float: "a number"}


@dataclass(frozen=True)
class TopicMap:
    """What a map and the options say; what they do not say is guessed.

    Attributes
    ----------
    time : str
        "header", "log", or "auto".
    other_odometry : tuple of str, or None
        Topics kept beside the run; None: all that are guessed.
    robot, wheels, imu, reference, images : Mapping
        Tables of the map, see KEYS.
    """

    time: str = "auto"
    other_odometry: tuple[str, ...] | None = None
    robot: Mapping[str, Any] = field(default_factory=dict)
    wheels: Mapping[str, Any] = field(default_factory=dict)
    imu: Mapping[str, Any] = field(default_factory=dict)
    reference: Mapping[str, Any] = field(default_factory=dict)
    images: Mapping[str, Any] = field(default_factory=dict)

    def overridden(self, options: Mapping[str, Any]) -> "TopicMap":
        """The same with options: `time`, or "table.key" for a key of a table; None is unsaid."""
        changed: dict[str, Any] = {}
        for name, value in options.items():
            table, _, key = name.rpartition(".")
            if value is None:
                continue
            if not table:
                changed[key] = value
            else:
                changed[table] = {**changed.get(table, getattr(self, table)), key: value}
        return replace(self, **changed)


def read_topic_map(file: Path) -> TopicMap:
    """Read a map of topics.

    Raises
    ------
    BagError
        If the file cannot be read, or holds a key or a value that is not expected.
    """
    content = read_toml(file, BagError)
    tables = {name: value for name, value in content.items() if isinstance(value, dict)}
    for name in sorted(content.keys() & KEYS.keys() - tables.keys()):
        raise BagError(
            f"{file}: {name} = {content[name]!r}, expected a table [{name}] with keys such as "
            f"{', '.join(list(KEYS[name])[:3])}"
        )
    _check(content.keys() - tables.keys(), content, "", str(file))
    for name, table in tables.items():
        if name not in KEYS:
            raise BagError(f"{file}: [{name}]: {_expected(name, KEYS)}")
        _check(table.keys(), table, name, f"{file}: [{name}]")
    if content.get("time", "auto") not in TIMES:
        raise BagError(f"{file}: time = {content['time']!r}, expected one of {', '.join(TIMES)}")
    other = content.get("other_odometry")
    kept = tuple(map(str, other)) if other is not None else None
    return TopicMap(content.get("time", "auto"), kept, **tables)


def _check(keys: Any, table: Mapping[str, Any], name: str, where: str) -> None:
    for key in keys:
        kinds = KEYS[name].get(key)
        if kinds is None:
            raise BagError(f"{where}: {key}: {_expected(key, KEYS[name])}")
        if isinstance(table[key], bool) or not isinstance(table[key], kinds):
            raise BagError(f"{where}: {key} = {table[key]!r}, expected {WHAT[kinds[0]]}")


def _expected(key: str, known: Mapping[str, Any]) -> str:
    near = get_close_matches(key, list(known), n=1)
    meant = f"did you mean {near[0]}? " if near else ""
    return f"there is no such key; {meant}Known: {', '.join(filter(None, known))}"


PARTLY = 0.05  # of the messages: the first ones, before a clock is known, are fewer
SAME_CLOCK_S = 2.0  # header stamps and times of reception that differ by less share a clock


def topic_for(
    topics: Mapping[str, Topic],
    topic_map: Mapping[str, Any],
    role: str,
    kinds: tuple[str, ...],
    guessed_from: Mapping[str, Topic],
) -> str:
    """Name of the topic for a role; empty where there is none, or none is wanted."""
    said = topic_map.get("topic")
    if said is None:
        return best(guessed_from, role) or ""
    if said == NONE:
        return ""
    topic = topic_named(topics, said)
    if topic.message_type not in kinds:
        raise BagError(
            f"{said}: {topic.message_type} cannot be used as {role}; expected {', '.join(kinds)}"
        )
    if topic.sample is None:
        raise BagError(f"{said}: no message of it can be read: {topic.problem}")
    return topic.name


def topic_named(topics: Mapping[str, Topic], name: str) -> Topic:
    """The topic of a name, with or without its first slash; BagError where there is none."""
    found = topics.get(name) or topics.get(f"/{name}")
    if found is None:
        raise BagError(f"there is no topic {name!r} in the bag; topics: {', '.join(topics)}")
    return found


def camera_info_of(topics: Mapping[str, Topic], topic_map: Mapping[str, Any], images: str) -> str:
    """The CameraInfo that goes with an image topic: said, else the one of the same folder."""
    if not images:
        return ""
    said = topic_map.get("camera_info")
    if said == NONE:
        return ""
    if said is not None:
        return topic_named(topics, said).name
    return camera_info_beside(topics, images)


def other_odometry_of(
    topics: Mapping[str, Topic],
    said: tuple[str, ...] | None,
    reference: str,
    guessed_from: Mapping[str, Topic],
) -> tuple[str, ...]:
    """Topics whose poses are kept beside the run."""
    if said is not None:
        names = [topic_named(topics, name) for name in said]
        wrong = [topic.name for topic in names if topic.message_type not in POSES]
        if wrong:
            raise BagError(f"{wrong[0]}: there are no poses in it to keep as other odometry")
        return tuple(topic.name for topic in names)
    return tuple(
        name
        for name, topic in guessed_from.items()
        if name != reference and any(one.role == "other_odometry" for one in guess(topic))
    )


def clock_of(used: list[Topic], requested: str) -> tuple[bool, list[str]]:
    """Whether header stamps are taken, and what is to be said of it."""
    if requested != "auto":
        return requested == "header", []
    offsets = [one.header_offset_s for one in used if one.header_offset_s is not None]
    if not offsets:
        return False, []
    back = max(used, key=lambda one: one.clock_back_s)
    if back.clock_back_s > SAME_CLOCK_S:
        return False, [
            f"times: those of reception, as header stamps of {back.name} go back by "
            f"{back.clock_back_s:.3g} s: their clock was set, or began anew (--time header takes "
            "the stamps all the same, and drops what goes back)"
        ]
    partly = [one.name for one in used if PARTLY < one.unstamped < 1]
    if partly:
        return False, [
            f"times: those of reception, as messages of {', '.join(partly)} have header stamps in "
            "part only (--time header takes these for the stamps, and reception for the others)"
        ]
    unstamped = [one.name for one in used if one.header_offset_s is None]
    spread = max([*offsets, *(0.0 for _ in unstamped)]) - min([*offsets, *(0.0 for _ in unstamped)])
    if spread <= SAME_CLOCK_S:
        return True, []
    return False, [
        f"times: those of reception, as the clocks of header stamps differ by {spread:.3g} s "
        "(--time header takes the stamps all the same)"
    ]
