"""Which names of the program mean which families of answers, and the score of one answer.

A family is a plain word of `tests/blind`; this table alone holds what the program calls it.
"""

from collections.abc import Sequence

MEANING = {
    "slope": ("slope_sliding",),
    "inertia": ("inertia",),
    "turn radius": ("curvature",),
    "wheel size": ("wheel_scale",),
    "terrain": ("terrain", "terrain_changed"),
    "traction": ("traction_loss",),
    "sideways": ("lateral_skid",),
    "late stamps": ("time_offset",),
    "late commands": ("command_delay",),
    "slow drive": ("actuator_lag",),
    "drive limits": ("drive_limit",),
    "tread slip": ("tread_slip",),
    "gyroscope": ("gyroscope_error",),
    "reference": ("reference_fault",),
    "sensor place": ("lever_arm",),
    "sensor heading": ("heading_offset",),
    "unknown": ("unknown",),
    "none": ("none",),
}
COURSES = ("from_a_moment", "gradual", "in_bursts")
FORMS_WITH_A_COURSE = {"drift": "gradual"}


def meant(name: str, course: str, families: Sequence[str]) -> bool:
    """Whether a name of the program says one of the families; "family course" needs the course."""
    for family in families:
        needed = next((one for one in COURSES if family.endswith(f" {one}")), "")
        plain = family.removesuffix(f" {needed}")
        if name in MEANING[plain] and needed in ("", course):
            return True
    return False


def course_of(form: str) -> str:
    """Course in time that a form means or ends with, or ""."""
    ending = next((course for course in COURSES if form.endswith(course)), "")
    return FORMS_WITH_A_COURSE.get(form, ending)


def score(
    verdict: str,
    course: str,
    parts: Sequence[Sequence[str]],
    acceptable: Sequence[str],
    equivalent: Sequence[str] = (),
) -> str:
    """Score of a first name: right, acceptable, unknown, none, or wrong.

    Acceptable is also the name of an effect that the answer calls equivalent to a true one.
    """
    true = [family for part in parts for family in part] or ["none"]
    if meant(verdict, course, true):
        return "right"
    if meant(verdict, course, acceptable) or any(meant(name, "", true) for name in equivalent):
        return "acceptable"
    return verdict if verdict in ("unknown", "none") else "wrong"


def all_named(named: Sequence[tuple[str, str]], parts: Sequence[Sequence[str]]) -> bool:
    """Whether each true effect is among the (name, course) of the answer."""
    return all(any(meant(*one, part) for one in named) for part in parts)
