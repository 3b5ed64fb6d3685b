"""What is compared: models to be identified, and parameter sets that are taken as they are."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from odometry.arrays import FloatArray
from odometry.comparison.config import ComparisonConfig
from odometry.comparison.split import Split, training_windows
from odometry.effects.tables import model_of, table_of
from odometry.errors import IdentificationError, ParameterError
from odometry.identification.fitters import fitter
from odometry.identification.plausibility import refusals
from odometry.models.base import KinematicModel
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.set_of_robot import set_notes
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows

AS_GIVEN = "taken as it is; it may have been identified on these very runs"


@dataclass(frozen=True)
class Predictor:
    """A model with parameters, ready to be evaluated.

    Attributes
    ----------
    model : KinematicModel
    values : Mapping of name to float
    covariance_order : tuple of str
        The identified parameters.
    covariance : (F, F)
    source : str
    undetermined : tuple of str
        What the windows left open; the model can be evaluated all the same.
    notes : tuple of str
        What else a reader should know of the identification.
    not_identified : tuple of str
        Why `identify` refuses the parameters: they predict, and are no answer.
    """

    model: KinematicModel
    values: Mapping[str, float]
    covariance_order: tuple[str, ...]
    covariance: FloatArray
    source: str
    undetermined: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    not_identified: tuple[str, ...] = ()

    @property
    def packed(self) -> FloatArray:
        """Parameters (P,) in the order of the model."""
        return self.model.pack(self.values)

    def to_parameters(self) -> TerrainParameters:
        """The table of a parameter set.

        Parameters that the data leave open are named in its source, and no covariance is stated.
        """
        if self.undetermined:
            source = f"{self.source}; not determined: {'; '.join(self.undetermined)}"
            return table_of(self.model, self.values, (), np.empty((0, 0)), source)
        return table_of(
            self.model, self.values, self.covariance_order, self.covariance, self.source
        )


class Candidate(ABC):
    """One row of a comparison."""

    @property
    @abstractmethod
    def label(self) -> str:
        """Its name in tables and figures."""

    @abstractmethod
    def on(
        self, split: Split, config: ComparisonConfig, near: Mapping[str, float] | None = None
    ) -> Predictor:
        """The model that may be evaluated on the held-out parts of a split.

        Parameters
        ----------
        split : Split
        config : ComparisonConfig
        near : Mapping of name to float, optional
            Where the one search starts that is then made; without it, there are several.

        Raises
        ------
        OdometryError
            Why there is none.
        """


@dataclass(frozen=True)
class IdentifiedModel(Candidate):
    """A model of the catalogue, identified on the training parts of a split.

    Attributes
    ----------
    model : KinematicModel
    fixed : Mapping of name to float
        Parameters held at a value.
    most_windows : int or None
        Where there are more, as many of them at even distances: for models that are slow.
    """

    model: KinematicModel
    fixed: Mapping[str, float] = field(default_factory=dict)
    most_windows: int | None = None

    @property
    def label(self) -> str:
        """The model's name."""
        return self.model.name

    def on(
        self, split: Split, config: ComparisonConfig, near: Mapping[str, float] | None = None
    ) -> Predictor:
        """See `Candidate.on`.

        Raises
        ------
        IdentificationError
            If no training run is of this robot on this terrain.
        """
        robot = split.held_out[0].run.robot
        if all(parameter.known for parameter in self.model.parameters):
            values = self.model.guess(robot)
            return Predictor(self.model, values, (), np.empty((0, 0)), "known of the robot")
        if not split.training:
            raise IdentificationError("no run of --train is of this robot on this terrain")
        windows = _thinned(training_windows(split.training, config.training), self.most_windows)
        fit = fitter(
            self.model,
            robot,
            fixed=self.fixed,
            window_config=config.training,
            solver_config=config.solver,
        )(windows, near)
        return Predictor(
            self.model,
            fit.values,
            fit.names,
            fit.normal_covariance,
            f"identified by terrain-odometry from {len(windows)} {fit.noun} of "
            f"{split.training_names}",
            tuple(open_.words() for open_ in fit.undetermined),
            tuple(
                f"{name} ended at the edge of its search range"
                for name in fit.at_bound
                if name not in fit.open_names
            ),
            refusals(fit),
        )


@dataclass(frozen=True)
class GivenParameters(Candidate):
    """A parameter set, by terrain, whatever it was identified on."""

    name: str
    parameters: ParameterSet

    @property
    def label(self) -> str:
        """The given name."""
        return self.name

    def on(
        self,
        split: Split,
        config: ComparisonConfig,  # noqa: ARG002 - as every candidate
        near: Mapping[str, float] | None = None,  # noqa: ARG002
    ) -> Predictor:
        """See `Candidate.on`.

        Raises
        ------
        ParameterError
            If the set has no table of the terrain.
        """
        table = self.parameters.terrains.get(split.terrain)
        if table is None:
            raise ParameterError(
                f"the set has no terrain {split.terrain!r}; it has "
                f"{', '.join(self.parameters.terrains)} (rename the table [terrain.NAME] of the "
                "set where both are one terrain)"
            )
        where = f"{self.name}: [terrain.{split.terrain}]"
        robot = split.held_out[0].run.robot
        here = ParameterSet({split.terrain: table}, self.parameters.vehicle)
        return Predictor(
            model_of(table, robot, where),
            table.values,
            table.covariance_order,
            table.covariance,
            table.source,
            notes=(AS_GIVEN, *set_notes(here, robot)),
        )


def _thinned(windows: Windows | Stretches, most: int | None) -> Windows | Stretches:
    if most is None or len(windows) <= most:
        return windows
    kept = np.zeros(len(windows), dtype=np.bool_)
    kept[np.linspace(0, len(windows) - 1, most).astype(np.int64)] = True
    return windows.where(kept)
