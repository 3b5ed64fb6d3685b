"""Names of robots and terrains as parts of paths."""

import re
from collections.abc import Iterable

from odometry.errors import ComparisonError


def file_name(*names: str) -> str:
    """Names as a part of a path: letters, digits and underscores."""
    return "_".join(re.sub(r"\W+", "_", name).strip("_") or "unnamed" for name in names)


def check_file_names(robots_and_terrains: Iterable[tuple[str, str]]) -> None:
    """Refuse names whose files would be the same: those of one would replace the other's.

    Raises
    ------
    ComparisonError
        Naming two robots, or two pairs of robot and terrain.
    """
    places = list(robots_and_terrains)
    for several in (dict.fromkeys((robot,) for robot, _ in places), dict.fromkeys(places)):
        taken: dict[str, tuple[str, ...]] = {}
        for names in several:
            first = taken.setdefault(file_name(*names).lower(), names)
            if first != names:
                raise ComparisonError(
                    f"{' on '.join(map(repr, first))} and {' on '.join(map(repr, names))} differ "
                    "in signs or capitals alone, and their files would have one name: give both "
                    "one name in run.toml if they are one, else another one to one of them"
                )
