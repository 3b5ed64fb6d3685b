"""Models, members and small banks that the tests of mode estimation share."""

from dataclasses import dataclass

import numpy as np

from odometry.estimation.imm.ekf_bank import EkfModel
from odometry.estimation.imm.estimator import Imm, Members
from odometry.estimation.imm.mode_belief import ModeBelief
from tests.odometry.estimation.imm.ekf_member import EkfMember

NOTHING = np.zeros(0)
EVEN = [[0.9, 0.1], [0.1, 0.9]]
LEANING = [[0.9, 0.1], [0.4, 0.6]]

POSE_NOISE = np.diag([0.02, 0.02, 0.01]) ** 2


def moved(x, u, step_s, k, m):
    """Poses (..., 3) at speed k u[0], yaw rate m u[1]."""
    ahead = k * u[0] * step_s
    rate = np.broadcast_to(m * u[1] * step_s, x[..., 2].shape)
    return x + np.stack([ahead * np.cos(x[..., 2]), ahead * np.sin(x[..., 2]), rate], axis=-1)


def moved_jacobian(x, u, step_s, k):
    F = np.tile(np.eye(3), (*x.shape[:-1], 1, 1))
    F[..., 0, 2] = -k * u[0] * np.sin(x[..., 2]) * step_s
    F[..., 1, 2] = k * u[0] * np.cos(x[..., 2]) * step_s
    return F


def pose_model(k, m, R=POSE_NOISE):
    """Of one mode, of numbers k and m, or of all, of arrays (M,): k and m times the speeds."""
    return EkfModel(
        states=3,
        transition=lambda x, u, step_s: moved(x, u, step_s, k, m),
        transition_jacobian=lambda x, u, step_s: moved_jacobian(x, u, step_s, k),
        process_noise=lambda _x, _u, step_s: np.diag([4e-4, 4e-4, 1e-4]) * step_s,
        measurement=lambda x: x,
        measurement_jacobian=lambda x: np.broadcast_to(np.eye(3), (*x.shape[:-1], 3, 3)),
        measurement_covariance=R,
        state_angles=(2,),
        measurement_angles=(2,),
    )


def speed_model(rate):
    """A scalar whose rate of change is known, measured directly."""
    return EkfModel(
        states=1,
        transition=lambda x, _u, step_s: x + rate * step_s,
        transition_jacobian=lambda *_: np.eye(1),
        process_noise=lambda _x, _u, step_s: np.full((1, 1), 0.01 * step_s),
        measurement=lambda x: x,
        measurement_jacobian=lambda _: np.eye(1),
        measurement_covariance=np.full((1, 1), 0.01),
    )


def two_rates(transition, **settings):
    """Modes that fall and rise at 1 a second; a belief at 0, even odds."""
    bank = Members(tuple(EkfMember(speed_model(rate)) for rate in (-1.0, 1.0)))
    imm = Imm(bank, lambda _: np.array(transition), **settings)
    return imm, ModeBelief.alike(np.zeros(1), 0.01 * np.eye(1), np.array([0.5, 0.5]))


@dataclass(frozen=True)
class Saying:
    """A member that stays where it is and answers one log-likelihood."""

    log_likelihood: float

    def predicted(self, mean, covariance, _u, _step_s):
        return mean, covariance

    def updated(self, mean, covariance, _z):
        return mean, covariance, self.log_likelihood, 0.0
