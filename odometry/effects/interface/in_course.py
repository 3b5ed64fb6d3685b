"""Effects that come and go in time: those of commands and of motion, by their time course."""

from typing import Any

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.interface.base import CommandEffect, Effect, EffectParameter, MotionEffect
from odometry.effects.interface.base_model import Base
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.time_course import Course
from odometry.errors import ParameterError
from odometry.models.inputs import Inputs

TAKEN_OVER = (
    *("name", "form", "course", "in_words", "acts_on", "equation", "source", "looks_like"),
    *("remedy", "needs", "alike", "slow", "constant_names"),
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
        """Values (S, P): the first start of the effect at every start of its course."""
        first, courses = self.inner.starts(inputs, base)[0], self.in_time.starts()
        return np.hstack([np.tile(first, (len(courses), 1)), courses])

    def elsewhere(self, values: FloatArray) -> FloatArray:
        """See `Effect.elsewhere`: the same effect at other moments."""
        own, course = self._split(values)
        courses = self.in_time.elsewhere(course)
        return np.hstack([np.tile(own, (len(courses), 1)), courses])

    def usual(self, base: Base) -> tuple[FloatArray, FloatArray]:
        """See `Effect.usual`."""
        centre, spread = self.inner.usual(base)
        count = len(self.in_time.parameters)
        return np.append(centre, np.zeros(count)), np.append(spread, np.full(count, np.inf))

    def is_meant(self, values: FloatArray) -> bool:
        """See `Effect.is_meant`."""
        own, course = self._split(values)
        return self.inner.is_meant(own) and self.in_time.is_meant(course)

    @property
    def searched(self) -> int:
        """See `Effect.searched`."""
        return self.in_time.searched

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


def lasting(added: Added) -> Added:
    """An effect as it is at the end of its course, which is one of its run; else itself."""
    if not isinstance(added.effect, _InCourse):
        return added
    inner = added.effect.inner
    return Added(inner, added.values[: len(inner.parameters)])


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
