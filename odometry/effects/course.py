"""Effects that come and go in time: from a moment on, gradually, or in bursts.

The course of each run is its own: a moment of one run says nothing of another.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.base import CommandEffect, Effect, EffectParameter, MotionEffect
from odometry.effects.base_model import Base
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs
from odometry.parameter_covariance import finite_number

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

    def is_meant(self, values: FloatArray) -> bool:  # noqa: ARG002 - of the face
        """Whether something was measured on both sides of what the values (P,) say."""
        return True

    def settings(self) -> dict[str, Any]:
        """What a parameter set must hold to make it again."""
        return {}

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
    near_s : tuple of float, optional
        Where the search of the moment of each run begins, where something is known of it.
    """

    observed_s: Spans = ((0.0, UNBOUNDED_S),)
    near_s: tuple[float, ...] = ()

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
        """Moments evenly spread over each run in turn, the others not begun."""
        if self.near_s:
            return np.array([self.near_s])
        most = max(1, MOST_MOMENTS // len(self.observed_s))
        never = np.array([parameter.high for parameter in self.parameters])
        found = []
        for place, (first_s, last_s) in enumerate(self.observed_s):
            count = int(np.clip((last_s - first_s) / SPACING_S, 1, most))
            moments = np.tile(never, (count, 1))
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
        """The sample in which the moment lies is shared out; after the last run there is none."""
        time_s, steps_s = _samples(inputs)
        numbers = _run_numbers(inputs)
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
    """All of it within events, nothing between them.

    Attributes
    ----------
    events_s : tuple of tuples of (float, float)
        Of each run: first and last moment of each event.
    """

    events_s: tuple[Spans, ...] = ((),)

    name = "in_bursts"

    def settings(self) -> dict[str, Any]:
        """The events."""
        return {"events_s": [[list(event) for event in run] for run in self.events_s]}

    def share(self, values: FloatArray, inputs: Inputs) -> FloatArray:  # noqa: ARG002
        """See `Course.share`; samples on an edge are shared out."""
        time_s, steps_s = _samples(inputs)
        numbers = _run_numbers(inputs)
        share = np.zeros(len(time_s))
        for number, events in enumerate(self.events_s):
            here = numbers == number
            for first_s, last_s in events:
                inside = np.minimum(time_s + steps_s, last_s) - np.maximum(time_s, first_s)
                share[here] += np.clip(inside / steps_s, 0.0, 1.0)[here]
        return np.minimum(share, 1.0)


COURSES: Mapping[str, type[Course]] = {
    "from_a_moment": FromAMoment,
    "gradual": Gradual,
    "in_bursts": InBursts,
}


TAKEN_OVER = (
    *("name", "form", "course", "in_words", "acts_on", "equation", "source", "looks_like"),
    *("remedy", "needs", "alike", "slow", "shared", "constant_names"),
)


class _InCourse(Effect):
    """An effect of commands or motion that comes and goes."""

    def __init__(self, inner: Effect, course: Course) -> None:
        self.inner, self.in_time = inner, course
        words = {
            "course": course.name,
            "in_words": f"{inner.in_words}, {course.in_words}",
            "equation": f"{inner.equation}, {course.in_words}",
        }
        for name in TAKEN_OVER:
            setattr(self, name, words.get(name, getattr(inner, name)))

    @property
    def parameters(self) -> tuple[EffectParameter, ...]:
        """Of the effect, then of its course."""
        return (*self.inner.parameters, *self.in_time.parameters)

    def lacks(self, inputs: Inputs, base: Base) -> str:
        """See `Effect.lacks`."""
        return self.inner.lacks(inputs, base) or ("" if inputs.time_s is not None else "stamps")

    def starts(self, inputs: Inputs, base: Base) -> FloatArray:
        """The first start of the effect at every start of its course."""
        first, courses = self.inner.starts(inputs, base)[0], self.in_time.starts()
        return np.hstack([np.tile(first, (len(courses), 1)), courses])

    def usual(self, base: Base) -> tuple[FloatArray, FloatArray]:
        """See `Effect.usual`."""
        centre, spread = self.inner.usual(base)
        count = len(self.in_time.parameters)
        return np.append(centre, np.zeros(count)), np.append(spread, np.full(count, np.inf))

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`."""
        own, course = self._split(values)
        return self.inner.is_meant(own) and self.in_time.is_meant(course)

    def constants(self) -> dict[str, float]:
        """See `Effect.constants`."""
        return self.inner.constants()

    def settings(self) -> dict[str, Any]:
        """See `Effect.settings`."""
        return {**self.inner.settings(), "course": self.in_time.name, **self.in_time.settings()}

    def _split(self, values: FloatArray) -> tuple[FloatArray, FloatArray]:
        count = len(self.inner.parameters)
        return values[:count], values[count:]

    def _share(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        return self.in_time.share(values, inputs)[:, None]


class CommandsInCourse(_InCourse, CommandEffect):
    """An effect on commands that comes and goes."""

    inner: CommandEffect

    def tread_speeds(self, values: FloatArray, inputs: Inputs) -> FloatArray:
        """See `CommandEffect.tread_speeds`."""
        speeds = inputs.tread_speeds_m_s
        if inputs.time_s is None:
            return speeds
        own, course = self._split(values)
        changed = self.inner.tread_speeds(own, inputs) - speeds
        return np.asarray(speeds + self._share(course, inputs) * changed)


class MotionInCourse(_InCourse, MotionEffect):
    """An effect on the motion that comes and goes."""

    inner: MotionEffect

    def twist(
        self, values: FloatArray, twist: FloatArray, inputs: Inputs, base: Base
    ) -> FloatArray:
        """See `MotionEffect.twist`."""
        if inputs.time_s is None:
            return twist
        own, course = self._split(values)
        changed = self.inner.twist(own, twist, inputs, base) - twist
        return np.asarray(twist + self._share(course, inputs) * changed)


def in_course(effect: Effect, course: Course) -> Effect:
    """The effect as it comes and goes.

    Raises
    ------
    ParameterError
        If it acts on the measurement, or has a course already.
    """
    if isinstance(effect, CommandEffect) and not effect.course:
        return CommandsInCourse(effect, course)
    if isinstance(effect, MotionEffect) and not effect.course:
        return MotionInCourse(effect, course)
    raise ParameterError(
        f"the effect {effect.name!r} has no course in time; expected one on commands or motion"
    )


def course_of(settings: dict[str, Any], where: str) -> Course:
    """The course that settings of a parameter set say; its keys are taken out of them.

    Raises
    ------
    ParameterError
        If it is not known, or its own settings are wrong.
    """
    name = settings.pop("course")
    if name not in COURSES:
        raise ParameterError(f"{where}: course = {name!r}, expected one of {', '.join(COURSES)}")
    if name == "gradual":
        return Gradual(finite_number(settings.pop("full_s", UNBOUNDED_S), f"{where}: full_s"))
    if name == "in_bursts":
        runs = _list(settings.pop("events_s", []), f"{where}: events_s")
        return InBursts(tuple(_spans(run, f"{where}: events_s") for run in runs))
    return FromAMoment(
        _spans(settings.pop("observed_s", [[0.0, UNBOUNDED_S]]), f"{where}: observed_s")
    )


def _list(value: object, where: str) -> Sequence[Any]:
    if not isinstance(value, list | tuple):
        raise ParameterError(f"{where} = {value!r}, expected a list")
    return value


def _spans(value: object, where: str) -> Spans:
    spans = []
    for span in _list(value, where):
        first, last = _list(span, where) if len(_list(span, where)) == 2 else (None, None)
        spans.append((finite_number(first, where), finite_number(last, where)))
    return tuple(spans)


def _samples(inputs: Inputs) -> tuple[FloatArray, FloatArray]:
    """Run time (N,) of samples, and how long each is held."""
    time_s = np.asarray(inputs.time_s)
    steps_s = np.append(np.diff(time_s), 0.0)
    return time_s, np.where(steps_s > 0, steps_s, LAST_STEP_S)


def _run_numbers(inputs: Inputs) -> Any:
    count = len(inputs.tread_speeds_m_s)
    return np.zeros(count, dtype=np.int64) if inputs.run_number is None else inputs.run_number
