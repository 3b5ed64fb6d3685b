"""Bags into a run folder."""

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import tomli_w

from odometry.arrays import FloatArray
from odometry.bags.files.damage import Losses
from odometry.bags.files.message_types import MessageTypes
from odometry.bags.files.topic import Connection, Message
from odometry.bags.plan import Plan
from odometry.bags.rows.lens_watch import LensWatch
from odometry.bags.rows.ordered_rows import OrderedRows
from odometry.bags.rows.places_watch import PlacesWatch
from odometry.bags.rows.pose_rows import Attitudes
from odometry.bags.rows.set_clock import set_back_table
from odometry.bags.rows.streams import Consumer, Stream
from odometry.bags.run_settings import run_settings
from odometry.bags.run_streams import Learned, make_streams
from odometry.bags.topics.survey import REPORT_EVERY, Progress, Survey
from odometry.bags.wheels.speeds import TreadSpeeds
from odometry.errors import BagError
from odometry.fixes.local_metres import LocalMetres

MOST_REASONS = 3
MOST_TOO_FAST = 0.1  # of differences of places; an encoder is reset far more rarely


@dataclass(frozen=True)
class Imported:
    """What an import wrote.

    Attributes
    ----------
    rows : dict of str
        Rows by file of the run folder, and the topic each comes from.
    notes : tuple of str
        What was decided, and why.
    losses : tuple of str
        What could not be read or was dropped.
    """

    rows: dict[str, tuple[int, str]]
    notes: tuple[str, ...]
    losses: tuple[str, ...]


def write_run(
    survey: Survey, plan: Plan, types: MessageTypes, folder: Path, progress: Progress
) -> Imported:
    """Read the files of a survey a second time, and write a run folder.

    Memory does not grow with the size of the bags.

    Parameters
    ----------
    survey : Survey
    plan : Plan
    types : MessageTypes
    folder : Path
        Empty.
    progress : callable
        Called with numbers of messages that were read since the call before.

    Raises
    ------
    BagError
        If there is no row of wheel speeds in the end, or wheels of a side contradict each other.
    """
    local, speeds = LocalMetres(), TreadSpeeds(plan.wheels, plan.separation_m)
    with closing(Attitudes(_robot_from_imu(plan, survey))) as attitudes:
        lens = LensWatch(plan.camera_info)
        places = PlacesWatch(plan.wheels, plan.robot.wheel_radius_m)
        learned = Learned(speeds, local, attitudes, lens, places)
        streams = make_streams(plan, survey, folder, learned)
        every = [one for several in streams.values() for one in several]
        for file in survey.files:
            for consumer in every:
                consumer.begin_file()
            _read(file.messages(Losses()), streams, types, progress)
        made = [one for one in every if isinstance(one, Stream)]
        for stream in made:
            stream.sink.close()
        wheels, *others = made
        lost = [
            *lost_of(wheels, speeds.too_fast),
            *(line for one in others for line in lost_of(one)),
        ]
        losses = (*survey.losses, *speeds.lost(), *lost)
        _check_wheels(wheels, speeds, losses, of_places=not plan.wheels.speeds)
        places.check()
        of_wheels = [
            *speeds.half_turns(),
            *speeds.agreement.verdict(),
            *speeds.counters.notes(plan.wheels.topic),
        ]
        of_attitudes = _attitudes_added(attitudes, plan.imu, folder)
    settings, notes = run_settings(plan, survey, local, losses)
    seen = [*of_wheels, *lens.notes()]
    settings["source"]["notes"] += seen
    rows_of = {one.topic: one.sink for one in made if isinstance(one.sink, OrderedRows)}
    if set_back := set_back_table({topic: of.clock for topic, of in rows_of.items()}):
        settings["source"]["clock_set_back"] = set_back
    (folder / "run.toml").write_text(tomli_w.dumps(settings), encoding="utf-8")
    rows = {one.file: (one.sink.written, one.topic) for one in made if one.sink.written}
    return Imported(rows, (*plan.notes, *notes, *seen, *of_attitudes), losses)


def _check_wheels(
    wheels: Stream, speeds: TreadSpeeds, losses: tuple[str, ...], *, of_places: bool
) -> None:
    """Raise BagError where no wheel speeds are left, or too few to believe the others."""
    if not wheels.sink.written:
        raise BagError(f"no wheel speed could be read: {'; '.join(losses)}")
    share = speeds.too_fast / (speeds.too_fast + wheels.sink.written)
    if of_places and share > MOST_TOO_FAST:
        raise BagError(
            f"{100 * share:.0f} % of the wheel speeds are impossible. {speeds.lost()[0]}"
        )


def _robot_from_imu(plan: Plan, survey: Survey) -> FloatArray:
    """Rotation (3, 3) of the inertial sensor's axes into the robot's; none where it is not said."""
    pose = plan.robot.pose_of(plan.frames.get(plan.imu, ""), survey.robot)
    return np.eye(3) if pose is None else pose[:3, :3]


def _attitudes_added(attitudes: Attitudes, topic: str, folder: Path) -> list[str]:
    """Put roll and pitch into odometry.csv where they can be trusted; what is to be said of it."""
    if not attitudes.written:
        return []
    if doubt := attitudes.doubt():
        return [f"{topic}: its orientation is not used: {doubt}"]
    attitudes.into(folder / "odometry.csv")
    return [f"odometry.csv: roll and pitch from the orientation of {topic}"]


def _read(
    messages: Iterator[Message],
    streams: dict[str, list[Consumer]],
    types: MessageTypes,
    progress: Progress,
) -> None:
    wanted: dict[int, tuple[Connection, list[Consumer]]] = {}
    count = 0
    for message in messages:
        count += 1
        if count % REPORT_EVERY == 0:
            progress(REPORT_EVERY)
        key = id(message.connection)
        if key not in wanted:
            wanted[key] = message.connection, streams.get(message.connection.topic, [])
        _, of_topic = wanted[key]
        if not of_topic:
            continue
        try:
            content = types.decode(message)
        except BagError as problem:
            of_topic[0].dropped[str(problem)] += 1
            continue
        for stream in of_topic:
            stream.add(message, content)
    progress(count % REPORT_EVERY)


def lost_of(stream: Stream, said: int = 0) -> Iterator[str]:
    """Sentences on messages of a topic that did not become rows; nothing where all did.

    `said` rows without a number are reported elsewhere.
    """
    sink, topic = stream.sink, stream.topic
    if sink.repeated:
        yield f"{topic}: {sink.repeated} messages repeat the stamp of one before; dropped"
    if sink.back:
        far = getattr(sink, "farthest_back_s", 0.0)
        how_far = f", by up to {far:.3g} s" if far else ""
        yield (
            f"{topic}: {sink.back} messages have a stamp that goes back{how_far}; dropped "
            "(--time log takes the times at which the bag received them)"
        )
    if isinstance(sink, OrderedRows) and sink.clock.left_out:
        yield (
            f"{topic}: {sink.clock.left_out} messages have stamps that had been there, as a clock "
            "was set back; dropped (--time log takes the times at which the bag received them)"
        )
    if incomplete := getattr(sink, "incomplete", 0) - said:
        yield f"{topic}: {incomplete} rows lack a number that {stream.file} needs; dropped"
    reasons = stream.dropped.most_common()
    for reason, count in reasons[:MOST_REASONS]:
        yield f"{topic}: {count} messages dropped: {reason}"
    if len(reasons) > MOST_REASONS:
        rest = sum(count for _, count in reasons[MOST_REASONS:])
        yield f"{topic}: {rest} more messages dropped for other reasons"
    if not sink.written:
        yield f"{topic}: nothing of it could be used{stream.gap()}; there is no {stream.file}"
