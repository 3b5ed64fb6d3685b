"""The place of x = y = 0 on Earth, as `[source]` of run.toml states it."""

import tomllib
from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any

import tomli_w

from odometry.fixes.local_metres import Origin
from odometry.io.files import atomic_write

NAMES = ("latitude", "longitude", "altitude")


def stated_origin(source: Any) -> list[float] | None:
    """Latitude, longitude [degrees] and, where it is there, height [m]; None without an origin.

    A list of these, or a table as `import` writes it.
    """
    origin = source.get("origin") if isinstance(source, Mapping) else None
    if isinstance(origin, Mapping):
        origin = [origin.get(name) for name in NAMES]
    if not isinstance(origin, list) or len(origin) not in {2, 3}:
        return None
    if not all(type(number) in {int, float} and isfinite(number) for number in origin):
        return None
    return [float(number) for number in origin]


def write_origin(folder: Path, origin: Origin) -> str:
    """Add `[source.origin]` to the end of run.toml; what was done, in words.

    Nothing is written where the file has an origin of another form.
    """
    file = folder / "run.toml"
    table = tomli_w.dumps({"source": {"origin": dict(zip(NAMES, origin, strict=True))}})
    table = table[table.index("[source.origin]") :]
    text = file.read_bytes().decode("utf-8")
    end = "\r\n" if "\r\n" in text else "\n"
    new = text.rstrip() + end * 2 + table.replace("\n", end)
    try:
        tomllib.loads(new)
    except tomllib.TOMLDecodeError:
        return "run.toml is left as it was: write the origin to its [source] by hand"
    with atomic_write(file) as part:
        part.write_bytes(new.encode("utf-8"))
    return "run.toml: [source.origin] is that place"
