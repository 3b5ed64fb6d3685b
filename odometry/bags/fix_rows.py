"""Rows of satellite fixes in messages: latitude, longitude, altitude."""

from collections.abc import Callable
from typing import Any

import numpy as np

from odometry.bags.message_fields import body_frame
from odometry.bags.topic import PLACE, Topic, farthest
from odometry.errors import BagError
from odometry.fixes.local_metres import on_earth, zeros_within_deg

Row = tuple[float, ...]


def fix_reader(topic: Topic, antenna: str) -> Callable[[Any], Row]:
    """A function that takes latitude, longitude [degrees] and altitude [m] out of a NavSatFix.

    It raises BagError where there was no fix (the message says so, or has no numbers, or zeros
    that are no place), and where it is of another antenna than the one of this frame.
    """
    taken = antenna if antenna in topic.frames else body_frame(topic.sample)
    zeros_deg = zeros_within_deg(farthest(topic.ranges, PLACE, ["latitude", "longitude"]))

    def read(message: Any) -> Row:
        place = np.array([message.latitude, message.longitude])
        if message.status.status < 0 or not np.isfinite(place).all():
            raise BagError("no fix")
        if (np.abs(place) <= zeros_deg).all():
            raise BagError("no fix (latitude and longitude are zero)")
        if not on_earth(place[None])[0]:
            raise BagError("no place on Earth (latitude beyond 90 degrees)")
        if (frame := body_frame(message)) != taken:
            raise BagError(
                f"of {frame or 'no frame'}, another receiver on this topic; {taken or 'no frame'} "
                "is taken (frame of [reference] in a map says which)"
            )
        return message.latitude, message.longitude, message.altitude

    return read
