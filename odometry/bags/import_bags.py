"""Bags into a run folder."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import tomli_w

from odometry.bags.connection import Connection, Message
from odometry.bags.errors import BagError
from odometry.bags.losses import Losses
from odometry.bags.make_streams import make_streams
from odometry.bags.message_types import MessageTypes
from odometry.bags.plan import Plan
from odometry.bags.poses import LocalMetres
from odometry.bags.run_settings import run_settings
from odometry.bags.streams import Stream
from odometry.bags.survey import REPORT_EVERY, Progress, Survey
from odometry.bags.what_was_lost import lost_of


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
        If there is no row of wheel speeds in the end.
    """
    local = LocalMetres()
    streams = make_streams(plan, survey, folder, local)
    for file in survey.files:
        _read(file.messages(Losses()), streams, types, progress)
    made = [one for several in streams.values() for one in several]
    for stream in made:
        stream.sink.close()
    losses = (*survey.losses, *(line for stream in made for line in lost_of(stream)))
    if not (folder / "odometry.csv").exists():
        raise BagError(f"no wheel speed could be read: {'; '.join(losses)}")
    settings, notes = run_settings(plan, survey, local, losses)
    (folder / "run.toml").write_text(tomli_w.dumps(settings), encoding="utf-8")
    rows = {one.file: (one.sink.written, one.topic) for one in made if one.sink.written}
    return Imported(rows, (*plan.notes, *notes), losses)


def _read(
    messages: Iterator[Message],
    streams: dict[str, list[Stream]],
    types: MessageTypes,
    progress: Progress,
) -> None:
    wanted: dict[int, tuple[Connection, list[Stream]]] = {}
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
