"""The base model of a gap: by its name or from a parameter set, and what is uncertain of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.effects.interface.base_model import Base
from odometry.errors import GapError, ParameterError
from odometry.models.base import KinematicModel
from odometry.models.catalogue import MODELS, model_named
from odometry.parameters import read_parameters
from odometry.recording.run import Run
from odometry.set_of_robot import other_width

LONGEST_LATENCY_S = 1.0
PARAMETER_SCALE, LATENCY_SCALE_S = 0.01, 0.02


@dataclass(frozen=True)
class Uncertain:
    """A base, and which of its numbers are free.

    The latency is the delay that robot and recording always have: inertia and drives make every
    robot follow its wheels' record a little late. It is identified with the base, so that it is
    not taken for an effect that is missing. A gyroscope has its own latency: it measures what
    the drives do late, and not what the stamps of poses are late.

    Attributes
    ----------
    base : Base
    free : (P,) of bool
        Of the model's parameters.
    latency_is_free : bool
    has_gyroscope : bool
        Whether a gyroscope was recorded, whose own latency is free then.
    """

    base: Base
    free: BoolArray
    latency_is_free: bool
    has_gyroscope: bool = False

    @cached_property
    def values(self) -> FloatArray:
        """The free numbers (F,): parameters, the latency, then that of the gyroscope."""
        latency = [self.base.latency_s] if self.latency_is_free else []
        own = [self.base.gyro_latency_s] if self.has_gyroscope else []
        return np.concatenate([self.base.values[self.free], latency, own])

    @property
    def names(self) -> tuple[str, ...]:
        """Of the free numbers."""
        parameters = zip(self.base.model.parameters, self.free, strict=True)
        return (
            *(parameter.name for parameter, free in parameters if free),
            *(("latency",) if self.latency_is_free else ()),
            *(("gyro_latency",) if self.has_gyroscope else ()),
        )

    def at(self, values: FloatArray) -> Base:
        """The base with other free numbers (F,)."""
        base, count = self.base, len(self._places)
        parameters = base.values.copy()
        parameters[self._places] = values[:count]
        latency_s = float(values[count]) if self.latency_is_free else base.latency_s
        own_s = float(values[-1]) if self.has_gyroscope else base.gyro_latency_s
        return Base(base.model, parameters, base.robot, latency_s, own_s)

    @cached_property
    def _places(self) -> IntArray:
        return np.flatnonzero(self.free)

    @property
    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Least and largest (F,)."""
        searched = [p.search or (p.low, p.high) for p in self.base.model.parameters]
        late = (-LONGEST_LATENCY_S, LONGEST_LATENCY_S)
        ends = [s for s, free in zip(searched, self.free, strict=True) if free]
        ends += [late] if self.latency_is_free else []
        ends += [late] if self.has_gyroscope else []
        low, high = np.array(ends, dtype=np.float64).reshape(-1, 2).T
        return np.asarray(low), np.asarray(high)

    @property
    def scales(self) -> FloatArray:
        """Small changes (F,) that matter."""
        latency = [LATENCY_SCALE_S] if self.latency_is_free else []
        own = [LATENCY_SCALE_S] if self.has_gyroscope else []
        return np.concatenate([np.full(int(self.free.sum()), PARAMETER_SCALE), latency, own])


def believed_model(
    name: str, runs: Sequence[Run], terrain: str | None = None
) -> tuple[KinematicModel, Mapping[str, float] | None]:
    """A model of the catalogue, and its parameters where `name` is a file of them.

    Of a set with several terrains, that of `terrain`, else that which the runs name.

    Raises
    ------
    GapError
        If the set has no such terrain, effects already, or is of another robot.
    ParameterError
        If there is no such model, or the file is no parameter set.
    """
    if Path(name).suffix != ".toml":
        return model_named(name), None
    parameters = read_parameters(name)
    terrains = parameters.terrains
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
    other = [other_width(replace(parameters, terrains={wanted: table}), r.robot) for r in runs]
    if any(other):
        raise GapError(f"{name}: {max(other)}. Identify the model on the calibration runs")
    if table.model not in MODELS:
        raise ParameterError(f"{name}: the model {table.model!r} cannot be computed")
    return MODELS[table.model], table.values
