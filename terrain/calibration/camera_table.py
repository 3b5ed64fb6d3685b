"""The table [camera] of a run folder, replaced in the text of run.toml."""

import json
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import tomli_w

from odometry.io.files import atomic_write
from odometry.io.structured import read_toml
from terrain.errors import CalibrationError

KEYS = ("image_size", "matrix", "distortion", "mount", "ground_to_image")
HEADER = re.compile(r"^\s*\[\[?[^\[\],]+\]?\]\s*(#.*)?$")
CAMERA = re.compile(r"^\s*\[\s*camera\s*\]\s*(#.*)?$")


def write_camera(folder: Path, table: Mapping[str, Any]) -> None:
    """Put a camera into the run.toml of a run folder; all else in the file stays as it is.

    Keys of an earlier [camera] that do not describe the camera are kept.

    Parameters
    ----------
    folder : Path
    table : Mapping
        Of `Camera.to_table`.

    Raises
    ------
    CalibrationError
        If [camera] has a form that cannot be replaced.
    OutputError
        If the file cannot be written.
    """
    file = folder / "run.toml"
    before = read_toml(file, CalibrationError)
    old = before.get("camera", {})
    kept = {name: old[name] for name in old if name not in KEYS} if isinstance(old, dict) else {}
    wanted = dict(table) | kept
    text = file.read_bytes().decode("utf-8")
    new = replaced(text, {name: v for name, v in wanted.items() if not isinstance(v, dict)})
    try:
        reads_back = tomllib.loads(new) == before | {"camera": wanted}
    except tomllib.TOMLDecodeError:
        reads_back = False
    if not reads_back:
        raise CalibrationError(
            f"{file}: [camera] has a form that cannot be replaced; put the table in by hand"
        )
    with atomic_write(file) as part:
        part.write_bytes(new.encode("utf-8"))


def camera_text(table: Mapping[str, Any]) -> str:
    """[camera] as TOML, one line a key."""
    known = [f"{key} = {json.dumps(table[key])}\n" for key in KEYS if key in table]
    others = {key: value for key, value in table.items() if key not in KEYS}
    return "".join(["[camera]\n", *known, tomli_w.dumps(others)])


def replaced(text: str, table: Mapping[str, Any]) -> str:
    """The text of a TOML file with the table [camera] in place of its own, or at its end."""
    end_of_line = "\r\n" if "\r\n" in text else "\n"
    lines = text.splitlines(keepends=True)
    block = camera_text(table).replace("\n", end_of_line)
    begin = next((k for k, line in enumerate(lines) if CAMERA.match(line)), None)
    if begin is None:
        gap = "" if not text or text.endswith(end_of_line * 2) else end_of_line
        ended = text if not text or text.endswith("\n") else text + end_of_line
        return ended + gap + block
    after = (k for k in range(begin + 1, len(lines)) if HEADER.match(lines[k]))
    end = next(after, len(lines))
    while end > begin + 1 and (not lines[end - 1].strip() or lines[end - 1].lstrip()[0] == "#"):
        end -= 1  # blank lines and comments above the next table are its own
    return "".join(lines[:begin]) + block + "".join(lines[end:])
