"""A model that is ready to be judged."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.tables import table_of
from odometry.models.base import KinematicModel
from odometry.parameters import TerrainParameters


@dataclass(frozen=True)
class Predictor:
    """A model with parameters, ready to be judged.

    Attributes
    ----------
    model : KinematicModel
    values : Mapping of name to float
    covariance_order : tuple of str
        The identified parameters.
    covariance : (F, F)
    source : str
    undetermined : tuple of str
        What the windows left open; the model can be judged all the same.
    notes : tuple of str
        What else a reader should know of the identification.
    """

    model: KinematicModel
    values: Mapping[str, float]
    covariance_order: tuple[str, ...]
    covariance: FloatArray
    source: str
    undetermined: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def packed(self) -> FloatArray:
        """Parameters (P,) in the order of the model."""
        return self.model.pack(self.values)

    def to_parameters(self) -> TerrainParameters:
        """The table of a parameter set.

        What was left open stands in its source, and no covariance is stated then.
        """
        if self.undetermined:
            source = f"{self.source}; not determined: {'; '.join(self.undetermined)}"
            return table_of(self.model, self.values, (), np.empty((0, 0)), source)
        return table_of(
            self.model, self.values, self.covariance_order, self.covariance, self.source
        )
