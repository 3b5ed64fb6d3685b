"""The loss of an identification from positions: shapes of stretches, wherever they point."""

from dataclasses import dataclass
from functools import cached_property

from odometry.arrays import FloatArray
from odometry.identification.problem import AnyProblem
from odometry.windows.stretch_motion import linearised_shape_residuals, shape_residuals
from odometry.windows.stretch_noise import covariance_parts, known_covariance, whitening
from odometry.windows.stretches import Stretches


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
