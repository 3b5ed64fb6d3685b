"""Limits of a drive: treads that cannot do what was commanded."""

from math import inf

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.effects.commands.held_commands import held_spans
from odometry.effects.interface.base import CommandEffect, Effect, EffectParameter
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.recorded import Recorded, crawling
from odometry.effects.interface.remembered import Remembered
from odometry.models.inputs import Inputs

EDGE_M_S = 0.005  # over which a command begins to act: samples there have a derivative
EDGE = 0.1  # share of the least speed that acts, where that is less
BLURRED_M_S = 0.01  # by noise of the recorded speeds, a deadband
HARDEST_M_S2 = 20.0
HIGHEST_LEAST_M_S, HIGHEST_LEAST = 1.0, 0.5  # or this share of a fastest speed above 2 m/s
STARTS_M_S = (*(0.02, 0.04, 0.06, 0.09, 0.12, 0.15, 0.18, 0.21, 0.25), *(0.3, 0.36, 0.43, 0.5, 0.6))
FASTER = 1.2  # from one start to the next beyond these, up to NEAR of the highest
NEAR = 0.7


class DriveLimit(CommandEffect):
    """Shared by all: recorded speeds are commands."""

    name = "drive_limit"
    source = "definition; recorded speeds are commands"
    remedy = "record measured wheel speeds, or keep the limit in the model"


class ScaledLimit(DriveLimit):
    """A limit that is searched at speeds of the robot.

    Parameters
    ----------
    crawls : float
        See `crawling`: of slow robots starts and steps of the search are as much smaller.
    """

    def __init__(self, crawls: float = 1.0) -> None:
        self.crawls = crawls

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """At the speeds that were recorded."""
        return (cls(crawling(recorded.fastest_m_s)),)


class Deadband(ScaledLimit):
    """Commands below a speed move nothing; others act in full.

    Parameters
    ----------
    crawls : float
        As of all `ScaledLimit`.
    highest_m_s : float
        Up to which it is searched.
    """

    form = "deadband"
    in_words = "commands too small to move the robot"
    equation = "v -> 0 where |v| < least"
    looks_like = "a robot that stands, or turns about one tread, where a slow motion was commanded"

    def __init__(self, crawls: float = 1.0, highest_m_s: float = HIGHEST_LEAST_M_S) -> None:
        super().__init__(crawls)
        self.highest_m_s = highest_m_s

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """At the speeds that were recorded."""
        highest_m_s = max(HIGHEST_LEAST_M_S, HIGHEST_LEAST * recorded.fastest_m_s)
        return (cls(crawling(recorded.fastest_m_s), highest_m_s),)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        start, scale = self.crawls * 0.05, self.crawls * 0.005
        return (
            EffectParameter("least", "m/s", 0.0, self.highest_m_s, start, scale, in_steps=True),
        )

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the interface
        """See `Effect.starts`: near enough to each other for a cost that has steps."""
        further = np.log(NEAR * self.highest_m_s / STARTS_M_S[-1]) / np.log(FASTER)
        faster = STARTS_M_S[-1] * FASTER ** np.arange(1, np.floor(further) + 1)
        return self.crawls * np.append(STARTS_M_S, faster)[:, None]

    def resolution(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `Effect.resolution`: up to the nearest commands below and above."""
        off = np.append(np.abs(inputs.tread_speeds_m_s).ravel(), 0.0) - values[0]
        below, above = -off[off <= 0], off[off > 0]
        farthest = max(below.min(), above.min(initial=self.highest_m_s - values[0]))
        return np.array([max(farthest, self.crawls * BLURRED_M_S)])

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`."""
        speeds = inputs.tread_speeds_m_s
        if values[0] <= 0:
            return speeds
        edge_m_s = min(EDGE_M_S, EDGE * values[0])
        acts = np.clip((np.abs(speeds) - values[0]) / edge_m_s + 0.5, 0.0, 1.0)
        return np.asarray(acts * speeds)


class Saturation(DriveLimit):
    """Treads have a highest speed.

    Parameters
    ----------
    fastest_m_s : float
        The fastest that was recorded: a limit above it does nothing.
    """

    form = "saturation"
    in_words = "commands faster than the drives can turn"
    equation = "v -> sign(v) min(|v|, fastest)"
    looks_like = "fast stretches that come out short, slow ones that fit"

    def __init__(self, fastest_m_s: float = 20.0) -> None:
        self.fastest_m_s = fastest_m_s

    @classmethod
    def offered(cls, recorded: Recorded) -> tuple[Effect, ...]:
        """Below the fastest speed recorded."""
        return (cls(recorded.fastest_m_s),)

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        most = self.fastest_m_s
        scale = crawling(most) * 0.01
        return (EffectParameter("fastest", "m/s", 0.0, most, 0.9 * most, scale, most),)

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the interface
        """See `Effect.starts`."""
        return self.fastest_m_s * np.array([[0.95], [0.8], [0.6]])

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`."""
        return np.clip(inputs.tread_speeds_m_s, -values[0], values[0])


class RateLimit(ScaledLimit):
    """Treads speed up and slow down no faster than their drives can."""

    form = "rate"
    in_words = "commands that change faster than the drives can follow"
    equation = "|dv/dt| <= most"
    looks_like = "errors after large changes of speed, few after small ones"
    needs = "tread speeds that change in steps, and a measured pose"

    def __init__(self, crawls: float = 1.0) -> None:
        super().__init__(crawls)
        self._limits = Remembered()

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """See `Effect.parameters`."""
        least = self.crawls * 0.05
        return (EffectParameter("most", "m/s^2", least, HARDEST_M_S2, self.crawls, least, None),)

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:  # noqa: ARG002 - of the interface
        """See `Effect.starts`."""
        return self.crawls * np.array([[0.3], [0.8], [2.0]])

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`; the mean over each sample, exact for held commands."""
        speeds, time_s = inputs.tread_speeds_m_s, inputs.time_s
        if time_s is None:
            return speeds
        return self._limits.to(
            (values, speeds, time_s), lambda: limited(float(values[0]), speeds, time_s)
        )


def limited(most: float, speeds: FloatArray, time_s: FloatArray) -> FloatArray:
    """Mean speeds (N, T) of T treads that change theirs (N, T) by no more than `most` [m/s^2]."""
    held_s, starts = held_spans(time_s)
    return np.stack([_limited(tread, held_s, starts, most) for tread in speeds.T], axis=-1)


def _limited(
    commands: FloatArray, held_s: FloatArray, starts: BoolArray, most: float
) -> FloatArray:
    """Mean speeds (N,) of a tread that goes towards each held command at `most` [m/s^2].

    At once where it had reached the command before, in turn from where it falls behind.
    """
    before = np.where(starts, commands, np.roll(commands, 1))
    change = commands - before
    needed_s = np.abs(change) / most if most < inf else np.zeros_like(change)
    reached = needed_s < held_s
    means = commands - change * needed_s / 2 / np.where(reached, held_s, 1.0)
    if reached.all():
        return means
    spans = commands.tolist(), held_s.tolist(), starts.tolist()
    done = 0
    for first in np.flatnonzero(~reached).tolist():
        if first >= done:
            done = _caught_up(spans, first, float(before[first]), most, means)
    return means


def _caught_up(
    spans: tuple[list[float], list[float], list[bool]],
    first: int,
    speed: float,
    most: float,
    means: FloatArray,
) -> int:
    """Put the means from a sample on into (N,), until the command is reached: the next sample."""
    commands, held_s, starts = spans
    for place in range(first, len(commands)):
        command, span_s = commands[place], held_s[place]
        speed = command if starts[place] else speed
        change = command - speed
        needed_s = abs(change) / most if most < inf else 0.0
        if needed_s < span_s:
            means[place] = command - change * needed_s / 2 / span_s
            return place + 1
        after = speed + (most * span_s if change > 0 else -most * span_s)
        means[place] = (speed + after) / 2
        speed = after
    return len(commands)
