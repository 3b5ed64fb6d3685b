"""All kinds of hidden effects, by group."""

from tests.blind.hidden.carried import CARRIED
from tests.blind.hidden.drives import DRIVES
from tests.blind.hidden.everyday import EVERYDAY
from tests.blind.hidden.fieldwork import FIELDWORK
from tests.blind.hidden.instruments import INSTRUMENTS
from tests.blind.hidden.kind import Hidden, Kind
from tests.blind.hidden.mixed import MIXED
from tests.blind.hidden.one_side import ONE_SIDE
from tests.blind.hidden.references import REFERENCES
from tests.blind.hidden.seen import SEEN
from tests.blind.hidden.slips import SLIPS
from tests.blind.hidden.surroundings import SURROUNDINGS
from tests.blind.hidden.unusual import UNUSUAL


def nothing(rng, scene):  # noqa: ARG001
    """Robots, rates and noises as in the other kinds, and no effect."""
    return lambda rng, clock: Hidden()  # noqa: ARG005


GROUPS = {
    "seen": SEEN,
    "drives": DRIVES,
    "one_side": ONE_SIDE,
    "slips": SLIPS,
    "surroundings": SURROUNDINGS,
    "references": REFERENCES,
    "instruments": INSTRUMENTS,
    "unusual": UNUSUAL,
    "everyday": EVERYDAY,
    "fieldwork": FIELDWORK,
    "carried": CARRIED,
    "mixed": MIXED,
    "nothing": {
        "nothing": Kind(nothing, ()),
        "nothing_labelled": Kind(nothing, (), labels=2),
        "nothing_sloped": Kind(nothing, (), sloped=True),
        "nothing_crawling": Kind(nothing, (), style="crawl"),
    },
}
HIDDEN = {name: kind for kinds in GROUPS.values() for name, kind in kinds.items()}
