"""Tread speeds from wheel speeds, wheel places, twists and poses of odometry."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.bags.topics.message_fields import TWISTS, number_at
from odometry.bags.topics.wheel_names import is_wheel, side_of
from odometry.bags.wheels.counters import Counters
from odometry.bags.wheels.side_agreement import SideAgreement
from odometry.bags.wheels.wheel_source import WheelSource
from odometry.errors import BagError
from odometry.geometry.angles import wrap

MOST_NAMED = 6  # wheels in a sentence
# Of a turn between two messages: places within one turn do not say which way a wheel turned by half
# a one. Of the moving ones such a share is near it where some are beyond.
FAR_TURN, MOVING_TURN, FAR_SHARE, LEAST_FAR = 0.4, 0.02, 0.02, 5
FASTEST_M_S = 50.0  # no robot's tread is faster: an encoder was reset, or a number is broken
Row = tuple[float, ...]


def row_reader(source: WheelSource, message_type: str) -> Callable[[Any], Row]:
    """A function that takes the numbers of a source out of a message.

    It raises BagError where a message does not hold them.
    """
    if source.kind == "joints":
        return _joints(source)
    if source.kind == "fields":
        readers = [number_at(path) for path in source.left + source.right]
        return lambda message: tuple(read(message) for read in readers)
    if source.speeds:
        twist_of = TWISTS[message_type]

        def twist_row(message: Any) -> Row:
            twist = twist_of(message)
            return twist.linear.x, twist.angular.z

        return twist_row
    return _pose_row


def _pose_row(message: Any) -> Row:
    place, turn = message.pose.pose.position, message.pose.pose.orientation
    sine = 2 * (turn.w * turn.z + turn.x * turn.y)
    return place.x, place.y, math.atan2(sine, 1 - 2 * (turn.y**2 + turn.z**2))


def _joints(source: WheelSource) -> Callable[[Any], Row]:
    wanted = source.left + source.right
    places: dict[tuple[str, ...], list[int] | None] = {}

    def read(message: Any) -> Row:
        names = tuple(message.name)
        if names not in places:
            there = all(name in names for name in wanted)
            places[names] = [names.index(name) for name in wanted] if there else None
        found = places[names]
        values = message.velocity if source.speeds else message.position
        if found is None:
            raise BagError(_other_joints(names))
        if len(values) < len(names):
            kind = "velocities" if source.speeds else "positions"
            raise BagError(f"a message with fewer {kind} than joints")
        return tuple(float(values[place]) for place in found)

    return read


def _other_joints(names: tuple[str, ...]) -> str:
    """Why a message without all wheels is dropped."""
    wheels = [name for name in names if is_wheel(name) and side_of(name)]
    if not wheels:
        return "a message without wheels"
    more = ", ..." if len(wheels) > MOST_NAMED else ""
    return (
        f"a message of other wheels ({', '.join(wheels[:MOST_NAMED])}{more}): wheels that come in "
        "messages of their own are not put together; --left and --right choose among them"
    )


class TreadSpeeds:
    """Turns rows of a source into tread speeds (left, right) [m/s], in the order of time.

    A difference of two places is the speed from the stamp of the first on, as a speed of
    odometry.csv holds until the next stamp.

    Attributes
    ----------
    agreement : SideAgreement
        Whether the wheels of each side, whose mean is taken, agree.
    counters : Counters
        Of places that are whole numbers.
    too_fast : int
        Rows with a tread faster than FASTEST_M_S, which become NaN.
    """

    def __init__(self, source: WheelSource, separation_m: float) -> None:
        self._source = source
        self._separation_m = separation_m
        self._held: tuple[IntArray, FloatArray] | None = None
        self.agreement = SideAgreement(source)
        self.counters = Counters()
        self.too_fast = 0
        self._far = self._moving = 0

    def __call__(self, stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """Stamps (M,) and tread speeds (M, 2) of rows (N, k)."""
        source = self._source
        if not source.speeds:
            stamps_ns, rows = self._differences(stamps_ns, rows)
        if source.kind == "twist":
            half = rows[:, 1] * self._separation_m / 2
            left, right = source.left_factor * (rows[:, 0] - half), rows[:, 0] + half
            speeds = np.column_stack([left, source.right_factor * right])
        else:
            count = len(source.left)
            left = source.left_factor * rows[:, :count]
            right = source.right_factor * rows[:, count:]
            self.agreement.add(stamps_ns, np.hstack([left, right]))
            speeds = np.column_stack([left.mean(axis=1), right.mean(axis=1)])
        fast = np.abs(speeds) > FASTEST_M_S
        self.too_fast += int(np.count_nonzero(fast.any(axis=1)))
        return stamps_ns, np.where(fast, np.nan, speeds)

    def lost(self) -> list[str]:
        """What is to be said of rows that are too fast."""
        if not self.too_fast:
            return []
        source = self._source
        begin = f"{source.topic}: {self.too_fast} rows above {FASTEST_M_S:g} m/s are left out"
        unit = f" the unit ({source.unit})" if source.unit else " it"
        if source.speeds:
            return [f"{begin}; is{unit} right? See --unit"]
        return [
            f"{begin}: between two messages a wheel turned impossibly far. Its encoder was reset, "
            f"or{unit} is wrong: see --unit"
        ]

    def half_turns(self) -> list[str]:
        """What is to be said of wheels that turn by half a turn between two messages.

        Raises
        ------
        BagError
            If the user does not state that positions are to be taken.
        """
        far, moving = self._far + self.counters.far, self._moving + self.counters.moved
        if far < max(LEAST_FAR, FAR_SHARE * moving):
            return []
        what = "positions within one turn change by nearly half a turn"
        if self.counters.far:
            what = "a counter changes by nearly half of its size"
        said = (
            f"{what} between two messages ({far} of {moving} changes): whether a wheel turned by "
            "less one way or by more the other is not known. Record them more often, or velocities"
        )
        if self._source.values_stated:
            return [f"warning: {said}"]
        how = 'values = "position" in [wheels] of a map takes them all the same'
        raise BagError(f"{self._source.topic}: {said}; {how}")

    def _differences(self, stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """Rates of change (N - 1, k) of places, with the last row of the call before."""
        if self._held is not None:
            stamps_ns = np.concatenate([self._held[0], stamps_ns])
            rows = np.concatenate([self._held[1], rows])
        self._held = stamps_ns[-1:], rows[-1:]
        seconds = np.diff(stamps_ns)[:, None] / 1e9
        if self._source.kind == "twist":
            return stamps_ns[:-1], _twists(rows, np.diff(rows, axis=0)) / seconds
        steps = self.counters.steps(rows)
        if np.isfinite(self._source.wraps_at):
            turn = self._source.wraps_at
            steps -= turn * np.rint(steps / turn)
            self._far += int(np.count_nonzero(np.abs(steps) > FAR_TURN * turn))
            self._moving += int(np.count_nonzero(np.abs(steps) > MOVING_TURN * turn))
        return stamps_ns[:-1], steps / seconds


def _twists(poses: FloatArray, steps: FloatArray) -> FloatArray:
    """Way ahead [m] and turn [rad] (N - 1, 2) between poses x, y, yaw."""
    turns = wrap(steps[:, 2])
    middle = poses[:-1, 2] + turns / 2
    chord = np.cos(middle) * steps[:, 0] + np.sin(middle) * steps[:, 1]
    return np.column_stack([chord / np.sinc(turns / (2 * np.pi)), turns])
