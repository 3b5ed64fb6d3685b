"""When two names are two spellings of one terrain."""

from collections import defaultdict
from collections.abc import Iterable

BETWEEN_WORDS = frozenset("_-.")  # and spaces: other signs may distinguish terrains, as + does
BY_SPELLING = "differ by capitals, spaces, hyphens, underscores or dots alone"


def plain_name(name: str) -> str:
    """What all spellings of a name have in common.

    Examples
    --------
    >>> plain_name("Wet grass") == plain_name("wet_grass"), plain_name("--")
    (True, '--')
    """
    kept = (sign for sign in name.casefold() if not sign.isspace() and sign not in BETWEEN_WORDS)
    return "".join(kept) or name


def alike_names(terrains: Iterable[str]) -> list[str]:
    """Names that are spellings of one; none where all are different."""
    names: dict[str, list[str]] = defaultdict(list)
    for name in terrains:
        names[plain_name(name)].append(name)
    return next((alike for alike in names.values() if len(alike) > 1), [])
