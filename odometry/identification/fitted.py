"""The result of fitting one model to windows, and which parameters the windows do not determine."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from scipy.special import stdtrit

from odometry.arrays import FloatArray
from odometry.models.base import KinematicModel
from odometry.windows.stretches.stretch_noise import StretchNoise
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.windows import Windows

SHOWN = 0.3  # a parameter is named if it has this share of a direction


@dataclass(frozen=True)
class Undetermined:
    """A combination of parameters that the windows do not determine.

    Attributes
    ----------
    direction : Mapping of name to share
        Of each parameter in units of its ordinary size; the squares of all add up to 1.
    deviation : float
        Standard deviation along it, in those units; infinite where nothing depends on it.
    """

    direction: dict[str, float]
    deviation: float

    def words(self) -> str:
        """The combination and its deviation in a sentence."""
        terms = [f"{share:+.2f} {name}" for name, share in self.direction.items()]
        subject = " ".join(terms) if len(terms) > 1 else next(iter(self.direction))
        if not np.isfinite(self.deviation):
            return f"{subject}: the predicted motion does not depend on it"
        return f"{subject}: standard deviation {self.deviation:.2g} of its ordinary size"


def undetermined(
    whitened_jacobian: FloatArray,
    names: tuple[str, ...],
    sizes: FloatArray,
    scale: float,
    largest: float,
) -> tuple[Undetermined, ...]:
    """Directions along which the standard deviation is above `largest` ordinary sizes.

    Parameters
    ----------
    whitened_jacobian : (3K, F)
        Residuals of unit variance by the free parameters.
    names : F of str
    sizes : (F,)
    scale : float
        How many times larger the residuals are than stated.
    largest : float
    """
    if not names:
        return ()
    _, singular, directions = np.linalg.svd(whitened_jacobian * sizes, full_matrices=False)
    found = []
    for value, direction in zip(singular, directions, strict=True):
        nothing = value <= 1e-9 * max(singular[0], 1.0)
        deviation = np.inf if nothing else scale / value
        if deviation > largest:
            signed = direction * np.sign(direction[np.argmax(np.abs(direction))])
            shares = {n: float(s) for n, s in zip(names, signed, strict=True) if abs(s) >= SHOWN}
            found.append(Undetermined(shares, float(deviation)))
    return tuple(found)


LEVEL = 0.95
NORMAL = 1.96  # standard deviations of a normal distribution on each side at that level


@dataclass(frozen=True)
class Interval:
    """A 95 % interval of a parameter.

    Attributes
    ----------
    low, high : float
    freedom : float
        Degrees of freedom of the variance behind it; with few, Student's t makes it wide.
    """

    low: float
    high: float
    freedom: float


def deviations_within(freedom: FloatArray) -> FloatArray:
    """Standard deviations on each side of a 95 % interval by Student's t."""
    return np.asarray(stdtrit(freedom, (1 + LEVEL) / 2))


LEAST_POSITION_M = 0.02  # of positions, with which residuals are compared: SLAM's are smoother


@dataclass(frozen=True)
class Fit:
    """Parameters of one model on one terrain.

    Attributes
    ----------
    model : KinematicModel
    values : Mapping of name to float
        Every parameter of the model.
    names : tuple of str
        Those that were identified and have a variance.
    covariance : (F, F)
        Of `names`.
    freedom : (F,)
        Degrees of freedom of the variances in it.
    undetermined : tuple of Undetermined
        What the windows do not determine.
    by_trial : tuple of str
        Identified by trying values, because they act through a sign alone: no variance.
    at_bound : tuple of str
        Parameters that ended at a bound of the search.
    residuals : (K, 3)
        Predicted less measured motion: along, across [m], yaw [rad]; of stretches (K, R), see
        `shape_residuals`.
    weights : (K,)
        1 where a window counts in full, less where it is an outlier.
    scale : float
        How many times larger the residuals are than the poses' stated noise explains.
    agreeing, starts : int
        How many of the starts found this minimum.
    windows : Windows or Stretches
    start : Mapping of name to float
        Where the first search started.
    profiled : Mapping of name to Interval
        Intervals that were found by profiling (`profile.with_profiles`); others are symmetric.
    noise : StretchNoise or None
        What the residuals of positions show; None of poses, whose noise is stated.
    """

    model: KinematicModel
    values: Mapping[str, float]
    names: tuple[str, ...]
    covariance: FloatArray
    freedom: FloatArray
    undetermined: tuple[Undetermined, ...]
    by_trial: tuple[str, ...]
    at_bound: tuple[str, ...]
    residuals: FloatArray
    weights: FloatArray
    scale: float
    agreeing: int
    starts: int
    windows: Windows | Stretches
    start: Mapping[str, float]
    profiled: Mapping[str, Interval] = field(default_factory=dict)
    noise: StretchNoise | None = None

    @property
    def noun(self) -> str:
        """What the rows of residuals belong to."""
        return "windows" if self.noise is None else "stretches"

    @property
    def compared_with(self) -> str:
        """The noise that `scale` is a multiple of."""
        if self.noise is None:
            return "the poses' stated noise"
        found_m = self.noise.position_m
        if found_m < LEAST_POSITION_M:
            return f"{LEAST_POSITION_M:g} m (the noise found of positions is less)"
        return f"the noise found of positions ({found_m:.2g} m)"

    @property
    def open_names(self) -> frozenset[str]:
        """Parameters of the combinations that are undetermined: their sigmas mean nothing."""
        return frozenset(name for open_ in self.undetermined for name in open_.direction)

    @property
    def packed(self) -> FloatArray:
        """Parameters (P,) in the order of the model."""
        return np.array([self.values[parameter.name] for parameter in self.model.parameters])

    @property
    def sigmas(self) -> dict[str, float]:
        """Standard deviation of each identified parameter."""
        deviations = np.sqrt(np.diag(self.covariance))
        return {name: float(value) for name, value in zip(self.names, deviations, strict=True)}

    @property
    def intervals(self) -> dict[str, Interval]:
        """95 % interval of each identified parameter: profiled, else by Student's t."""
        halves = np.sqrt(np.diag(self.covariance)) * deviations_within(self.freedom)
        return {
            name: self.profiled.get(
                name, Interval(self.values[name] - half, self.values[name] + half, freedom)
            )
            for name, half, freedom in zip(
                self.names, halves.tolist(), self.freedom.tolist(), strict=True
            )
        }

    @property
    def normal_covariance(self) -> FloatArray:
        """Covariance (F, F) of the normal distribution that has these intervals.

        For programs that take parameters as normally distributed: filters, readers of a set.
        """
        growth = np.maximum(deviations_within(self.freedom) / NORMAL, 1.0)
        return np.asarray(growth[:, None] * self.covariance * growth)
