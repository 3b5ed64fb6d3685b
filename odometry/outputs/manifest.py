"""The file that says what an output folder is: which verb, which format, whether it is whole."""

import hashlib
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from odometry.errors import OdometryError, OutputError
from odometry.io.files import atomic_write, opened
from odometry.io.structured import TOML_BYTES, read_json

PROGRAM = "terrain-odometry"
LINE_BYTES = 200
CONTENT = "# content: sha256 "
NAMED_FORMAT = re.compile(rf"# {PROGRAM} ([a-z ]+), format (\d{{1,9}})\r?(?:\n|$)")


def format_line(kind: str, version: int) -> str:
    """The first line of a TOML file: what it is and its format version, as a comment."""
    return f"# {PROGRAM} {kind}, format {version}\n"


def made_text(head: str, comment: str, content: str) -> str:
    """A first line, comment lines and content.

    Where a comment says what made it, the text says of itself whether it was edited since.
    """
    digest = f"{CONTENT}{_digest(content)}\n" if comment else ""
    return f"{head}{comment}{digest}{content}"


def is_edited(text: str) -> bool:
    """Whether the content of a `made_text` is another than that it was made with."""
    _, line, rest = text.partition(CONTENT)
    digest, _, content = rest.partition("\n")
    return bool(line) and digest != _digest(content)


def _digest(content: str) -> str:
    return hashlib.sha256(content.encode()).hexdigest()


def stated_format(text: str) -> tuple[str, int] | None:
    """Kind and format version of a first line by `format_line`; None where there is none."""
    found = NAMED_FORMAT.match(text)
    return (found[1], int(found[2])) if found else None


def check_format(
    where: object, stated: object, known: int, error: type[OdometryError] = OdometryError
) -> None:
    """Raise `error` unless `stated` is a format version that this program reads."""
    if isinstance(stated, bool) or not isinstance(stated, int) or stated < 1:
        raise error(f"{where}: format = {stated!r}, expected a number from 1 to {known}")
    if stated > known:
        raise error(
            f"{where}: made by a newer version of {PROGRAM} (format {stated}; this version reads "
            f"up to {known}); install a newer version"
        )


def check_first_line(file: Path, known: int, error: type[OdometryError]) -> None:
    """`check_format` of a TOML file; one without the line is as old as version 0.4, or typed."""
    with opened(file, error, TOML_BYTES, "settings have a few thousand") as stream:
        stated = stated_format(stream.readline(LINE_BYTES).decode("ascii", "replace"))
    if stated is not None:
        check_format(file, stated[1], known, error)


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
