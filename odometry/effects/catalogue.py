"""Names and forms of the effects, and how a parameter set spells them."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from odometry.effects.commands.by_side import (
    DeadbandBySide,
    DelayBySide,
    LagBySide,
    RateBySide,
    SaturationBySide,
)
from odometry.effects.commands.drive_limit import Deadband, RateLimit, Saturation
from odometry.effects.commands.late_treads import ActuatorLag, CommandDelay
from odometry.effects.commands.tread_slip import (
    SlipByAcceleration,
    SlipByDirection,
    SlipBySpeed,
    SlipOfLeftTread,
    SlipOfRightTread,
)
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.base import Effect
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import (
    UNBOUNDED_S,
    Course,
    FromAMoment,
    Gradual,
    InBursts,
    Spans,
)
from odometry.effects.measurement.course_for_yaw import CourseForYaw
from odometry.effects.measurement.gyroscope_error import GyroscopeBySpeedError, GyroscopeError
from odometry.effects.measurement.late_by_chance import LateByChance
from odometry.effects.measurement.map_fault import (
    DriftingMap,
    DriftingYaw,
    StretchedMap,
    TurningMap,
)
from odometry.effects.measurement.reference_fault import Compass
from odometry.effects.measurement.reference_filter import (
    FilteredPositions,
    SlowYaw,
    SmoothedPoses,
    SwayingMast,
)
from odometry.effects.measurement.reference_outliers import (
    FrozenPoses,
    JumpingPoses,
    ReferenceOutliers,
)
from odometry.effects.measurement.reference_rounding import RoundedPositions
from odometry.effects.measurement.reference_step import ClockStep
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.straight_lines import StraightLines
from odometry.effects.measurement.time_offset import ClockDrift, LatePositions, TimeOffset
from odometry.effects.motion.contact_effects import InertiaByContact, SlopeByContact
from odometry.effects.motion.curvature import Curvature
from odometry.effects.motion.inertia_icr import InertiaByIndices
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.motion.slope_drift import SlopeDrift
from odometry.effects.motion.slope_icr import SlopeByIcr
from odometry.effects.motion.terrain import NewIcrs, Terrain
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.effects.unknown.history import History
from odometry.effects.unknown.residual import Residual
from odometry.effects.unknown.residual_of_place import ResidualOfPlace
from odometry.errors import ParameterError
from odometry.parameter_covariance import finite_number

EFFECTS: tuple[type[Effect], ...] = (
    WheelScale,
    ActuatorLag,
    LagBySide,
    CommandDelay,
    DelayBySide,
    Deadband,
    DeadbandBySide,
    Saturation,
    SaturationBySide,
    RateLimit,
    RateBySide,
    SlipBySpeed,
    SlipByDirection,
    SlipByAcceleration,
    SlipOfLeftTread,
    SlipOfRightTread,
    LateralSkid,
    Curvature,
    TractionLoss,
    Terrain,
    NewIcrs,
    SlopeByIcr,
    SlopeDrift,
    SlopeByContact,
    InertiaByIndices,
    InertiaByContact,
    TimeOffset,
    LatePositions,
    ClockDrift,
    ClockStep,
    LeverArm,
    HeadingOffset,
    Compass,
    StretchedMap,
    TurningMap,
    DriftingMap,
    DriftingYaw,
    SmoothedPoses,
    FilteredPositions,
    SlowYaw,
    SwayingMast,
    CourseForYaw,
    LateByChance,
    StraightLines,
    GyroscopeError,
    GyroscopeBySpeedError,
)
OUTLIERS = (ReferenceOutliers, FrozenPoses, JumpingPoses)
KNOWN: tuple[type[Effect], ...] = (
    *EFFECTS,
    *OUTLIERS,
    RoundedPositions,
    Residual,
    ResidualOfPlace,
    History,
)
BY_FORM = {(effect.name, effect.form): effect for effect in KNOWN}

COURSES = (FromAMoment.name, Gradual.name, InBursts.name)


def effect_table(added: Added) -> dict[str, Any]:
    """An effect as a parameter set holds it: complete in itself."""
    effect = added.effect
    return {
        "name": effect.name,
        "form": effect.form,
        **effect.settings(),
        "parameters": {**added.by_name, **effect.constants()},
    }


def added_effects(tables: Sequence[Mapping[str, Any]], where: str) -> tuple[Added, ...]:
    """The effects of a parameter set.

    Raises
    ------
    ParameterError
        If a name or form is unknown, or a parameter missing.
    """
    return tuple(_added(table, f"{where}: effects[{i}]") for i, table in enumerate(tables))


def _added(table: Mapping[str, Any], where: str) -> Added:
    kind = (str(table.get("name")), str(table.get("form")))
    if kind not in BY_FORM:
        known = ", ".join(f"{name}/{form}" for name, form in BY_FORM)
        raise ParameterError(f"{where}: effect {kind[0]}/{kind[1]}, expected one of {known}")
    values = table.get("parameters")
    if not isinstance(values, Mapping):
        raise ParameterError(f"{where}: parameters = {values!r}, expected a table")
    settings = {
        key: _frozen(value)
        for key, value in table.items()
        if key not in {"name", "form", "parameters", "source"}
    }
    constants = {
        name: finite_number(value, f"{where}: {name}")
        for name, value in values.items()
        if name in BY_FORM[kind].constant_names
    }
    if settings.pop("by_speed", False):  # of residuals in sets of version 0.6
        settings["by"] = "speed"
    course = _course(kind, values, settings, where)
    try:
        plain = BY_FORM[kind](**settings, **constants)
        effect = plain if course is None else in_course(plain, course)
    except (TypeError, ParameterError) as error:
        raise ParameterError(f"{where}: {error}") from error
    identified = {k: v for k, v in values.items() if k not in constants}
    return Added(effect, np.asarray(effect.pack(identified, where)))


def _course(
    kind: tuple[str, str], values: Mapping[str, Any], settings: dict[str, Any], where: str
) -> Course | None:
    """The course of the settings, taken out of them; sets of version 0.6 had a moment alone."""
    if "course" in settings:
        return course_of(settings, where)
    if kind == ("traction_loss", "k_m") and "moment" in values:
        return FromAMoment()
    return None


def _frozen(value: Any) -> Any:
    return tuple(_frozen(item) for item in value) if isinstance(value, list) else value


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
