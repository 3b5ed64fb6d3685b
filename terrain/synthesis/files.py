"""Cameras and vehicles described in TOML files."""

import tomllib
from pathlib import Path
from typing import Any

from terrain.camera import Camera
from terrain.errors import SynthesisError


def read_camera(file: Path) -> Camera:
    """Camera of the `[camera]` table of a TOML file.

    Raises
    ------
    SynthesisError
        If the file cannot be read or has no such table.
    CameraError
        If the table is not as the format says.
    """
    return Camera.from_table(_read_table(file, "camera"), where=str(file))


def read_robot(file: Path) -> dict[str, Any]:
    """Read the `[robot]` table of a TOML file.

    Raises
    ------
    SynthesisError
        If the file cannot be read or has no such table.
    """
    return _read_table(file, "robot")


def _read_table(file: Path, name: str) -> dict[str, Any]:
    try:
        with file.open("rb") as stream:
            content = tomllib.load(stream)
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SynthesisError(f"{file}: cannot be read as TOML: {error}") from error
    table = content.get(name)
    if not isinstance(table, dict):
        raise SynthesisError(f"{file}: the table [{name}] is missing; seen: {sorted(content)}")
    return table
