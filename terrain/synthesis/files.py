"""Cameras and vehicles described in TOML files."""

from pathlib import Path
from typing import Any

from odometry.io.structured import read_toml
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
    content = read_toml(file, SynthesisError)
    table = content.get(name)
    if not isinstance(table, dict):
        raise SynthesisError(f"{file}: the table [{name}] is missing; seen: {sorted(content)}")
    return table
