"""Normal loads under a rigid body that stands on equal vertical springs."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import SimulationError
from odometry.simulation.contact.vectors import ComplexArray

MOST_CHANGES = 50


class NormalLoads:
    """Loads of n contacts at fixed places, from the weight and its moment.

    A rigid body sinks by the same plane a + b . r everywhere, so that N_i = max(0, a + b . r_i):
    a contact carries or lifts off, it never pulls. a and b follow from the balance of force and
    moments.

    Parameters
    ----------
    places_m : (n,) complex array
        Contacts in the contact plane, not all on a line.

    Attributes
    ----------
    of_balance : list of (float, float, float)
        For each contact: load by the weight and by both parts of its moment, where none lifts off.
    """

    def __init__(self, places_m: ComplexArray) -> None:
        self.places_m = places_m
        self._shape = np.stack([np.ones(len(places_m)), places_m.real, places_m.imag])
        self._linear = np.linalg.pinv(self._shape).T
        self.of_balance = [tuple(column) for column in self._linear.T.tolist()]

    def __call__(self, weight_n: FloatArray, moment_nm: ComplexArray) -> FloatArray:
        """Loads (B, n) [N].

        Parameters
        ----------
        weight_n : (B,) array
            Sum of the loads.
        moment_nm : (B,) complex array
            Sum of load times place: weight times the point on which it acts.

        Raises
        ------
        SimulationError
            If that point is outside of the contacts: the vehicle tips over.
        """
        balance = np.stack([weight_n, moment_nm.real, moment_nm.imag], axis=-1)
        loads = balance @ self._linear
        lifted = loads.min(axis=-1) < 0
        if lifted.any():
            loads[lifted] = self._with_lift_off(balance[lifted])
        return np.asarray(loads)

    def _with_lift_off(self, balance: FloatArray) -> FloatArray:
        """Change the set of carrying contacts until it is that of the positive loads."""
        carrying = np.ones((len(balance), self._shape.shape[1]), dtype=bool)
        for _ in range(MOST_CHANGES):
            stiffness = np.einsum("kn,bn,ln->bkl", self._shape, carrying, self._shape)
            try:
                plane = np.linalg.solve(stiffness, balance[..., None])[..., 0]
            except np.linalg.LinAlgError:
                break
            sunk = plane @ self._shape
            if ((sunk > 0) == carrying).all():
                return np.asarray(np.where(carrying, sunk, 0.0))
            carrying = sunk > 0
        points = balance[:, 1:] / balance[:, :1]
        raise SimulationError(
            "the vehicle tips over: its weight acts outside of its contacts, at one of (x, y) = "
            f"{np.round(points, 3).tolist()[:4]} m"
        )
