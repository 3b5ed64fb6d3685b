"""Files of arrays and JSON in one zip, checked by SHA-256, never executed.

Such a file is an uncompressed zip of ``header.json`` and one ``.npy`` member per array. Its
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
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray
from odometry.errors import OdometryError
from odometry.io.files import atomic_write, read_bytes
from odometry.io.formats import check_format
from odometry.io.structured import parsed_json

HEADER = "header.json"
CHECKSUM = "sha256"
MODEL_BYTES = 1024**3
ZIP_ERRORS = (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, ValueError, OSError)
NPY_ERRORS = (ValueError, SyntaxError, TypeError, RecursionError, MemoryError, tokenize.TokenError)


@dataclass(frozen=True)
class FileKind:
    """What such a file is.

    Attributes
    ----------
    format : str
        Its name, which the header holds.
    version : int
        The newest that this program reads.
    noun : str
        For messages: "not a NOUN".
    error : type of OdometryError
        Raised where a file is not of this kind.
    """

    format: str
    version: int
    noun: str
    error: type[OdometryError]


def write_array_file(
    path: Path,
    kind: FileKind,
    settings: Mapping[str, Any],
    arrays: Mapping[str, AnyArray],
    made: Mapping[str, Any] | None = None,
) -> None:
    """Write settings (JSON values) and arrays (numeric); the same content gives the same bytes.

    `made` says what made the file; it is kept in the header, and no reader needs it.
    """
    members = {f"{name}.npy": _to_npy(arrays[name]) for name in sorted(arrays)}
    header = {
        "format": kind.format,
        "version": kind.version,
        "settings": dict(settings),
        "sha256": {name: hashlib.sha256(data).hexdigest() for name, data in members.items()},
        "made": dict(made or {}),
    }
    text = json.dumps(header, indent=1, sort_keys=True, allow_nan=False).encode()
    members = {HEADER: text, CHECKSUM: hashlib.sha256(text).hexdigest().encode()} | members
    with atomic_write(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        for name, data in members.items():
            archive.writestr(zipfile.ZipInfo(name), data)


def read_array_file(path: Path, kind: FileKind) -> tuple[dict[str, Any], dict[str, AnyArray]]:
    """Read what `write_array_file` wrote: the settings and the arrays.

    Members may not claim more bytes than the file has, as a compressed bomb would.

    Raises
    ------
    OdometryError
        Of the kind's own, if the file is missing, damaged, of another kind, or of a newer version.
    """
    data = read_bytes(path, kind.error, MODEL_BYTES, "a model has a few million")
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = _stored_members(path, archive, len(data), kind)
    except ZIP_ERRORS as error:
        raise kind.error(f"{path}: cannot be read as a {kind.noun}: {error}") from error
    header = _read_header(path, members, kind)
    return header["settings"], {
        name.removesuffix(".npy"): _from_npy(path, name, data, kind)
        for name, data in members.items()
        if name.endswith(".npy")
    }


def _stored_members(
    path: Path, archive: zipfile.ZipFile, size: int, kind: FileKind
) -> dict[str, bytes]:
    entries = archive.infolist()
    claimed = sum(entry.file_size for entry in entries)
    if claimed > size:
        raise kind.error(
            f"{path}: its members claim {claimed} bytes, the file has {size}; a {kind.noun} stores "
            "them uncompressed"
        )
    return {entry.filename: archive.read(entry) for entry in entries}


def _read_header(path: Path, members: Mapping[str, bytes], kind: FileKind) -> dict[str, Any]:
    if HEADER not in members:
        raise kind.error(f"{path}: there is no {HEADER} in it; not a {kind.noun}")
    try:
        header = parsed_json(members[HEADER], path, kind.error)
    except kind.error as error:
        raise kind.error(f"{error}; not a {kind.noun}") from error
    if not isinstance(header, dict) or header.get("format") != kind.format:
        raise kind.error(f"{path}: {HEADER} does not say '{kind.format}'; not a {kind.noun}")
    check_format(path, header.get("version"), kind.version, kind.error)
    for table in ("settings", "sha256"):
        if not isinstance(header.get(table), dict):
            raise kind.error(f"{path}: {HEADER} has no table '{table}'; damaged")
    expected = {HEADER: members.get(CHECKSUM, b"").decode("ascii", "replace")}
    expected |= header["sha256"]
    if set(expected) | {CHECKSUM} != set(members):
        raise kind.error(f"{path}: holds {sorted(members)}, expected {sorted(expected)}")
    for name, checksum in expected.items():
        if hashlib.sha256(members[name]).hexdigest() != checksum:
            raise kind.error(f"{path}: the checksum of {name} does not agree; damaged")
    return header


def _to_npy(array: AnyArray) -> bytes:
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.ascontiguousarray(array), (1, 0), allow_pickle=False)
    return stream.getvalue()


def _from_npy(path: Path, name: str, data: bytes, kind: FileKind) -> AnyArray:
    stream = io.BytesIO(data)
    try:
        np.lib.format.read_magic(stream)
        shape, fortran, dtype = np.lib.format.read_array_header_1_0(stream)
    except NPY_ERRORS as error:
        raise kind.error(f"{path}: {name} is not an array: {error}") from error
    rest = data[stream.tell() :]
    if (
        fortran
        or min(shape, default=0) < 0
        or dtype.kind not in "fi"
        or math.prod(shape) * dtype.itemsize != len(rest)
    ):
        raise kind.error(f"{path}: {name} claims {shape} of {dtype}, holds {len(rest)} bytes")
    array = np.frombuffer(rest, dtype=dtype).reshape(shape).copy()
    if not np.isfinite(array).all():
        raise kind.error(f"{path}: {name} holds numbers that are not finite")
    return array
