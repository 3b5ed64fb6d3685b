"""Read TOML and JSON of bounded size, depth and numbers."""

import codecs
import io
import json
import re
import tomllib
from pathlib import Path
from typing import Any

from odometry.errors import OdometryError
from odometry.io.files import read_bytes

TOML_BYTES = 1024**2
JSON_BYTES = 16 * 1024**2
DEPTH = 32  # of tables and lists within each other; the formats of this project have 5
INTEGER = 2**63  # TOML's integers have 64 bits
# The time that tomllib takes grows with the square of the parts of a key.
DOTTED_KEY = re.compile(rb"(?<![\w\"'-])(?:[\w\"'-]++[ \t]*+\.[ \t]*+){%d}" % DEPTH)


def read_toml(file: Path, error: type[OdometryError]) -> dict[str, Any]:
    """Read a TOML file.

    Raises
    ------
    OdometryError
        Of the kind `error`, naming the file: it cannot be read, is larger than TOML_BYTES, not
        TOML, nested deeper than DEPTH, or holds an integer of more than 64 bits.
    """
    data = read_bytes(file, error, TOML_BYTES, "settings have a few thousand")
    data = data.removeprefix(codecs.BOM_UTF8)  # which editors of Windows write
    if DOTTED_KEY.search(data):
        raise error(f"{file}: a key of more than {DEPTH} parts, expected fewer")
    try:
        content = tomllib.load(io.BytesIO(data))
    except UnicodeDecodeError as problem:
        raise error(
            f"{file}: cannot be read as TOML: not UTF-8 text: {problem.reason}"
        ) from problem
    except ValueError as problem:  # TOMLDecodeError, and integers of thousands of digits
        raise error(f"{file}: cannot be read as TOML: {problem}") from problem
    except RecursionError as problem:
        raise error(f"{file}: nested too deeply, expected at most {DEPTH} levels") from problem
    _check_values(content, file, error)
    return content


def read_json(file: Path, error: type[OdometryError]) -> Any:
    """Read a JSON file; NaN and Infinity, which are no JSON, are refused.

    Raises
    ------
    OdometryError
        Of the kind `error`, as `read_toml`.
    """
    return parsed_json(
        read_bytes(file, error, JSON_BYTES, "a result has a few thousand"), file, error
    )


def parsed_json(data: bytes, file: Path, error: type[OdometryError]) -> Any:
    """The value that JSON bytes hold; `file` is for messages. Raises as `read_json`."""

    def refuse(word: str) -> None:
        raise error(f"{file}: it holds {word}, expected JSON with finite numbers")

    try:
        content = json.loads(data, parse_constant=refuse)
    except ValueError as problem:  # also of UnicodeDecodeError and integers of thousands of digits
        raise error(f"{file}: cannot be read as JSON: {problem}") from problem
    except RecursionError as problem:
        raise error(f"{file}: nested too deeply, expected at most {DEPTH} levels") from problem
    _check_values(content, file, error)
    try:
        json.dumps(content, ensure_ascii=False).encode()
    except UnicodeEncodeError as problem:
        raise error(f"{file}: holds half of a character, expected UTF-8 text") from problem
    return content


def _check_values(content: Any, file: Path, error: type[OdometryError]) -> None:
    """Walk level by level, not by recursion: the content may be deeper than the stack."""
    level = [content]
    for _ in range(DEPTH):
        inside = [value for value in level if isinstance(value, dict | list)]
        if not inside:
            break
        level = [
            one
            for value in inside
            for one in (value.values() if isinstance(value, dict) else value)
        ]
        if any(isinstance(one, int) and not -INTEGER <= one < INTEGER for one in level):
            raise error(f"{file}: an integer of more than 64 bits, expected fewer")
    else:
        if any(isinstance(value, dict | list) for value in level):
            raise error(f"{file}: nested too deeply, expected at most {DEPTH} levels")
