"""Ground that slopes: planes, planes joined by smooth creases, and a held attitude.

REP-103 (data/README.md): orientation Rz(yaw) Ry(pitch) Rx(roll), roll > 0 right side down,
pitch > 0 nose down.
"""

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from odometry.arrays import ComplexArray, FloatArray
from odometry.simulation.contact.friction import GRAVITY_M_S2, dot


class Tilt(NamedTuple):
    """Sines and cosines of roll and pitch, each (B,)."""

    sin_roll: FloatArray
    cos_roll: FloatArray
    sin_pitch: FloatArray
    cos_pitch: FloatArray


def tilt(rise: ComplexArray) -> Tilt:
    """Attitude of a body flat on ground that rises by `rise` per metre, forward + i left.

    The body's x and y axes lie in the ground: tan(pitch) = -forward and
    sin(roll) = left / sqrt(1 + forward^2 + left^2), as the third row of the rotation says.
    """
    stretch = np.sqrt(1 + rise.real**2)
    length = np.sqrt(stretch**2 + rise.imag**2)
    return Tilt(rise.imag / length, stretch / length, -rise.real / stretch, 1 / stretch)


def gravity(attitude: Tilt) -> tuple[ComplexArray, FloatArray]:
    """Gravity in the body's plane, and into it [m/s2]: Rx(-roll) Ry(-pitch) (0, 0, -g)."""
    sin_roll, cos_roll, sin_pitch, cos_pitch = attitude
    along = GRAVITY_M_S2 * (sin_pitch - 1j * cos_pitch * sin_roll)
    return np.asarray(along), np.asarray(GRAVITY_M_S2 * cos_pitch * cos_roll)


class Ground(Protocol):
    """What the vehicle stands on; world points are complex, x + i y."""

    def rise(self, points: ComplexArray, heading: ComplexArray) -> ComplexArray:
        """Rise per metre (B,), along the heading (a unit vector) + i to its left."""

    def rise_rate(self, points: ComplexArray, velocity: ComplexArray) -> ComplexArray:
        """Rate of the gradient (B,) [1/s], x + i y in the world, at a velocity over ground."""

    def heights_m(self, points: ComplexArray) -> FloatArray:
        """World z."""


@dataclass(frozen=True)
class Plane:
    """A plane through the origin.

    Attributes
    ----------
    slope_rad : float
        Steepest slope.
    uphill_rad : float
        World direction in which it rises.
    """

    slope_rad: float = 0.0
    uphill_rad: float = 0.0

    @property
    def gradient(self) -> complex:
        """Rise per metre, x + i y in the world."""
        return complex(np.tan(self.slope_rad) * np.exp(1j * self.uphill_rad))

    def rise(self, points: ComplexArray, heading: ComplexArray) -> ComplexArray:  # noqa: ARG002
        """See `Ground`."""
        return self.gradient * heading.conj()

    def rise_rate(self, points: ComplexArray, velocity: ComplexArray) -> ComplexArray:  # noqa: ARG002
        """Nothing: the gradient is the same everywhere."""
        return np.zeros_like(points)

    def heights_m(self, points: ComplexArray) -> FloatArray:
        """See `Ground`."""
        return dot(self.gradient, points)


@dataclass(frozen=True)
class Zones:
    """Planes of different slope one after another uphill, joined by smooth creases.

    Attributes
    ----------
    slopes_rad : (k,) tuple
        Slope of each zone; the first reaches back and the last one ahead without end.
    edges_m : (k - 1,) tuple
        Where a zone ends, along the uphill direction from the origin, increasing.
    uphill_rad : float
        World direction in which the zones follow each other.
    crease_m : float
        Half the width over which the slope changes by 76 %.
    """

    slopes_rad: tuple[float, ...]
    edges_m: tuple[float, ...]
    uphill_rad: float = 0.0
    crease_m: float = 0.5

    def __post_init__(self) -> None:
        edges = np.array(self.edges_m)
        if len(edges) != len(self.slopes_rad) - 1 or (np.diff(edges) <= 0).any():
            raise ValueError(
                f"{len(self.slopes_rad)} zones need {len(self.slopes_rad) - 1} increasing edges, "
                f"found {edges.tolist()}"
            )

    def rise(self, points: ComplexArray, heading: ComplexArray) -> ComplexArray:
        """See `Ground`."""
        slopes = np.tan(self.slopes_rad)
        share = 0.5 + 0.5 * np.tanh(self._from_edges(points))
        along = slopes[0] + share @ np.diff(slopes)
        return np.asarray(along * self.uphill * heading.conj())

    def rise_rate(self, points: ComplexArray, velocity: ComplexArray) -> ComplexArray:
        """See `Ground`."""
        bend = 0.5 / self.crease_m * (1 - np.tanh(self._from_edges(points)) ** 2)
        climbing = dot(self.uphill, velocity)
        return np.asarray(bend @ np.diff(np.tan(self.slopes_rad)) * climbing * self.uphill)

    def heights_m(self, points: ComplexArray) -> FloatArray:
        """See `Ground`; the integral of the slope from far behind, up to a constant."""
        slopes = np.tan(self.slopes_rad)
        risen = 0.5 * self.crease_m * np.logaddexp(0.0, 2 * self._from_edges(points))
        return np.asarray(slopes[0] * dot(self.uphill, points) + risen @ np.diff(slopes))

    @property
    def uphill(self) -> complex:
        """Unit vector, x + i y in the world."""
        return complex(np.exp(1j * self.uphill_rad))

    def _from_edges(self, points: ComplexArray) -> FloatArray:
        along = dot(self.uphill, points)[..., None]
        return np.asarray((along - np.array(self.edges_m)) / self.crease_m)


@dataclass(frozen=True, eq=False)
class HeldAttitude:
    """Ground that turns with the vehicle, so that roll and pitch stay: for steady states.

    Attributes
    ----------
    roll_rad, pitch_rad : (B,) arrays
    """

    roll_rad: FloatArray
    pitch_rad: FloatArray

    def rise(self, points: ComplexArray, heading: ComplexArray) -> ComplexArray:  # noqa: ARG002
        """See `Ground`."""
        left = np.tan(self.roll_rad) / np.cos(self.pitch_rad)
        return np.asarray(-np.tan(self.pitch_rad) + 1j * left)

    def rise_rate(self, points: ComplexArray, velocity: ComplexArray) -> ComplexArray:  # noqa: ARG002
        """Nothing."""
        return np.zeros_like(points)

    def heights_m(self, points: ComplexArray) -> FloatArray:
        """Nothing: such ground has no height."""
        return np.zeros(points.shape)
