"""Model files of classifiers: arrays and JSON, see `odometry.io.array_file`."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from odometry.arrays import AnyArray
from odometry.io.array_file import FileKind, read_array_file, write_array_file
from terrain.errors import ModelFileError

CLASSIFIER = FileKind("terrain-odometry classifier", 1, "model file", ModelFileError)


def write_model(
    path: Path,
    settings: Mapping[str, Any],
    arrays: Mapping[str, AnyArray],
    made: Mapping[str, Any] | None = None,
) -> None:
    """Write settings (JSON values) and arrays (numeric); the same content gives the same bytes.

    `made` says what made the model; it is kept in the header, for people alone.
    """
    write_array_file(path, CLASSIFIER, settings, arrays, made)


def read_model(path: Path) -> tuple[dict[str, Any], dict[str, AnyArray]]:
    """Read what `write_model` wrote: the settings and the arrays.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, not a model, or of a newer version.
    """
    return read_array_file(path, CLASSIFIER)


def is_model(path: Path) -> bool:
    """Whether a file is a whole model file of a format that this program reads."""
    try:
        read_model(path)
    except ModelFileError:
        return False
    return True
