"""Parameter sets that hold effects: from a table to a model, and back."""

from collections.abc import Mapping

from odometry.arrays import FloatArray
from odometry.effects.catalogue import added_effects, effect_table
from odometry.effects.interface.corrected import Added, Corrected
from odometry.errors import ParameterError
from odometry.models.base import KinematicModel
from odometry.models.catalogue import MODELS
from odometry.parameters import TerrainParameters
from odometry.recording.run import Robot


def effects_of(model: KinematicModel) -> tuple[Added, ...]:
    """The effects that were added to a model, those on the measurement among them."""
    return model.effects if isinstance(model, Corrected) else ()


def model_of(table: TerrainParameters, robot: Robot, where: str) -> KinematicModel:
    """The model of a table, with the effects that it names.

    Parameters
    ----------
    table : TerrainParameters
    robot : Robot
        The one it drives: effects take its size.
    where : str
        Of the table, for messages.

    Raises
    ------
    ParameterError
        If an effect, its form or a parameter is not known.
    """
    if table.model not in MODELS:
        raise ParameterError(f"{where}: the model {table.model!r} cannot be computed")
    base = MODELS[table.model]
    return Corrected(base, robot, added_effects(table.effects, where)) if table.effects else base


def table_of(
    model: KinematicModel,
    values: Mapping[str, float],
    order: tuple[str, ...],
    covariance: FloatArray,
    source: str,
) -> TerrainParameters:
    """A model with its values as a table; `model_of` gives it back."""
    base = model.base if isinstance(model, Corrected) else model
    effects = tuple(effect_table(added) for added in effects_of(model))
    return TerrainParameters(base.name, values, order, covariance, source, effects)
