"""Whether velocities of joints are those of their positions."""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.bags.files.topic import Message, header_ns
from odometry.bags.rows.streams import Consumer
from odometry.bags.topics.wheel_names import UNITS
from odometry.bags.wheels.wheel_source import WheelSource
from odometry.errors import BagError

SPAN_S = 0.5  # over which both are summed
LONGEST_S = 0.5  # between two messages; longer ones are a gap
BLOCK, MOST_BLOCKS = 1024, 200  # of messages: an hour at 50 Hz; later ones are left out
LEAST_SPANS = 20  # in which the wheels turn by a fifth of what they turn in a fast one, or more
TURNS, FAST_QUANTILE = 0.2, 0.9
LARGEST_STEP = math.pi  # rad between messages: angles that wrap, or an encoder that was reset
AGREE = 1.15  # ratio of the two; velocities that are filtered, or of noisy places, have less
RELATED = 0.95  # correlation, below which one of them may be anything, and nothing is said
LIKE = 1.05  # ratio to a unit that is named


class PlacesWatch(Consumer):
    """Sums velocities and changes of positions of the wheels in joint states."""

    def __init__(self, source: WheelSource, radius_m: float | None) -> None:
        super().__init__(source.topic)
        self._wheels = source.left + source.right
        self._radius_m = radius_m
        self._names: list[str] = []  # of the latest message, and where the wheels are among them
        self._at: list[int] = []
        self._rows: list[list[float]] = []  # stamp, positions, velocities
        self._spans: list[FloatArray] = []  # ways by velocities and by positions (2, n, k)
        self._whole = True

    def take(self, message: Message, content: Any) -> None:
        """Take in a JointState; one without both numbers of all wheels is left out."""
        if content.name != self._names:
            self._names = list(content.name)
            there = set(self._wheels) <= set(self._names)
            self._at = [self._names.index(wheel) for wheel in self._wheels] if there else []
        places, speeds = content.position, content.velocity
        both = min(len(places), len(speeds)) >= len(self._names)
        if self._at and both and len(self._spans) < MOST_BLOCKS:
            row = [(header_ns(content) or message.received_ns) / 1e9]
            row += [places[k] for k in self._at]
            row += [speeds[k] for k in self._at]
            self._rows.append(row)
            if len(self._rows) == BLOCK:
                self._sum()

    def _sum(self) -> None:
        """Sum the rows over spans; the last row begins the next ones."""
        stamps_s, values = np.split(np.array(self._rows), [1], axis=1)
        self._rows = self._rows[-1:]
        places, speeds = np.split(values, 2, axis=1)
        self._whole = self._whole and bool(np.all(places == np.rint(places)))
        lasts_s, steps = np.diff(stamps_s, axis=0), np.diff(places, axis=0)
        ways = np.stack([lasts_s * (speeds[1:] + speeds[:-1]) / 2, steps])
        lasts = (lasts_s > 0) & (lasts_s < LONGEST_S) & (np.abs(steps) < LARGEST_STEP)
        ways[:, ~lasts.all(axis=1)] = np.nan
        if ways.shape[1]:
            begins = np.unique(stamps_s[1:, 0] // SPAN_S, return_index=True)[1]
            self._spans.append(np.add.reduceat(ways, np.sort(begins), axis=1))

    def check(self) -> None:
        """Raise BagError where velocities and positions surely have different units or signs."""
        if self._rows:
            self._sum()
        if self._whole or not self._spans:  # ticks of an encoder are no rad
            return
        ways = np.concatenate(self._spans, axis=1)
        ratios = {name: _ratio(*ways[:, :, k]) for k, name in enumerate(self._wheels)}
        odd = {name: of for name, of in ratios.items() if not (1 / AGREE < of < AGREE)}
        odd = {name: of for name, of in odd.items() if not math.isnan(of)}
        if not odd:
            return
        ratio = float(np.median(list(odd.values())))
        units = list(self._units(ratio)) if len(odd) == len(ratios) else []
        may_be = f" Velocities may be in {' or '.join(units)}: --unit {units[0]}." if units else ""
        raise BagError(
            f"{self.topic}: velocities of {', '.join(odd)} are {ratio:.3g} times what their "
            f"positions change by in a second, so that they are not in rad/s beside rad.{may_be} "
            "To take the velocities as rad/s: --unit rad/s; to take the positions as rad: values = "
            '"position" in [wheels] of a map'
        )

    def _units(self, ratio: float) -> Iterator[str]:
        """Units of velocities that explain a ratio, with positions in rad."""
        for unit, (one, of_angle, is_speed) in UNITS.items():
            reach_m = 1.0 if of_angle else self._radius_m
            if is_speed and unit != "rad/s" and reach_m:
                like = ratio * one / reach_m
                if 1 / LIKE < like < LIKE:
                    yield unit


def _ratio(by_speed: FloatArray, by_place: FloatArray) -> float:
    """Of ways (N,) by velocities and by positions; NaN where these are not proportional."""
    whole = np.isfinite(by_speed + by_place)
    by_speed, by_place = by_speed[whole], by_place[whole]
    if not by_place.any():
        return math.nan
    turns = np.abs(by_place) >= TURNS * np.quantile(np.abs(by_place), FAST_QUANTILE)
    by_speed, by_place = by_speed[turns], by_place[turns]
    product = math.sqrt(float(np.sum(by_speed**2) * np.sum(by_place**2)))
    if len(by_place) < LEAST_SPANS or abs(np.sum(by_speed * by_place)) <= RELATED * product:
        return math.nan
    return float(np.median(by_speed / by_place))
