"""Frozen blocks of settings, read from TOML; an unknown key is an error."""

import math
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

from odometry.errors import ConfigError
from odometry.io import structured

LARGEST = 1e6  # metres, seconds, hertz of a setting; squares of larger ones lose all digits
SMALLEST = 1e-6  # of a setting that divides
Block = TypeVar("Block")


def block_from_table(kind: type[Block], table: Mapping[str, Any], where: str) -> Block:
    """Make a frozen block (a dataclass with defaults) from a TOML table.

    Raises
    ------
    ConfigError
        On an unknown key or a value of another type than the default's.
    """
    known = {field.name: field for field in fields(kind)}  # type: ignore[arg-type]
    values: dict[str, Any] = {}
    for key, value in table.items():
        if key not in known:
            raise ConfigError(f"{where}: unknown key {key!r}; known: {', '.join(known)}")
        expected: Any = type(known[key].default)
        allowed = (int, float) if expected is float else (expected,)
        if not isinstance(value, allowed) or (isinstance(value, bool) and expected is not bool):
            raise ConfigError(f"{where}: {key} = {value!r}, expected a {expected.__name__}")
        if isinstance(value, float) and not math.isfinite(value):
            raise ConfigError(f"{where}: {key} = {value}, expected a finite number")
        values[key] = expected(value)
    try:
        return kind(**values)
    except ConfigError as error:
        raise ConfigError(f"{where}: {error}") from error


def read_toml(file: Path) -> dict[str, Any]:
    """Read a TOML file.

    Raises
    ------
    ConfigError
        As `odometry.io.structured.read_toml`.
    """
    return structured.read_toml(file, ConfigError)


def require(condition: bool, message: str) -> None:
    """Raise ConfigError with `message` unless `condition` holds."""
    if not condition:
        raise ConfigError(message)


def require_positive(block: Any, *names: str) -> None:
    """Raise ConfigError unless the named settings of a block are SMALLEST to LARGEST."""
    for name in names:
        value = getattr(block, name)
        require(
            SMALLEST <= value <= LARGEST,
            f"{name} = {value}, expected above 0: {SMALLEST:g} to {LARGEST:g}",
        )
