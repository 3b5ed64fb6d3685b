"""Rows of satellite fixes in messages: latitude, longitude, altitude."""

from collections.abc import Callable
from typing import Any

import numpy as np

from odometry.bags.files.topic import PLACE, Topic, farthest
from odometry.bags.topics.message_fields import check_frame
from odometry.errors import BagError
from odometry.fixes.local_metres import on_earth, zeros_within_deg

Row = tuple[float, ...]


def sensor_frame(topic: Topic, said: str) -> str:
    """The frame of the one of several sensors on a topic that is taken: as said, else of most."""
    return said if said in topic.frames else topic.frames[0]


def fix_reader(topic: Topic, antenna: str) -> Callable[[Any], Row]:
    """A function that takes latitude, longitude [degrees] and altitude [m] out of a NavSatFix.

    It raises BagError where there was no fix (the message says so, or has no numbers, or zeros
    that are no place), and where it is of another antenna than the one of this frame.
    """
    taken = sensor_frame(topic, antenna)
    zeros_deg = zeros_within_deg(farthest(topic.ranges, PLACE, ["latitude", "longitude"]))

    def read(message: Any) -> Row:
        place = np.array([message.latitude, message.longitude])
        if message.status.status < 0 or not np.isfinite(place).all():
            raise BagError("no fix")
        if (np.abs(place) <= zeros_deg).all():
            raise BagError("no fix (latitude and longitude are zero)")
        if not on_earth(place[None])[0]:
            raise BagError("no place on Earth (latitude beyond 90 degrees)")
        check_frame(message, taken, "receiver", "reference")
        return message.latitude, message.longitude, message.altitude

    return read
