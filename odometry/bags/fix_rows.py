"""Rows of pose.csv from satellite fixes: metres east and north of the first one."""

from collections.abc import Callable
from typing import Any

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.bags.message_fields import body_frame
from odometry.bags.topic import PLACE, Topic, farthest
from odometry.errors import BagError

# A receiver without a fix writes zeros, or nearly so; a robot that was ever a degree away from
# there did not drive to it
NEAR_ZERO_DEG, FAR_DEG = 1e-3, 1.0
Row = tuple[float, ...]


def fix_reader(topic: Topic, antenna: str) -> Callable[[Any], Row]:
    """A function that takes latitude, longitude [degrees] and altitude [m] out of a NavSatFix.

    It raises BagError where there was no fix (the message says so, or has no numbers, or zeros),
    and where it is of another antenna than the one of this frame. Zeros are a place where the
    robot is near 0 N, 0 E all the time, as in some simulations.
    """
    taken = antenna if antenna in topic.frames else body_frame(topic.sample)
    farthest_deg = farthest(topic.ranges, PLACE, ["latitude", "longitude"])
    zeros_deg = NEAR_ZERO_DEG if farthest_deg > FAR_DEG or farthest_deg == 0 else -1.0

    def read(message: Any) -> Row:
        place = np.array([message.latitude, message.longitude])
        if message.status.status < 0 or not np.isfinite(place).all():
            raise BagError("no fix")
        if (np.abs(place) <= zeros_deg).all():
            raise BagError("no fix (latitude and longitude are zero)")
        if (frame := body_frame(message)) != taken:
            raise BagError(
                f"of {frame or 'no frame'}, another receiver on this topic; {taken or 'no frame'} "
                "is taken (frame of [reference] in a map says which)"
            )
        return message.latitude, message.longitude, message.altitude

    return read


class LocalMetres:
    """Turns geodetic places into metres east, north and up of the first one."""

    def __init__(self) -> None:
        self.origin: tuple[float, float, float] | None = None

    def __call__(self, stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """Columns (N, 4): x (east), y (north), yaw (NaN), z (up)."""
        from pymap3d import geodetic2enu  # noqa: PLC0415 - only bags with fixes need it

        if not len(rows):
            return stamps_ns, np.empty((0, 4))
        if self.origin is None:
            latitude, longitude, altitude = rows[0].tolist()
            self.origin = latitude, longitude, altitude if np.isfinite(altitude) else 0.0
        altitudes = np.where(np.isfinite(rows[:, 2]), rows[:, 2], self.origin[2])
        east, north, up = geodetic2enu(rows[:, 0], rows[:, 1], altitudes, *self.origin)
        return stamps_ns, np.column_stack([east, north, np.full(len(rows), np.nan), up])
