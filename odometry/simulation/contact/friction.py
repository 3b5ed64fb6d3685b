"""Friction of one contact: traction per unit of friction limit, from slip and its history."""

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from odometry.arrays import ComplexArray, FloatArray

GRAVITY_M_S2 = 9.80665


def dot(first: Any, second: Any) -> FloatArray:
    """Scalar product of plane vectors, elementwise."""
    return np.asarray((np.conj(first) * second).real)


def cross(first: Any, second: Any) -> FloatArray:
    """Vertical component of the vector product of plane vectors, elementwise."""
    return np.asarray((np.conj(first) * second).imag)


class FrictionLaw(Protocol):
    """Isotropic friction of a tread on the ground; arrays are (..., n), one column a contact."""

    @property
    def states_per_contact(self) -> int:
        """How many plane vectors of memory a contact has: 0 or 1."""

    def displacement_rate(
        self, slip_m_s: ComplexArray, displacement_m: ComplexArray, renewal_hz: FloatArray
    ) -> ComplexArray:
        """Rate of the memory [m/s].

        `slip_m_s` is the velocity of the tread's surface over the ground; `renewal_hz` is how
        often the contact gets new tread.
        """

    def yielding(
        self, slip_m_s: ComplexArray, displacement_m: ComplexArray, rate_m_s: ComplexArray
    ) -> tuple[ComplexArray, FloatArray]:
        """What the traction opposes, and the factor to it.

        The traction is the product of both, reversed, times the friction limit. The vector's
        derivative by the slip is `lead` times the unit matrix, to leading order.
        """

    @property
    def lead(self) -> float:
        """Derivative of the vector of `yielding` by the slip."""


@dataclass(frozen=True)
class Coulomb:
    """Coulomb friction, rounded off below a small slip speed.

    traction = - mu N s / sqrt(|s|^2 + eps^2), the usual regularisation of sign(s).

    Attributes
    ----------
    rounding_m_s : float
        eps. A vehicle that should stand creeps at eps times the share of friction it needs. The
        default step of the integration suits 0.003 m/s and more: at less than mu g times a
        twentieth of the step, sticking contacts chatter.
    """

    rounding_m_s: float = 0.005

    states_per_contact = 0
    lead = 1.0

    def displacement_rate(
        self,
        slip_m_s: ComplexArray,  # noqa: ARG002 - no memory
        displacement_m: ComplexArray,
        renewal_hz: FloatArray,  # noqa: ARG002
    ) -> ComplexArray:
        """Nothing: `displacement_m` is empty."""
        return displacement_m

    def yielding(
        self,
        slip_m_s: ComplexArray,
        displacement_m: ComplexArray,  # noqa: ARG002 - no memory
        rate_m_s: ComplexArray,  # noqa: ARG002
    ) -> tuple[ComplexArray, FloatArray]:
        """The slip, and 1 / sqrt(|s|^2 + eps^2)."""
        squared = slip_m_s.real**2 + slip_m_s.imag**2
        return slip_m_s, 1.0 / np.sqrt(squared + self.rounding_m_s**2)


@dataclass(frozen=True)
class Shear:
    """Shear of tread and ground (Janosi and Hanamoto; Wong and Chiang 2001) with a memory.

    tau = mu p (1 - exp(-j / K)) against the shear displacement j of the tread over the ground.
    Wong and Chiang integrate the slip s over the time since an element of the tread entered the
    contact. Here that is the steady state of a bristle (as in Dahl's and LuGre's models), so that
    transients work too:

        dj/dt = s - (renewal + |s| / J) j,        renewal = |tread speed| / distance from entry

    For small slip j tends to s times the time in contact; without renewal |j| grows to J, which
    is several K, where friction is full. The traction opposes d = j + lead dj/dt with the factor
    (1 - exp(-|d| / K)) / |d|: bounded by mu N, undisturbed in the steady state (dj/dt = 0), and
    damped in the elastic range like a mass on a spring of stiffness mu N / K.

    Attributes
    ----------
    modulus_m : float
        K, the shear deformation modulus [m].
    longest_m : float
        J, the shear displacement of full sliding [m].
    lead_s : float
        Time by which the traction leads j [s]; see `for_modulus`.
    """

    modulus_m: float
    longest_m: float
    lead_s: float

    states_per_contact = 1

    @classmethod
    def for_modulus(cls, modulus_m: float, friction: float, damping_ratio: float = 0.5) -> "Shear":
        """J = 5 K, and the damping ratio of a block on elastic bristles.

        A block of mass N / g on stiffness mu N / K swings at sqrt(mu g / K); the lead is
        2 ratio / frequency.
        """
        frequency = np.sqrt(friction * GRAVITY_M_S2 / modulus_m)
        return cls(modulus_m, 5 * modulus_m, float(2 * damping_ratio / frequency))

    @property
    def lead(self) -> float:
        """Derivative of d by the slip at no slip [s]."""
        return self.lead_s

    def displacement_rate(
        self, slip_m_s: ComplexArray, displacement_m: ComplexArray, renewal_hz: FloatArray
    ) -> ComplexArray:
        """dj/dt of the class's equation."""
        return slip_m_s - (renewal_hz + np.abs(slip_m_s) / self.longest_m) * displacement_m

    def yielding(
        self,
        slip_m_s: ComplexArray,  # noqa: ARG002 - in the rate
        displacement_m: ComplexArray,
        rate_m_s: ComplexArray,
    ) -> tuple[ComplexArray, FloatArray]:
        """The displacement d that leads j, and (1 - exp(-|d| / K)) / |d|."""
        led = displacement_m + self.lead_s * rate_m_s
        size = np.abs(led) + 1e-12 * self.modulus_m
        return led, -np.expm1(-size / self.modulus_m) / size
