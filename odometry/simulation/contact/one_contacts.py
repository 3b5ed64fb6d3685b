"""Forces of the contacts of one vehicle in plain numbers: `ContactDynamics.contacts` of one row.

NumPy takes as long for eight contacts as for a thousand; a loop over eight is several times faster.
"""

from collections.abc import Callable, Sequence
from math import expm1, sqrt
from typing import NamedTuple

from odometry.arrays import ComplexArray, FloatArray
from odometry.simulation.contact.friction import Coulomb, Shear

Memory = Sequence[complex]


class Sums(NamedTuple):
    """Sums over all contacts.

    Attributes
    ----------
    force_n : complex
        On the vehicle, in the contact plane.
    moment_nm : float
        Of that force about the centre of mass.
    memory_rates_m_s : list of complex
        Of the friction law, for each contact with a memory.
    damping_kg_s, damping_arm_kg_m_s, damping_arm2_kg_m2_s : float, complex, float
        Damping of each contact by the powers of its arm: 1, r and |r|^2.
    """

    force_n: complex
    moment_nm: float
    memory_rates_m_s: Memory
    damping_kg_s: float
    damping_arm_kg_m_s: complex
    damping_arm2_kg_m2_s: float


class Contact(NamedTuple):
    """What is constant of one contact: arm, friction, and distance from entry by direction."""

    arm_m: complex
    friction: float
    ahead_entry_m: float
    back_entry_m: float


Forces = Callable[[complex, float, Sequence[float], Sequence[float], Memory], Sums]
"""From the velocity of the centre of mass, yaw rate, tread speeds, loads and memory."""


def forces_of(law: object, contacts: Sequence[Contact], lateral: float) -> Forces | None:
    """Function of the contacts' forces under a law of friction; None for a law of somebody else.

    Parameters
    ----------
    law : FrictionLaw
    contacts : sequence of Contact
        Left side first, as many on each side.
    lateral : float
        Share of the traction sideways.
    """
    if type(law) is Coulomb:
        return _coulomb(law, contacts, lateral)
    if type(law) is Shear:
        return _shear(law, contacts, lateral)
    return None


def _coulomb(law: Coulomb, contacts: Sequence[Contact], lateral: float) -> Forces:
    half, eps2 = len(contacts) // 2, law.rounding_m_s**2
    rows = [(c.friction, c.arm_m.real, c.arm_m.imag, abs(c.arm_m) ** 2) for c in contacts]
    lead = law.lead * max(1.0, lateral)

    def forces(
        velocity: complex,
        omega: float,
        treads: Sequence[float],
        loads: Sequence[float],
        memory: Memory,
    ) -> Sums:
        along = across = moment = damping = of_x = of_y = of_square = 0.0
        forward, left = velocity.real, velocity.imag
        for side, tread in enumerate(treads):
            here = slice(side * half, side * half + half)
            for (friction, x, y, square), load in zip(rows[here], loads[here], strict=True):
                slip_x, slip_y = forward - omega * y - tread, left + omega * x
                stiffness = friction * load / sqrt(slip_x * slip_x + slip_y * slip_y + eps2)
                push_x, push_y = stiffness * slip_x, lateral * (stiffness * slip_y)
                along -= push_x
                across -= push_y
                moment += y * push_x - x * push_y
                damping += stiffness
                of_x += stiffness * x
                of_y += stiffness * y
                of_square += stiffness * square
        of_arm = lead * complex(of_x, of_y)
        return Sums(
            complex(along, across), moment, memory, lead * damping, of_arm, lead * of_square
        )

    return forces


def _shear(law: Shear, contacts: Sequence[Contact], lateral: float) -> Forces:
    half, lead = len(contacts) // 2, law.lead_s * max(1.0, lateral)
    modulus, longest, ahead_s, tiny = (
        law.modulus_m,
        law.longest_m,
        law.lead_s,
        1e-12 * law.modulus_m,
    )

    def forces(
        velocity: complex,
        omega: float,
        treads: Sequence[float],
        loads: Sequence[float],
        memory: Memory,
    ) -> Sums:
        force = of_arm = 0j
        turning = 1j * omega
        moment = damping = of_square = 0.0
        rates = []
        for at, (contact, load, sheared) in enumerate(zip(contacts, loads, memory, strict=True)):
            arm, friction, ahead_m, back_m = contact
            tread = treads[at >= half]
            slip = velocity + turning * arm - tread
            renewal = abs(tread) / (ahead_m if tread > 0 else back_m)
            rate = slip - (renewal + abs(slip) / longest) * sheared
            rates.append(rate)
            led = sheared + ahead_s * rate
            size = abs(led) + tiny
            stiffness = friction * load * -expm1(-size / modulus) / size
            push = complex(stiffness * led.real, lateral * (stiffness * led.imag))
            force -= push
            moment += arm.imag * push.real - arm.real * push.imag
            damping += stiffness
            of_arm += stiffness * arm
            of_square += stiffness * (arm.real * arm.real + arm.imag * arm.imag)
        return Sums(force, moment, rates, lead * damping, lead * of_arm, lead * of_square)

    return forces


def contacts_of(arms_m: ComplexArray, friction: FloatArray, entry_m: FloatArray) -> list[Contact]:
    """Plain numbers of arms (n,), friction (n,) and distances from entry (2, n), ahead and back."""
    return [
        Contact(*row)
        for row in zip(arms_m.tolist(), friction.tolist(), *entry_m.tolist(), strict=True)
    ]
