"""Names of the folders that the results of many runs get."""

from collections.abc import Iterable, Sequence
from pathlib import Path


def folder_names(folders: Sequence[Path], taken: Iterable[str] = ()) -> list[str]:
    """Name each after its run; a name that comes again, or is taken, gets a number."""
    used, names = set(taken), []
    for folder in folders:
        first = folder.resolve().name
        name, count = first, 1
        while name in used:
            count += 1
            name = f"{first}_{count}"
        used.add(name)
        names.append(name)
    return names
