"""How much of an effect there is over time: from a moment on, gradually, or in bursts.

The course of each run is its own: a moment of one run does not apply to another.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import FloatArray, IntArray
from odometry.effects.interface.base import EffectParameter
from odometry.models.inputs import Inputs

SPACING_S, MOST_MOMENTS = 3.0, 60  # of the moments from which a search begins
LAST_STEP_S = 0.02  # how long the last sample of a run is held
UNBOUNDED_S = 1e4

Spans = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Course(ABC):
    """How much of an effect there is at each moment of run time."""

    @property
    @abstractmethod
    def name(self) -> str:
        """As a parameter set spells it."""

    @property
    def in_words(self) -> str:
        """As it follows the name of an effect."""
        return self.name.replace("_", " ")

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """What is searched of it."""
        return ()

    def starts(self) -> FloatArray:
        """Values (S, P) from which a search begins."""
        return np.empty((1, 0))

    def elsewhere(self, values: FloatArray) -> FloatArray:
        """Values (S, P) to which a search goes on from (P,) where they cost less."""
        return np.empty((0, len(values)))

    def is_meant(self, values: FloatArray) -> bool:  # noqa: ARG002 - of the interface
        """Whether something was measured on both sides of the values (P,)."""
        return True

    def settings(self) -> dict[str, Any]:
        """What a parameter set must hold to make it again."""
        return {}

    @property
    def searched(self) -> int:
        """Numbers that were searched beside the parameters."""
        return 0

    @abstractmethod
    def share(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """How much of the effect (N,) there is over each sample, 0 to 1."""


@dataclass(frozen=True)
class FromAMoment(Course):
    """Nothing before a moment of each run, all of it after.

    Attributes
    ----------
    observed_s : tuple of (float, float)
        Of each run: moments before the first, where no window has ended yet, or after the last,
        where none begins, are none.
    """

    observed_s: Spans = ((0.0, UNBOUNDED_S),)

    name = "from_a_moment"

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """Run time of the moment of each run."""
        alone = len(self.observed_s) == 1
        return tuple(
            EffectParameter(
                "moment" if alone else f"moment_{number}",
                "s",
                0.0,
                float(last_s) + 1.0,
                float(first_s + last_s) / 2,
                1.0,
                None,
            )
            for number, (first_s, last_s) in enumerate(self.observed_s, start=1)
        )

    def starts(self) -> FloatArray:
        """Moments (S, P) evenly spread over each of P runs in turn, the others not begun."""
        return self._moments(np.array([parameter.high for parameter in self.parameters]))

    def elsewhere(self, values: FloatArray) -> FloatArray:
        """Moments (S, P) of each of several runs in turn, those of the others as they are."""
        return self._moments(values) if len(values) > 1 else np.empty((0, len(values)))

    def _moments(self, others: FloatArray) -> FloatArray:
        """Moments (S, P) evenly spread over each of P runs in turn beside those of the others."""
        most = max(1, MOST_MOMENTS // len(self.observed_s))
        found = []
        for place, (first_s, last_s) in enumerate(self.observed_s):
            count = int(np.clip((last_s - first_s) / SPACING_S, 1, most))
            moments = np.tile(others, (count, 1))
            moments[:, place] = first_s + (last_s - first_s) * (np.arange(count) + 0.5) / count
            found.append(moments)
        return np.concatenate(found)

    def is_meant(self, values: FloatArray) -> bool:
        """A moment with nothing before it is none in any run, one with nothing after it in all."""
        first_s, last_s = np.array(self.observed_s).T
        return bool((first_s <= values).all() and (values <= last_s).any())

    def settings(self) -> dict[str, Any]:
        """How many runs have a moment."""
        return {"observed_s": [list(span) for span in self.observed_s]}

    def share(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """Shares (N,): the sample with a moment (P,) in it is shared out; later runs have none."""
        time_s, steps_s = _samples(inputs)
        numbers = run_numbers(inputs)
        known = numbers < len(values)
        moments = np.where(known, values[np.where(known, numbers, 0)], np.inf)
        return np.clip((time_s + steps_s - moments) / steps_s, 0.0, 1.0)


@dataclass(frozen=True)
class Gradual(Course):
    """Nothing at the start of each run, all of it after `full_s`, evenly in between."""

    full_s: float = UNBOUNDED_S

    name = "gradual"

    def settings(self) -> dict[str, Any]:
        """After how long."""
        return {"full_s": self.full_s}

    def share(self, values: FloatArray, inputs: Inputs) -> FloatArray:  # noqa: ARG002
        """See `Course.share`; it grows on after `full_s`."""
        time_s, steps_s = _samples(inputs)
        return np.asarray((time_s + steps_s / 2) / self.full_s)


@dataclass(frozen=True)
class InBursts(Course):
    """All of it within events of each run, nothing between them.

    Attributes
    ----------
    events_s : tuple of tuples of (float, float)
        Begin and end of each event in run time, run by run; runs beyond these have none.
    """

    events_s: tuple[Spans, ...] = ((),)

    name = "in_bursts"

    @property
    def searched(self) -> int:
        """The numbers of the begin and the end of each event."""
        return sum(2 * len(events) for events in self.events_s)

    def with_events(self, events_s: Spans, number: int) -> "InBursts":
        """The same with more events of the run of a number."""
        runs = [*self.events_s, *[()] * (number + 1 - len(self.events_s))]
        runs[number] = tuple(sorted((*runs[number], *events_s)))
        return InBursts(tuple(runs))

    def settings(self) -> dict[str, Any]:
        """When the events are."""
        return {"events_s": [[list(event) for event in events] for events in self.events_s]}

    def share(self, values: FloatArray, inputs: Inputs) -> FloatArray:  # noqa: ARG002
        """Shares (N,): a sample in which an event begins or ends is shared out."""
        time_s, steps_s = _samples(inputs)
        numbers = run_numbers(inputs)
        inside = np.zeros_like(time_s)
        for number, events in enumerate(self.events_s):
            own = numbers == number
            inside[own] = _inside(time_s[own], time_s[own] + steps_s[own], events)
        return np.asarray(np.minimum(inside, 1.0))


def _inside(from_s: FloatArray, to_s: FloatArray, events_s: Spans) -> FloatArray:
    """How many events each span (N,) is in, by shares; spans are in the order of time."""
    inside = np.zeros_like(from_s)
    for begin_s, end_s in events_s:
        first, last = np.searchsorted(to_s, [begin_s, end_s])
        at = slice(first, last + 1)
        within_s = np.minimum(to_s[at], end_s) - np.maximum(from_s[at], begin_s)
        inside[at] += np.clip(within_s / (to_s[at] - from_s[at]), 0.0, 1.0)
    return inside


def _samples(inputs: Inputs) -> tuple[FloatArray, FloatArray]:
    """Run time (N,) of samples, and how long each is held."""
    time_s = np.asarray(inputs.time_s)
    steps_s = np.append(np.diff(time_s), 0.0)
    return time_s, np.where(steps_s > 0, steps_s, LAST_STEP_S)


def run_numbers(inputs: Inputs) -> IntArray:
    """Which of several runs each sample (N,) is of."""
    count = len(inputs.tread_speeds_m_s)
    return np.zeros(count, dtype=np.int64) if inputs.run_number is None else inputs.run_number
