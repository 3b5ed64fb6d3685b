"""The time course of an effect, read from the settings of a parameter set."""

from collections.abc import Sequence
from typing import Any

from odometry.effects.time_course import (
    UNBOUNDED_S,
    Course,
    FromAMoment,
    Gradual,
    InBursts,
    Spans,
)
from odometry.errors import ParameterError
from odometry.parameter_covariance import finite_number

COURSES = (FromAMoment.name, Gradual.name, InBursts.name)


def course_of(settings: dict[str, Any], where: str) -> Course:
    """The course of the settings of a parameter set; its keys are taken out of them.

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
    if name == InBursts.name:
        runs = _list(settings.pop("events_s", []), f"{where}: events_s")
        return InBursts(tuple(_spans(events, f"{where}: events_s") for events in runs))
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
