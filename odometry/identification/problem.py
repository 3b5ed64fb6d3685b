"""The loss of an identification: squared Mahalanobis distances of windows (Baril 2020 eq. 13)."""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.models.base import KinematicModel
from odometry.windows.stretches.stretch_motion import linearised_shape_residuals, shape_residuals
from odometry.windows.stretches.stretch_noise import covariance_parts, known_covariance, whitening
from odometry.windows.stretches.stretches import Stretches
from odometry.windows.travel.motion import linearised_window_motion, window_motion
from odometry.windows.travel.noise import window_covariances
from odometry.windows.travel.windows import Windows

REMEMBERED = 2  # a search evaluates its last point again, or the one before


@dataclass(frozen=True)
class AnyProblem(ABC):
    """Which parameters of a model are free, and the windows that determine them.

    Attributes
    ----------
    model : KinematicModel
    windows : Windows or Stretches
    values : (P,)
        All parameters; the free ones are ignored.
    free : (P,) of bool
    variances : (V,)
        Of the noise that is supposed.
    """

    model: KinematicModel
    windows: Windows | Stretches
    values: FloatArray
    free: BoolArray
    variances: FloatArray

    @property
    def names(self) -> tuple[str, ...]:
        """The free parameters."""
        return tuple(
            parameter.name
            for parameter, free in zip(self.model.parameters, self.free, strict=True)
            if free
        )

    def complete(self, chosen: FloatArray) -> FloatArray:
        """All parameters (P,) with the free ones (F,) put in."""
        values = self.values.copy()
        values[self.free] = chosen
        return values

    def bounds(self) -> tuple[FloatArray, FloatArray]:
        """Lowest and highest values (F,) within which the free parameters are searched."""
        ranges = [p.search or (p.low, p.high) for p in self.model.parameters]
        low, high = np.array(ranges)[self.free].reshape(-1, 2).T
        return low, high

    @property
    def whitening(self) -> FloatArray:
        """Factors (K, R, R) by which residuals enter the loss: those of the supposed noise."""
        return self.noise_whitening

    @property
    @abstractmethod
    def numbers_per_window(self) -> int:
        """Measured numbers of a window: the freedom of its squared Mahalanobis distance."""

    @cached_property
    @abstractmethod
    def noise_whitening(self) -> FloatArray:
        """Factors (K, R, R) by which residuals of the supposed noise become white."""

    def residuals(self, chosen: FloatArray) -> FloatArray:
        """Predicted less measured numbers (K, R); turns count in full."""
        if chosen.tobytes() in self._recent:
            return self._recent[chosen.tobytes()][0]
        return self._residuals(chosen)

    def jacobian(self, chosen: FloatArray) -> FloatArray:
        """Derivative (K, R, F) of the residuals by the free parameters."""
        return self.linearised(chosen)[1]

    def linearised(self, chosen: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Both at once; of the last points the answers are remembered."""
        key = chosen.tobytes()
        if key not in self._recent:
            while len(self._recent) >= REMEMBERED:
                self._recent.pop(next(iter(self._recent)))
            found = self._linearised(chosen)
            for array in found:
                array.setflags(write=False)  # it will be handed out again
            self._recent[key] = found
        return self._recent[key]

    @cached_property
    def _recent(self) -> dict[bytes, tuple[FloatArray, FloatArray]]:
        return {}

    @abstractmethod
    def _residuals(self, chosen: FloatArray) -> FloatArray: ...

    @abstractmethod
    def _linearised(self, chosen: FloatArray) -> tuple[FloatArray, FloatArray]: ...


@dataclass(frozen=True)
class Problem(AnyProblem):
    """Of windows between poses; `variances` (3,) are those of a measured pose."""

    windows: Windows

    @property
    def numbers_per_window(self) -> int:
        """See `AnyProblem.numbers_per_window`."""
        return 3

    @cached_property
    def noise_whitening(self) -> FloatArray:
        """Inverse Cholesky factors (K, 3, 3) of the windows' stated covariances."""
        covariances = window_covariances(self.windows, self.variances)
        return np.asarray(np.linalg.inv(np.linalg.cholesky(covariances)))

    def _residuals(self, chosen: FloatArray) -> FloatArray:
        predicted = window_motion(self.model, self.complete(chosen), self.windows)
        return np.asarray(predicted - self.windows.measured)

    def _linearised(self, chosen: FloatArray) -> tuple[FloatArray, FloatArray]:
        predicted, by_parameters = linearised_window_motion(
            self.model, self.complete(chosen), self.windows
        )
        return predicted - self.windows.measured, by_parameters[:, :, self.free]


class PaperProblem(Problem):
    """Baril 2020 eq. 13 with the covariance of the paper: the identity, in metres and radians."""

    @property
    def whitening(self) -> FloatArray:
        """See `AnyProblem.whitening`."""
        return np.broadcast_to(np.eye(3), (len(self.windows), 3, 3))


PROBLEMS: dict[str, type[Problem]] = {
    "huber": Problem,
    "squares": Problem,
    "linear": PaperProblem,
}


@dataclass(frozen=True)
class StretchProblem(AnyProblem):
    """As `Problem`, of K stretches with n ways each; `variances` are those of `StretchNoise`."""

    windows: Stretches

    @property
    def numbers_per_window(self) -> int:
        """See `AnyProblem.numbers_per_window`: the direction of a stretch takes one."""
        of = self.windows
        return (2 if of.turns_rad is None else 3) * of.steps - 1

    @cached_property
    def noise_whitening(self) -> FloatArray:
        """Matrices (K, R, R) of `stretch_noise.whitening`."""
        of = self.windows
        return whitening(of, self.variances, covariance_parts(of), known_covariance(of))

    def _residuals(self, chosen: FloatArray) -> FloatArray:
        return shape_residuals(self.model, self.complete(chosen), self.windows)

    def _linearised(self, chosen: FloatArray) -> tuple[FloatArray, FloatArray]:
        found, by_values = linearised_shape_residuals(
            self.model, self.complete(chosen), self.windows
        )
        return found, by_values[..., self.free]
