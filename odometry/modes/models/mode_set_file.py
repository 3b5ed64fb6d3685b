"""A set of modes and how long each lasts, as TOML."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import ParameterError
from odometry.io.files import atomic_write
from odometry.io.formats import check_first_line, format_line, made_text
from odometry.io.structured import read_toml
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.models.traction import TractionModes
from odometry.modes.models.velocity import VelocityModes

FORMAT = 1  # of the file, in its first line
LARGEST, SMALLEST = 1e9, 1e-18  # of a number, and of one above 0: a standard deviation of 1e-9
IS_OF_SIGN: dict[str, Callable[[FloatArray], BoolArray]] = {
    "": np.isfinite,
    "above 0": lambda values: values >= SMALLEST,
    "0 or more": lambda values: values >= 0,
}


@dataclass(frozen=True)
class Key:
    """A key of a table, which is an attribute of the modes; its shape and sign."""

    name: str
    shape: tuple[int, ...]
    sign: str = ""  # "above 0", "0 or more", or any


WIDTH = Key("track_width", (), "above 0")
HEAD = {
    "velocity": (Key("errors_last_s", (), "0 or more"),),
    "traction": (
        WIDTH,
        Key("process_variance", (3,), "above 0"),
        Key("measurement_variance", (4,), "above 0"),
        Key("variance_growth", (), "0 or more"),
    ),
}
FASTEST = Key("fastest_m_s", (), "above 0")
OPTIONAL = {
    "velocity": (
        FASTEST,
        WIDTH,
        Key("turning_least_m", ()),
        Key("turning_most_m", ()),
    ),
    "traction": (FASTEST, Key("gain_power", (), "0 or more")),
}
MODE = {
    "velocity": (
        Key("A", (2, 2)),
        Key("B", (2, 2)),
        Key("process_variance", (2,), "above 0"),
        Key("measurement_variance", (2,), "above 0"),
    ),
    "traction": (Key("gains", (2, 3, 5)), Key("lag_s", (), "0 or more")),
}
OPTIONAL_MODE: dict[str, tuple[Key, ...]] = {
    "velocity": (
        Key("speed_power", (2,), "0 or more"),
        Key("gain_spread", (), "0 or more"),
        Key("turn_spread", (2,), "0 or more"),
        Key("turn_power", (2,), "0 or more"),
    ),
    "traction": (
        Key("gain_spread", (), "0 or more"),
        Key("centre_spread", (2,), "0 or more"),
        Key("centre_noise", (2,), "0 or more"),
    ),
}
KINDS: dict[str, type[VelocityModes] | type[TractionModes]] = {
    "velocity": VelocityModes,
    "traction": TractionModes,
}


def write_mode_set(file: Path, mode_set: ModeSet, comment: str = "") -> None:
    """Write a set of modes: [modes], and a table [mode.NAME] for each.

    `comment` holds whole lines that begin with `#`, and goes below the line of the format.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> from pathlib import Path
    >>> import odometry
    >>> modes = odometry.read_mode_set(odometry.shipped_data() / "modes" / "demo.toml")
    >>> with TemporaryDirectory() as folder:
    ...     file = Path(folder) / "modes.toml"
    ...     odometry.write_mode_set(file, modes)
    ...     print(file.read_text().splitlines()[0])
    # terrain-odometry mode set, format 1
    """
    modes = mode_set.modes
    head: dict[str, Any] = {"kind": modes.kind, "source": mode_set.source}
    head |= {one.name: _plain(getattr(modes, one.name)) for one in HEAD[modes.kind]}
    head |= {
        one.name: _plain(getattr(modes, one.name))
        for one in OPTIONAL[modes.kind]
        if np.isfinite(getattr(modes, one.name))
    }
    tables = {
        name: {one.name: _plain(getattr(modes, one.name)[row]) for one in _keys_of(modes)}
        | {"dwell_s": float(mode_set.dwell_s[row])}
        for row, name in enumerate(modes.names)
    }
    with atomic_write(file) as part:
        text = tomli_w.dumps({"modes": head, "mode": tables})
        line = format_line("mode set", FORMAT)
        part.write_text(made_text(line, comment, text), encoding="utf-8")


def read_mode_set(file: Path) -> ModeSet:
    """Read what `write_mode_set` wrote.

    Raises
    ------
    ParameterError
        Naming file, table and key: not TOML, an unknown or missing key, a number that is not
        finite, a shape or a variance that cannot be, a newer format.

    Examples
    --------
    >>> import odometry
    >>> odometry.read_mode_set(odometry.shipped_data() / "modes" / "demo.toml").names
    ('grass', 'gravel')
    """
    check_first_line(Path(file), FORMAT, ParameterError)
    content = read_toml(Path(file), ParameterError)
    head, tables = content.get("modes"), content.get("mode")
    if not isinstance(head, dict) or head.get("kind") not in list(KINDS):
        kinds = ", ".join(KINDS)
        raise ParameterError(
            f"{file}: expected [modes] with kind = one of {kinds}: a set that `identify-modes` made"
        )
    if not isinstance(tables, dict) or not tables:
        raise ParameterError(f"{file}: expected a table [mode.NAME] for each mode")
    kind, where = head["kind"], f"{file}: [modes]"
    _only(head, {"kind", "source", *(o.name for o in (*HEAD[kind], *OPTIONAL[kind]))}, where)
    given = (*HEAD[kind], *(one for one in OPTIONAL[kind] if one.name in head))
    values: dict[str, Any] = {one.name: _array(head, one, where) for one in given}
    dwell = Key("dwell_s", (), "above 0")
    keys = (*MODE[kind], dwell)
    for name, table in tables.items():
        known = {one.name for one in (*keys, *OPTIONAL_MODE[kind])}
        _only(table, known, f"{file}: [mode.{name}]")
    in_any = [o for o in OPTIONAL_MODE[kind] if any(o.name in table for table in tables.values())]
    for one in (*keys, *in_any):
        of_modes = [_array(table, one, f"{file}: [mode.{name}]") for name, table in tables.items()]
        values[one.name] = np.stack(of_modes)
    values = {name: of if of.shape else float(of) for name, of in values.items()}
    dwell_s = values.pop("dwell_s")
    try:
        modes = KINDS[kind](names=tuple(tables), **values)
        return ModeSet(modes, dwell_s, str(head.get("source", "")))
    except ParameterError as error:
        raise ParameterError(f"{file}: {error}") from error


def _keys_of(modes: VelocityModes | TractionModes) -> tuple[Key, ...]:
    """Those of a table: all that are needed, and the optional ones that are known."""
    optional = OPTIONAL_MODE[modes.kind]
    return (*MODE[modes.kind], *(o for o in optional if getattr(modes, o.name) is not None))


def _plain(values: FloatArray | float) -> Any:
    return np.asarray(values).tolist()


def _only(table: Any, known: set[str], where: str) -> None:
    if not isinstance(table, dict):
        raise ParameterError(f"{where} = {table!r}, expected a table")
    unknown = sorted(set(table) - known)
    if unknown:
        raise ParameterError(f"{where}: unknown key {unknown[0]!r}; known: {sorted(known)}")


def _array(table: dict[str, Any], one: Key, where: str) -> FloatArray:
    if one.name not in table:
        raise ParameterError(f"{where}: {one.name} is missing")
    try:
        values = np.asarray(table[one.name], dtype=np.float64)
    except (TypeError, ValueError):
        values = np.full((), math.nan)
    fits = values.shape == one.shape and bool(np.all(np.abs(values) <= LARGEST))
    if not fits or not np.all(IS_OF_SIGN[one.sign](values)):
        raise ParameterError(
            f"{where}: {one.name} = {table[one.name]!r}, expected finite numbers"
            f"{f', {one.sign}' if one.sign else ''}, shape {one.shape}"
        )
    return values
