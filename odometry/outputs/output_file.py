"""A single file as an output: it is replaced only if it says that the same verb made it."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from odometry.errors import OdometryError, OutputError
from odometry.io.files import check_writable
from odometry.io.formats import is_edited
from odometry.io.structured import read_toml
from odometry.outputs.leftovers import remove_temporaries
from odometry.outputs.provenance import MADE_BY, RUN_FILES

HEAD_BYTES = 4096  # of a PNG file with its texts, or of a text
SET_SOURCES_0_4 = {
    "identify": "identified by terrain-odometry",
    "identify-modes": "identify-modes of terrain-odometry",
}


def claim_file(out: Path, is_own: Callable[[Path], bool], verb: str) -> None:
    """Check before long work that a file may be made or replaced; clean up after a killed run.

    Parameters
    ----------
    out : Path
    is_own : callable
        Whether a file that is there was made by the same verb.
    verb : str
        For the message.

    Raises
    ------
    OutputError
        If the file is there and not the verb's own, would stand for a file of a run folder, or
        its folder cannot be written to.
    """
    check_writable(out.parent)
    if out.name in RUN_FILES and (out.parent / "run.toml").exists():
        raise OutputError(f"{out}: {out.parent} is a run folder, and {out.name} a file of its own")
    if (out.exists() or out.is_symlink()) and not (out.is_file() and is_own(out)):
        raise OutputError(
            f"{out} is there already, and `{verb}` did not make it{_as_it_is(out)}; choose another "
            "file, or delete it"
        )
    remove_temporaries(out.parent, lambda name: name == out.name)


def _as_it_is(out: Path) -> str:
    """What to add of a file that was made and then edited."""
    if not out.is_file():  # a pipe would never end
        return ""
    try:
        return " as it is now: it was edited" if is_edited(out.read_text(encoding="utf-8")) else ""
    except (OSError, UnicodeDecodeError):
        return ""


def is_set_of(verb: str) -> Callable[[Path], bool]:
    """Whether a TOML file says in its comments, or as version 0.4 did, that `verb` made it.

    One that was edited since is its user's.
    """

    def is_own(file: Path) -> bool:
        try:
            content = read_toml(file, OdometryError)
            text = file.read_text(encoding="utf-8")
        except (OdometryError, OSError):
            return False
        head = text.split("\n", 2)[:2]
        if is_edited(text):
            return False
        return head[-1] == f"# {MADE_BY}{verb}" or _is_of_version_0_4(content, verb)

    return is_own


def is_text_of(verb: str) -> Callable[[Path], bool]:
    """Whether the second line of a text file says that `verb` made it."""

    def is_own(file: Path) -> bool:
        try:
            with file.open("rb") as opened:
                head = opened.read(HEAD_BYTES).split(b"\n", 2)[:2]
        except OSError:
            return False
        return head[-1] == f"# {MADE_BY}{verb}".encode()

    return is_own


def picture_source(verb: str) -> str:
    """What a picture that `verb` made says of itself: `save_figure` writes it."""
    return f"{MADE_BY}{verb}\n"


def is_picture_of(verb: str) -> Callable[[Path], bool]:
    """Whether a PNG file says in its texts that `verb` made it."""

    def is_own(file: Path) -> bool:
        try:
            with file.open("rb") as opened:
                return picture_source(verb).encode() in opened.read(HEAD_BYTES)
        except OSError:
            return False

    return is_own


def _is_of_version_0_4(content: Mapping[str, Any], verb: str) -> bool:
    """Whether all tables name the source that version 0.4 gave to what it identified."""
    terrains = content.get("terrain")
    tables = [content.get("modes"), *(terrains.values() if isinstance(terrains, dict) else ())]
    sources = [str(table.get("source", "")) for table in tables if isinstance(table, dict)]
    return bool(sources) and all(one.startswith(SET_SOURCES_0_4[verb]) for one in sources)
