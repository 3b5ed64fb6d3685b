"""The loss of an identification: squared Mahalanobis distances of windows (Baril 2020 eq. 13)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.models.base import KinematicModel
from odometry.windows.motion import linearised_window_motion, window_motion
from odometry.windows.noise import window_covariances
from odometry.windows.windows import Windows

REMEMBERED = 2  # a search asks again at its last point, or the one before


@dataclass(frozen=True)
class Problem:
    """Which parameters of a model are free, and the windows that shall tell them.

    Attributes
    ----------
    model : KinematicModel
    windows : Windows
    values : (P,)
        All parameters; the free ones are ignored.
    free : (P,) of bool
    variances : (3,)
        Of a measured pose.
    """

    model: KinematicModel
    windows: Windows
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
        """Where to search the free parameters."""
        ranges = [p.search or (p.low, p.high) for p in self.model.parameters]
        low, high = np.array(ranges)[self.free].reshape(-1, 2).T
        return low, high

    @property
    def whitening(self) -> FloatArray:
        """Factors (K, 3, 3) by which residuals enter the loss: those of the stated noise."""
        return self.noise_whitening

    @cached_property
    def noise_whitening(self) -> FloatArray:
        """Inverse Cholesky factors (K, 3, 3) of the windows' stated covariances."""
        covariances = window_covariances(self.windows, self.variances)
        return np.asarray(np.linalg.inv(np.linalg.cholesky(covariances)))

    def residuals(self, chosen: FloatArray) -> FloatArray:
        """Predicted less measured motion (K, 3); turns count in full."""
        if chosen.tobytes() in self._recent:
            return self._recent[chosen.tobytes()][0]
        predicted = window_motion(self.model, self.complete(chosen), self.windows)
        return np.asarray(predicted - self.windows.measured)

    def jacobian(self, chosen: FloatArray) -> FloatArray:
        """Derivative (K, 3, F) of the residuals by the free parameters."""
        return self.linearised(chosen)[1]

    def linearised(self, chosen: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Both at once; of the last points the answers are remembered."""
        key = chosen.tobytes()
        if key not in self._recent:
            while len(self._recent) >= REMEMBERED:
                self._recent.pop(next(iter(self._recent)))
            self._recent[key] = self._linearised(chosen)
        return self._recent[key]

    @cached_property
    def _recent(self) -> dict[bytes, tuple[FloatArray, FloatArray]]:
        return {}

    def _linearised(self, chosen: FloatArray) -> tuple[FloatArray, FloatArray]:
        predicted, by_parameters = linearised_window_motion(
            self.model, self.complete(chosen), self.windows
        )
        found = predicted - self.windows.measured, by_parameters[:, :, self.free]
        for array in found:
            array.setflags(write=False)  # it will be handed out again
        return found


class PaperProblem(Problem):
    """Baril 2020 eq. 13 with the covariance of the paper: the identity, in metres and radians."""

    @property
    def whitening(self) -> FloatArray:
        """See `Problem.whitening`."""
        return np.broadcast_to(np.eye(3), (len(self.windows), 3, 3))


PROBLEMS: dict[str, type[Problem]] = {
    "huber": Problem,
    "squares": Problem,
    "linear": PaperProblem,
}
