"""Frames made of messages while they come in."""

import math
from bisect import bisect_right, insort
from collections import Counter
from typing import Any

import numpy as np

from odometry.arrays import ByteImage, FloatArray
from odometry.recording.frames import Frame
from odometry.recording.sensors import SILENT_S, Gyroscope, step_integrals

UNKNOWN_SPEEDS = np.full(2, math.nan)
AHEAD_S = 5.0  # of the clock: one message alone is not believed
FEWEST, MANY = 5, 0.1  # messages of a kind that were too late, and their share, that are said
KINDS = {"tread_speeds_m_s": "treads", "image": "images", "pose": "poses", "velocity": "velocities"}


class LiveFrames:
    """Frames of the messages of a robot: those that `Run.frames` makes of the recording.

    Parameters
    ----------
    wait_s : float
        For how long a frame waits for messages with older stamps, such as images, which take
        their time. With 0 a message that comes after one with a later stamp may be too late.
    has_gyroscope : bool
        Whether a frame waits for the gyroscope as well, whose first sample at or after its stamp
        ends the turn until then; a gyroscope without samples for more than 0.5 s is not waited
        for.

    Attributes
    ----------
    too_late : int
        Messages that were dropped: older than a frame that was given, repeated, without a
        finite stamp, tread speed or yaw rate, with an infinite number, or alone more than 5 s
        ahead of the others. Where it grows, clocks do not agree or went back, or a driver gives
        no numbers.

    Notes
    -----
    Stamps are those of measurement, in seconds of one clock; the messages of one sensor come in
    order. Time goes on by treads and gyroscope: an image or a pose of a clock that is ahead waits
    for them. Where they stop, time goes on by the others, once two messages one after the other
    are more than 5 s ahead. The frames are the same to the last bit as those of the run folder,
    except for the first after the samples of the gyroscope ended.

    Examples
    --------
    >>> import odometry
    >>> live = odometry.LiveFrames(wait_s=0.1, has_gyroscope=False)
    >>> live.treads(0.0, 0.5, 0.5)
    >>> live.treads(0.2, 0.4, 0.6)
    >>> [frame.stamp_s for frame in live.ready()]  # the other may still get an image of its time
    [0.0]
    """

    def __init__(self, *, wait_s: float = 0.1, has_gyroscope: bool = True) -> None:
        self.too_late = 0
        self._wait_s = wait_s
        self._gyroscope = LiveGyroscope() if has_gyroscope else None
        self._clock_s = self._given_s = -math.inf
        self._ahead_s = math.inf  # the stamp far ahead of the clock that came last
        self._stamps_s: list[float] = []  # of what is to become frames, rising
        self._parts: dict[float, dict[str, Any]] = {}  # by stamp
        self._row = -1
        self._speeds = UNKNOWN_SPEEDS
        self._counts = Counter[str]()
        self._late_s: dict[str, tuple[int, float, float]] = {}  # count, sum and most by kind

    def treads(self, stamp_s: float, left_m_s: float, right_m_s: float) -> None:
        """Tread speeds, in force from a stamp on."""
        if not math.isfinite(left_m_s + right_m_s):
            self.too_late += 1
            return
        self._add(stamp_s, "tread_speeds_m_s", np.array([left_m_s, right_m_s], dtype=np.float64))

    def gyroscope(self, stamp_s: float, yaw_rate_rad_s: float) -> None:
        """A yaw rate, counter-clockwise; it makes no frame."""
        if self._gyroscope is None:
            return
        measured = math.isfinite(stamp_s) and math.isfinite(yaw_rate_rad_s)
        taken = measured and self._keeps_time(stamp_s, of_motion=True)
        if not (taken and self._gyroscope.add(stamp_s, yaw_rate_rad_s)):
            self.too_late += 1

    def pose(self, stamp_s: float, x: float, y: float, yaw: float = math.nan) -> None:
        """A measured pose in the reference frame [m, rad]; NaN for what was not measured."""
        self._add(stamp_s, "pose", self._measured(x, y, yaw))

    def velocity(self, stamp_s: float, v_x: float, v_y: float, omega: float) -> None:
        """A measured body twist [m/s, rad/s]; NaN for what was not measured."""
        self._add(stamp_s, "velocity", self._measured(v_x, v_y, omega))

    def image(self, stamp_s: float, pixels: ByteImage) -> None:
        """An image, (H, W) grey or (H, W, 3) in RGB order."""
        self._add(stamp_s, "image", pixels)

    def ready(self) -> list[Frame]:
        """Frames that need not wait any longer, in order of time."""
        due_s = self._clock_s - self._wait_s
        if self._gyroscope is not None:
            silent_since_s = self._clock_s - SILENT_S
            due_s = min(due_s, max(self._gyroscope.latest_s, silent_since_s))
        return self._until(due_s)

    @property
    def notes(self) -> tuple[str, ...]:
        """Kinds of messages of which many were dropped as too late, and by how much they were."""
        found = []
        for name, (count, sum_s, most_s) in self._late_s.items():
            if count < max(FEWEST, MANY * self._counts[name]):
                continue
            found.append(
                f"{count} of {self._counts[name]} {KINDS[name]} were dropped: they came "
                f"{sum_s / count:.2f} s behind treads and gyroscope in the mean, {most_s:.2f} s at "
                f"most, and wait_s is {self._wait_s:g} s. Wait for longer (answers come as much "
                "later); or their stamps are of another clock"
            )
        return tuple(found)

    def rest(self) -> list[Frame]:
        """All frames that are left, where no message will come any more."""
        return self._until(self._clock_s + AHEAD_S)

    def _measured(self, *values: float) -> FloatArray:
        """Values (3,), NaN in place of an infinite one, which is counted."""
        found = np.array(values, dtype=np.float64)
        infinite = np.isinf(found)
        self.too_late += bool(infinite.any())
        return np.where(infinite, math.nan, found)

    def _add(self, stamp_s: float, name: str, value: FloatArray | ByteImage) -> None:
        parts = self._parts.get(stamp_s, {})
        self._counts[name] += 1
        if not self._given_s < stamp_s < math.inf or name in parts:
            self.too_late += 1
            if stamp_s < self._given_s:
                count, sum_s, most_s = self._late_s.get(name, (0, 0.0, 0.0))
                late_s = self._clock_s - stamp_s
                self._late_s[name] = count + 1, sum_s + late_s, max(most_s, late_s)
            return
        if stamp_s not in self._parts:
            insort(self._stamps_s, stamp_s)
        self._parts[stamp_s] = parts | {name: value}
        self._keeps_time(stamp_s, of_motion=name == "tread_speeds_m_s")

    def _keeps_time(self, stamp_s: float, *, of_motion: bool) -> bool:
        """Let time go on by a message, or drop what came alone before it from far ahead.

        False where the message itself is far ahead, and the one before it was not.
        """
        begins = of_motion and self._clock_s == -math.inf
        if begins or stamp_s <= self._clock_s + AHEAD_S:
            if of_motion:
                self._clock_s = max(self._clock_s, stamp_s)
            if self._ahead_s != math.inf:
                self._ahead_s = math.inf
                self._drop_after(self._clock_s + AHEAD_S)
            return True
        confirmed = stamp_s >= self._ahead_s - AHEAD_S
        self._clock_s = stamp_s if confirmed else self._clock_s
        self._ahead_s = math.inf if confirmed else stamp_s
        return confirmed

    def _drop_after(self, end_s: float) -> None:
        count = bisect_right(self._stamps_s, end_s)
        for stamp_s in self._stamps_s[count:]:
            self.too_late += len(self._parts.pop(stamp_s))
        del self._stamps_s[count:]

    def _until(self, end_s: float) -> list[Frame]:
        count = bisect_right(self._stamps_s, end_s)
        due_s, self._stamps_s = self._stamps_s[:count], self._stamps_s[count:]
        return [self._frame(stamp_s) for stamp_s in due_s]

    def _frame(self, stamp_s: float) -> Frame:
        parts = self._parts.pop(stamp_s)
        if "tread_speeds_m_s" in parts:
            self._row += 1
            self._speeds = parts["tread_speeds_m_s"]
        yaw_rate = math.nan
        if self._gyroscope is not None:
            yaw_rate = self._gyroscope.mean_rate_rad_s(self._given_s, stamp_s)
        self._given_s = stamp_s
        return Frame(
            stamp_s,
            self._speeds,
            self._row,
            parts.get("pose"),
            parts.get("image"),
            yaw_rate_rad_s=yaw_rate,
            velocity=parts.get("velocity"),
        )


class LiveGyroscope:
    """Mean yaw rates between stamps, by samples up to now; samples of the past are forgotten.

    Attributes
    ----------
    latest_s : float
        Stamp of the latest sample.
    """

    def __init__(self) -> None:
        self.latest_s = -math.inf
        self._rate_rad_s = math.nan
        self._stamps_s: list[float] = []
        self._integrals = [np.zeros(4)]

    def add(self, stamp_s: float, yaw_rate_rad_s: float) -> bool:
        """Take in a sample; False where its stamp does not increase, or it is no number."""
        if not (self.latest_s < stamp_s < math.inf and math.isfinite(yaw_rate_rad_s)):
            return False
        if self._stamps_s:
            steps = step_integrals(
                np.array([self.latest_s, stamp_s]), np.array([self._rate_rad_s, yaw_rate_rad_s])
            )
            self._integrals.append(self._integrals[-1] + steps[0])
        self._stamps_s.append(stamp_s)
        self.latest_s, self._rate_rad_s = stamp_s, yaw_rate_rad_s
        return True

    def mean_rate_rad_s(self, begin_s: float, end_s: float) -> float:
        """Mean yaw rate between two stamps; NaN without samples. Older samples are then dropped."""
        if not self._stamps_s or math.isinf(begin_s):
            return math.nan
        samples = Gyroscope(np.array(self._stamps_s), np.stack(self._integrals))
        rate = float(samples.mean_rates_rad_s(np.array([begin_s, end_s]))[1])
        first = max(int(np.searchsorted(self._stamps_s, end_s, side="right")) - 1, 0)
        del self._stamps_s[:first], self._integrals[:first]
        return rate
