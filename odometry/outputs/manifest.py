"""The file that says what an output folder is: which verb, which format, whether it is whole."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from odometry.errors import OutputError
from odometry.io.files import atomic_write
from odometry.io.formats import PROGRAM, check_format
from odometry.io.structured import read_json

NAME = f"{PROGRAM}.json"
FORMAT = 1
FINISHED, UNFINISHED = "finished", "unfinished"


@dataclass(frozen=True)
class Manifest:
    """What an output folder says of itself.

    Attributes
    ----------
    verb : str
    state : str
        `finished`, or `unfinished` while files are made or replaced.
    files : tuple of str
        What the program wrote there, this file left out; relative, with slashes.
    made : Mapping
        What made it, by `Made.to_table`; empty while unfinished.
    sums : Mapping
        `sha256` and `lines` of tables by name; empty where none were taken.
    """

    verb: str
    state: str
    files: tuple[str, ...]
    made: Mapping[str, Any] = field(default_factory=dict)
    sums: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    def write(self, folder: Path) -> None:
        """Write it into its folder."""
        content = {
            "format": FORMAT,
            "program": PROGRAM,
            "verb": self.verb,
            "state": self.state,
            "files": list(self.files),
            "made": dict(self.made),
        } | ({"sums": dict(self.sums)} if self.sums else {})
        with atomic_write(folder / NAME) as part:
            part.write_text(json.dumps(content, indent=2) + "\n", encoding="utf-8")


def read_manifest(folder: Path) -> Manifest | None:
    """Read the manifest of a folder; None where the folder has none.

    Raises
    ------
    OutputError
        If the file is not as `Manifest.write` writes it, or of a newer format.
    """
    file = folder / NAME
    if not file.is_file():
        return None
    try:
        content = read_json(file, OutputError)
    except OutputError as error:
        raise OutputError(f"{error}; {TO_DO}") from error
    if not isinstance(content, dict) or content.get("program") != PROGRAM:
        raise OutputError(f"{file}: it is not of {PROGRAM}; {TO_DO}")
    check_format(file, content.get("format"), FORMAT, OutputError)
    verb, state, files, made = (content.get(key) for key in ("verb", "state", "files", "made"))
    whole = isinstance(verb, str) and state in (FINISHED, UNFINISHED) and isinstance(made, dict)
    if not whole or not isinstance(files, list) or not all(map(_is_inside, files)):
        raise OutputError(f"{file}: damaged; {TO_DO}")
    sums = content.get("sums", {})  # older versions took none
    if not _are_sums(sums, files):
        raise OutputError(f"{file}: damaged; {TO_DO}")
    return Manifest(str(verb), str(state), tuple(files), made or {}, sums)


TO_DO = "choose another --out, or delete the folder"


def check_finished(path: Path) -> None:
    """Raise OutputError if a file or folder is of an output that was not finished.

    Parameters
    ----------
    path : Path
        An output folder, a folder in it, or a file in one of these.
    """
    path = path.resolve()
    for folder in (path, *path.parents[:3]):
        manifest = read_manifest(folder)
        if manifest is None or manifest.state == FINISHED:
            continue
        inside = path.relative_to(folder).as_posix()
        ours = any(name == inside or name.startswith(f"{inside}/") for name in manifest.files)
        if path == folder or ours:
            raise OutputError(
                f"{path}: unfinished: `{PROGRAM} {manifest.verb}` was stopped while it wrote to "
                f"{folder}; run it again"
            )


def _are_sums(sums: object, files: list[str]) -> bool:
    """Whether sums are of files of the manifest, each with `sha256` and `lines`."""
    return isinstance(sums, dict) and all(
        name in files
        and isinstance(each, dict)
        and isinstance(each.get("sha256"), str)
        and isinstance(each.get("lines"), int)
        for name, each in sums.items()
    )


def _is_inside(name: object) -> bool:
    """Whether a name of a manifest stays in the manifest's folder."""
    if not isinstance(name, str) or "\0" in name or "\\" in name:
        return False
    return bool(name) and not name.startswith("/") and ".." not in name.split("/")
