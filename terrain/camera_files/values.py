"""The values of a YAML, XML or JSON file as text in mappings and lists, and numbers from them."""

import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from odometry.arrays import FloatArray
from odometry.io.files import read_bytes
from odometry.io.structured import parsed_json
from terrain.errors import CameraError

FILE_BYTES = 1024**2
MOST_NUMBERS = 1000  # of one entry
SEQUENCE = "_"  # OpenCV's name of an element of a sequence in XML


def read_values(file: Path) -> Mapping[str, Any]:
    """Read a calibration file; scalars stay text, so that quoted numbers are numbers too.

    Parameters
    ----------
    file : Path
        YAML (with OpenCV's header or without), XML of OpenCV, or JSON.

    Raises
    ------
    CameraError
        Naming the file: it cannot be read, or holds no table of names and values.
    """
    data = read_bytes(file, CameraError, FILE_BYTES, "a calibration has a few thousand")
    if file.suffix.lower() == ".json":
        content = parsed_json(data, file, CameraError)
    else:
        try:
            text = data.decode("utf-8-sig").lstrip()
        except UnicodeDecodeError as problem:
            raise CameraError(f"{file}: not UTF-8 text: {problem.reason}") from problem
        content = _xml(text, file) if text.startswith("<") else _yaml(text, file)
    if not isinstance(content, Mapping):
        raise CameraError(f"{file}: no names with values, expected a calibration file")
    return content


def numbers(value: Any, name: str) -> FloatArray:
    """The numbers (N,) of an entry: a list, rows of a matrix, or a mapping with `data`.

    Raises
    ------
    CameraError
        Naming the entry, where it holds anything else.
    """
    if isinstance(value, Mapping):
        return numbers(value.get("data"), f"{name}: data")
    entries = value.split() if isinstance(value, str) else value
    if not isinstance(entries, list):
        raise CameraError(f"{name} is {_shown(value)}, expected numbers")
    flat = [one for row in entries for one in (row if isinstance(row, list) else [row])]
    if len(flat) > MOST_NUMBERS:
        raise CameraError(f"{name} has {len(flat)} values, expected at most {MOST_NUMBERS}")
    try:
        return np.array([_number(one) for one in flat], dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as problem:
        raise CameraError(f"{name} is {_shown(value)}, expected numbers") from problem


def matrix(value: Any, name: str, shape: tuple[int, int]) -> FloatArray:
    """A matrix, row by row. Raises as `numbers`, and where it has another size."""
    found = numbers(value, name)
    if found.size != shape[0] * shape[1]:
        raise CameraError(f"{name} has {found.size} values, expected {shape[0]} x {shape[1]}")
    return found.reshape(shape)


def _number(text: Any) -> float:
    if isinstance(text, bool) or not isinstance(text, str | int | float):
        raise TypeError(text)
    return float(text)


def _shown(value: Any) -> str:
    if isinstance(value, list | Mapping):
        return f"a {'list' if isinstance(value, list) else 'table'} of {len(value)}"
    return repr(value)[:60]


def _yaml(text: str, file: Path) -> Any:
    if text.startswith("%YAML"):  # OpenCV writes %YAML:1.0, which is no directive of YAML
        text = text.partition("\n")[2]
    try:
        return next(iter(yaml.load_all(text, Loader=yaml.BaseLoader)), None)
    except yaml.YAMLError as problem:
        where = " ".join(str(problem).split())[:200]
        raise CameraError(f"{file}: cannot be read as YAML: {where}") from problem
    except (RecursionError, ValueError, TypeError) as problem:
        raise CameraError(f"{file}: cannot be read as YAML") from problem


def _xml(text: str, file: Path) -> Any:
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise CameraError(f"{file}: XML with a DTD or entities, expected that of OpenCV")
    try:
        return _element(ET.fromstring(text))  # noqa: S314 - no entities, see above
    except (ET.ParseError, RecursionError, ValueError) as problem:
        raise CameraError(f"{file}: cannot be read as XML: {problem}") from problem


def _element(element: ET.Element) -> Any:
    if not len(element):
        return (element.text or "").strip()
    if all(child.tag == SEQUENCE for child in element):
        return [_element(child) for child in element]
    return {child.tag: _element(child) for child in element}
