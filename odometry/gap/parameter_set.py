"""The base model, by its name or from a parameter set."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from odometry.errors import GapError, ParameterError
from odometry.models.base import KinematicModel
from odometry.models.catalogue import MODELS, model_named
from odometry.parameters import read_parameters
from odometry.run import Run


def believed_model(
    name: str, runs: Sequence[Run], terrain: str | None = None
) -> tuple[KinematicModel, Mapping[str, float] | None]:
    """A model of the catalogue, and its parameters where `name` is a file of them.

    Of a set with several terrains, that of `terrain`, else that which the runs name.

    Raises
    ------
    GapError
        If the set has no such terrain, or effects already.
    ParameterError
        If there is no such model, or the file is no parameter set.
    """
    if Path(name).suffix != ".toml":
        return model_named(name), None
    terrains = read_parameters(name).terrains
    wanted = terrain or next((r.terrain for r in runs if r.terrain in terrains), None)
    if wanted is None and len(terrains) == 1:
        wanted = next(iter(terrains))
    if wanted is None or wanted not in terrains:
        raise GapError(
            f"{name}: no terrain {wanted!r}; it has {', '.join(terrains)}; name one with --terrain"
        )
    table = terrains[wanted]
    if table.effects:
        raise GapError(f"{name}: [terrain.{wanted}] has effects already; expected a plain model")
    if table.model not in MODELS:
        raise ParameterError(f"{name}: the model {table.model!r} cannot be computed")
    return MODELS[table.model], table.values
