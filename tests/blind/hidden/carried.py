"""A reference that suffers from the robot that carries it: its currents, its attitude."""
# ruff: noqa: ARG001 - all have one face, and few need all of it

import numpy as np

from tests.blind.hidden.courses import sign
from tests.blind.hidden.kind import Hidden, Kind


def bent_by_current(rng, scene):
    """The yaw is bent by the motors' current, which goes with the turn and with its change."""
    per_turn_s = sign(rng) * rng.uniform(0.02, 0.1)
    per_change_s2 = sign(rng) * rng.uniform(0.02, 0.1)

    def hide(rng, clock):
        def reference(times_s, poses):
            rate = np.gradient(poses[:, 2], times_s)
            bent = per_turn_s * rate + per_change_s2 * np.gradient(rate, times_s)
            return times_s, poses + bent[:, None] * np.array([0.0, 0.0, 1.0])

        truth = {"per_turn_s": per_turn_s, "per_change_s2": per_change_s2}
        return Hidden(truth, reference=reference)

    return hide


def leaning_antenna(rng, scene):
    """An antenna 0.8 to 3 m above the robot, whose place is not corrected for roll and pitch."""
    height_m = rng.uniform(0.8, 3.0)

    def hide(rng, clock):
        leans = np.zeros((len(clock.times_s), 2))

        def at_place(row, pose, twist):
            roll, pitch = pose[3:]
            leans[row] = np.cos(roll) * np.sin(pitch), -np.sin(roll)
            return twist

        def reference(times_s, poses):
            ahead, left = (np.interp(times_s, clock.times_s, of) for of in leans.T)
            off = height_m * (ahead + 1j * left) * np.exp(1j * poses[:, 2])
            return times_s, poses + np.column_stack([off.real, off.imag, np.zeros(len(poses))])

        return Hidden({"height_m": height_m}, at_place=at_place, reference=reference)

    return hide


CARRIED = {
    "bent_by_current": Kind(bent_by_current),
    "leaning_antenna": Kind(leaning_antenna, sloped=True),
}
