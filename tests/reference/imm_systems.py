"""Random linear systems of several modes, for the references of the IMM."""

import math

import numpy as np

from odometry.estimation.imm.ekf_bank import EkfModel


def positive(rng, size):
    root = rng.normal(size=(size, size)) / math.sqrt(size)
    return root @ root.T + 0.2 * np.eye(size)


def linear_system(rng, modes, states, measured):
    """Random F, G, Q, H, R of each mode, a transition matrix and a start."""
    systems = [
        (
            rng.normal(size=(states, states)) / math.sqrt(states),
            rng.normal(size=(states, 2)),
            positive(rng, states),
            rng.normal(size=(measured, states)),
            positive(rng, measured),
        )
        for _ in range(modes)
    ]
    transition = rng.dirichlet(np.ones(modes) * 0.7, size=modes) * 0.98 + 0.02 / modes
    start = (
        rng.dirichlet(np.ones(modes) * 3),
        rng.normal(size=(modes, states)),
        np.array([positive(rng, states) for _ in range(modes)]),
    )
    return systems, transition, start


def linear_model(F, G, Q, H, R):
    return EkfModel(
        states=len(F),
        transition=lambda x, u, _: F @ x + G @ u,
        transition_jacobian=lambda *_: F,
        process_noise=lambda *_: Q,
        measurement=lambda x: H @ x,
        measurement_jacobian=lambda _: H,
        measurement_covariance=R,
    )


def assert_same(belief, oracle, tolerance):
    probabilities, means, covariances = oracle
    np.testing.assert_allclose(belief.probabilities, probabilities, rtol=0, atol=tolerance)
    np.testing.assert_allclose(belief.means, means, rtol=tolerance, atol=tolerance)
    np.testing.assert_allclose(belief.covariances, covariances, rtol=tolerance, atol=tolerance)
