"""Format lines: what a file is and which version of its format, so that newer ones are refused."""

import hashlib
import re
from pathlib import Path

from odometry.errors import OdometryError
from odometry.io.files import opened
from odometry.io.structured import TOML_BYTES

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
