"""Two hidden effects at once, each large enough to show by itself."""

from dataclasses import fields

from tests.blind.hidden.drives import DRIVES
from tests.blind.hidden.instruments import INSTRUMENTS
from tests.blind.hidden.kind import Hidden, Kind
from tests.blind.hidden.references import REFERENCES
from tests.blind.hidden.seen import SEEN
from tests.blind.hidden.slips import SLIPS
from tests.blind.hidden.surroundings import SURROUNDINGS

SINGLE = SEEN | DRIVES | SLIPS | SURROUNDINGS | REFERENCES | INSTRUMENTS
MIXED_NAMES = (
    "late_commands+slip_by_speed",
    "turtle_mode+hard_iron",
    "slip_backward+hard_iron",
    "gyroscope_bias+slip_by_acceleration",
    "fast_pose_clock+one_side_deflates",
    "outliers+slip_by_speed",
    "top_speed+drifting_yaw",
    "wind_gusts+slip_backward",
    "multipath+late_commands",
    "downhill_creep+deflation",
    "changed_terrain+slip_by_speed",
    "gyroscope_scale+stretched_map",
)


def both(first, second):
    """The hidden effects of two kinds in one run, the second after the first at each place."""
    one_of = {field.name for field in fields(Hidden)} - {"truth", "reference", "at_place", "parts"}
    joined = {name: _after(getattr(first, name), getattr(second, name)) for name in one_of}
    at_places = [one.at_place for one in (first, second) if one.at_place]
    return Hidden(
        {"first": first.truth, "second": second.truth},
        at_place=_at_both(*at_places) if len(at_places) == 2 else next(iter(at_places), None),
        reference=lambda t, poses: second.reference(*first.reference(t, poses)),
        parts=(first, second),
        **joined,
    )


def mix(first, second):
    """A kind of two, driven as either of them needs."""

    def draw(rng, scene):
        hides = first.draw(rng, scene), second.draw(rng, scene)
        return lambda rng, clock: both(*(hide(rng, clock) for hide in hides))

    return Kind(
        draw,
        true=(*first.true, *second.true),
        acceptable=(*first.acceptable, *second.acceptable),
        without_gyroscope=(*first.without_gyroscope, *second.without_gyroscope),
        style="crawl" if "crawl" in (first.style, second.style) else "any",
        gyroscope="always" if "always" in (first.gyroscope, second.gyroscope) else "either",
        labels=max(first.labels, second.labels),
        sloped=first.sloped or second.sloped,
    )


def _after(first, second):
    """Both in turn; what is given besides the first value is given to both."""
    return lambda values, *more: second(first(values, *more), *more)


def _at_both(first, second):
    """Both in turn, at one place."""
    return lambda row, pose, twist: second(row, pose, first(row, pose, twist))


MIXED = {name: mix(*(SINGLE[part] for part in name.split("+"))) for name in MIXED_NAMES}
