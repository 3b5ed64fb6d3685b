"""Model files: arrays and JSON in one zip, checked by SHA-256, never executed.

A model file is an uncompressed zip of ``header.json`` and one ``.npy`` member per array. Its
header holds the format, its version, the settings and the SHA-256 of every array; the member
``sha256`` holds the SHA-256 of the header. `numpy.load` opens the arrays.
"""

import hashlib
import io
import json
import math
import tokenize
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray
from odometry.io.files import atomic_write
from odometry.io.input_file import read_bytes
from odometry.io.structured import parsed_json
from odometry.outputs.formats import check_format
from terrain.errors import ModelFileError

FORMAT = "terrain-odometry classifier"
VERSION = 1
HEADER = "header.json"
CHECKSUM = "sha256"
MODEL_BYTES = 1024**3
ZIP_ERRORS = (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, ValueError, OSError)
NPY_ERRORS = (ValueError, SyntaxError, TypeError, RecursionError, MemoryError, tokenize.TokenError)


def write_model(
    path: Path,
    settings: Mapping[str, Any],
    arrays: Mapping[str, AnyArray],
    made: Mapping[str, Any] | None = None,
) -> None:
    """Write settings (JSON values) and arrays (numeric); the same content gives the same bytes.

    `made` says what made the model; it is kept in the header, and no reader needs it.
    """
    members = {f"{name}.npy": _to_npy(arrays[name]) for name in sorted(arrays)}
    header = {
        "format": FORMAT,
        "version": VERSION,
        "settings": dict(settings),
        "sha256": {name: hashlib.sha256(data).hexdigest() for name, data in members.items()},
        "made": dict(made or {}),
    }
    text = json.dumps(header, indent=1, sort_keys=True, allow_nan=False).encode()
    members = {HEADER: text, CHECKSUM: hashlib.sha256(text).hexdigest().encode()} | members
    with atomic_write(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name, data in members.items():
            archive.writestr(zipfile.ZipInfo(name), data)


def read_model(path: Path) -> tuple[dict[str, Any], dict[str, AnyArray]]:
    """Read what `write_model` wrote: the settings and the arrays.

    Members may not claim more bytes than the file has, as a compressed bomb would.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, not a model, or of a newer version.
    """
    data = read_bytes(path, ModelFileError, MODEL_BYTES, "a model has a few million")
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = _stored_members(path, archive, len(data))
    except ZIP_ERRORS as error:
        raise ModelFileError(f"{path}: cannot be read as a model file: {error}") from error
    header = _read_header(path, members)
    return header["settings"], {
        name.removesuffix(".npy"): _from_npy(path, name, data)
        for name, data in members.items()
        if name.endswith(".npy")
    }


def is_model(path: Path) -> bool:
    """Whether a file is a whole model file of a format that this program reads."""
    try:
        read_model(path)
    except ModelFileError:
        return False
    return True


def _stored_members(path: Path, archive: zipfile.ZipFile, size: int) -> dict[str, bytes]:
    entries = archive.infolist()
    claimed = sum(entry.file_size for entry in entries)
    if claimed > size:
        raise ModelFileError(
            f"{path}: its members claim {claimed} bytes, the file has {size}; a model file stores "
            "them uncompressed"
        )
    return {entry.filename: archive.read(entry) for entry in entries}


def _read_header(path: Path, members: Mapping[str, bytes]) -> dict[str, Any]:
    if HEADER not in members:
        raise ModelFileError(f"{path}: there is no {HEADER} in it; not a model file")
    try:
        header = parsed_json(members[HEADER], path, ModelFileError)
    except ModelFileError as error:
        raise ModelFileError(f"{error}; not a model file") from error
    if not isinstance(header, dict) or header.get("format") != FORMAT:
        raise ModelFileError(f"{path}: {HEADER} does not say '{FORMAT}'; not a model file")
    check_format(path, header.get("version"), VERSION, ModelFileError)
    for table in ("settings", "sha256"):
        if not isinstance(header.get(table), dict):
            raise ModelFileError(f"{path}: {HEADER} has no table '{table}'; damaged")
    expected = {HEADER: members.get(CHECKSUM, b"").decode("ascii", "replace")}
    expected |= header["sha256"]
    if set(expected) | {CHECKSUM} != set(members):
        raise ModelFileError(f"{path}: holds {sorted(members)}, expected {sorted(expected)}")
    for name, checksum in expected.items():
        if hashlib.sha256(members[name]).hexdigest() != checksum:
            raise ModelFileError(f"{path}: the checksum of {name} does not agree; damaged")
    return header


def _to_npy(array: AnyArray) -> bytes:
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.ascontiguousarray(array), (1, 0), allow_pickle=False)
    return stream.getvalue()


def _from_npy(path: Path, name: str, data: bytes) -> AnyArray:
    stream = io.BytesIO(data)
    try:
        np.lib.format.read_magic(stream)
        shape, fortran, dtype = np.lib.format.read_array_header_1_0(stream)
    except NPY_ERRORS as error:
        raise ModelFileError(f"{path}: {name} is not an array: {error}") from error
    rest = data[stream.tell() :]
    if (
        fortran
        or min(shape, default=0) < 0
        or dtype.kind not in "fi"
        or math.prod(shape) * dtype.itemsize != len(rest)
    ):
        raise ModelFileError(f"{path}: {name} claims {shape} of {dtype}, holds {len(rest)} bytes")
    array = np.frombuffer(rest, dtype=dtype).reshape(shape).copy()
    if not np.isfinite(array).all():
        raise ModelFileError(f"{path}: {name} holds numbers that are not finite")
    return array
