"""Parameter sets: one table of model parameters for each terrain, as TOML."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.io.files import atomic_write
from odometry.io.formats import check_first_line, format_line, made_text
from odometry.io.structured import read_toml
from odometry.models.catalogue import MODELS, OPTIONAL_NAMES, PARAMETER_NAMES
from odometry.parameter_covariance import covariance_of_table, finite_number
from odometry.recording.run import UNKNOWN

FORMAT = 1  # of a file that this program writes, in its first line


@dataclass(frozen=True)
class TerrainParameters:
    """The parameters of one model on one terrain.

    Attributes
    ----------
    model : str
        A name of the catalogue.
    values : Mapping[str, float]
        Parameters by name, SI units.
    covariance_order : tuple of str
        The parameters of `covariance`, in its order; empty where the set states none.
    covariance : (K, K)
    source : str
        Where the values come from.
    effects : tuple of Mapping
        Effects added to the model, as the set holds them.

    Examples
    --------
    >>> import odometry
    >>> grass = odometry.TerrainParameters("icr", {"y_left": 0.35, "y_right": -0.33, "x_icr": 0.0})
    >>> grass.model, grass.source
    ('icr', '')
    """

    model: str
    values: Mapping[str, float]
    covariance_order: tuple[str, ...] = ()
    covariance: FloatArray = field(default_factory=lambda: np.empty((0, 0)))
    source: str = ""
    effects: tuple[Mapping[str, Any], ...] = ()

    def covariance_of(self, names: tuple[str, ...]) -> FloatArray:
        """Covariance of the named parameters, all of them of `covariance_order`."""
        places = [self.covariance_order.index(name) for name in names]
        return self.covariance[np.ix_(places, places)]


@dataclass(frozen=True)
class ParameterSet:
    """Parameters by terrain, in the order of the file.

    Attributes
    ----------
    terrains : Mapping[str, TerrainParameters]
    vehicle : Mapping
        name, source and what else `[vehicle]` holds.

    Examples
    --------
    >>> import odometry
    >>> grass = odometry.TerrainParameters("icr", {"y_left": 0.35, "y_right": -0.33, "x_icr": 0.0})
    >>> odometry.ParameterSet({"grass": grass}).terrains["grass"].values["y_left"]
    0.35
    """

    terrains: Mapping[str, TerrainParameters] = field(default_factory=dict)
    vehicle: Mapping[str, Any] = field(default_factory=dict)


def read_parameters(file: str | Path) -> ParameterSet:
    """Read a parameter set.

    Raises
    ------
    ParameterError
        Naming file, table and key: not TOML, an unknown model or key, a parameter missing or
        not a finite number, a covariance that is not symmetric and positive semi-definite; a
        set of skid modes, or a file of a newer format.

    Examples
    --------
    >>> import odometry
    >>> sets = odometry.shipped_data() / "parameters"
    >>> warthog = odometry.read_parameters(sets / "warthog_icr.toml")
    >>> list(warthog.terrains)
    ['concrete', 'snow']
    """
    file = Path(file)
    check_first_line(file, FORMAT, ParameterError)
    content = read_toml(file, ParameterError)
    unknown = sorted(set(content) - {"vehicle", "terrain"})
    if "modes" in content:
        raise ParameterError(
            f"{file}: a set of skid modes, made by `identify-modes`; expected parameters "
            "([terrain.NAME]), as `identify` makes them. `modes --models` and `run --modes` take it"
        )
    if unknown:
        raise ParameterError(f"{file}: unknown table [{unknown[0]}]; known: vehicle, terrain")
    tables = content.get("terrain", {})
    if not isinstance(tables, dict) or not tables:
        raise ParameterError(f"{file}: no table [terrain.NAME]; expected at least one")
    vehicle = content.get("vehicle", {})
    if not isinstance(vehicle, dict):
        raise ParameterError(f"{file}: vehicle = {vehicle!r}, expected a table [vehicle]")
    return ParameterSet(
        {
            name: _terrain(table, name, f"{file}: [terrain.{name}]")
            for name, table in tables.items()
        },
        vehicle,
    )


def write_parameters(file: str | Path, parameters: ParameterSet, comment: str = "") -> None:
    """Write a parameter set; `read_parameters` gives it back.

    `comment` holds whole lines that begin with `#`, and goes below the line of the format.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> import odometry
    >>> ideal = odometry.TerrainParameters("differential_drive", {"track_width": 0.4})
    >>> with TemporaryDirectory() as folder:
    ...     odometry.write_parameters(f"{folder}/set.toml", odometry.ParameterSet({"yard": ideal}))
    ...     print(odometry.read_parameters(f"{folder}/set.toml").terrains["yard"].values)
    {'track_width': 0.4}
    """
    content: dict[str, Any] = {}
    if parameters.vehicle:
        content["vehicle"] = dict(parameters.vehicle)
    content["terrain"] = {name: _table(of) for name, of in parameters.terrains.items()}
    with atomic_write(Path(file)) as part:
        head = format_line("parameter set", FORMAT)
        part.write_text(made_text(head, comment, tomli_w.dumps(content)), encoding="utf-8")


def _terrain(table: Any, name: str, where: str) -> TerrainParameters:
    if name == UNKNOWN:
        raise ParameterError(f"{where}: the name {name!r} is reserved")
    if not isinstance(table, dict):
        raise ParameterError(f"{where}: {table!r}, expected a table")
    model = table.get("model", "icr")
    if not isinstance(model, str) or model not in PARAMETER_NAMES:
        raise ParameterError(
            f"{where}: unknown model {model!r}; known: {', '.join(PARAMETER_NAMES)}"
        )
    names = PARAMETER_NAMES[model]
    for key in table:
        if key not in {*names, "model", "source", "sigma", "covariance", "effects"}:
            raise ParameterError(
                f"{where}: unknown key {key!r}; the model {model!r} has {', '.join(names)}"
            )
    missing = [key for key in names if key not in table and key not in OPTIONAL_NAMES]
    if missing:
        raise ParameterError(f"{where}: the model {model!r} needs {missing[0]!r}")
    values = {key: finite_number(table[key], f"{where}: {key}") for key in names if key in table}
    if {"y_left", "y_right"} <= set(values) and values["y_left"] <= values["y_right"]:
        raise ParameterError(
            f"{where}: y_left = {values['y_left']} and y_right = {values['y_right']}, "
            "expected y_left > y_right"
        )
    if model in MODELS:
        _check_values(model, values, where)
    order, covariance = covariance_of_table(table, names, where)
    return TerrainParameters(
        model,
        values,
        order,
        covariance,
        str(table.get("source", "")),
        _effects(table.get("effects", []), where),
    )


def _check_values(model: str, values: Mapping[str, float], where: str) -> None:
    try:
        MODELS[model].pack(values)
    except ParameterError as error:
        raise ParameterError(f"{where}: {error}") from error


def _effects(effects: Any, where: str) -> tuple[Mapping[str, Any], ...]:
    if not isinstance(effects, list) or not all(isinstance(effect, dict) for effect in effects):
        raise ParameterError(f"{where}: effects = {effects!r}, expected tables [[...effects]]")
    return tuple(effects)


def _table(parameters: TerrainParameters) -> dict[str, Any]:
    table: dict[str, Any] = {"model": parameters.model, **parameters.values}
    if parameters.source:
        table["source"] = parameters.source
    if parameters.covariance_order:
        table["covariance"] = {
            "order": list(parameters.covariance_order),
            "matrix": parameters.covariance.tolist(),
        }
    if parameters.effects:
        table["effects"] = [dict(effect) for effect in parameters.effects]
    return table
