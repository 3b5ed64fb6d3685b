"""The IMM against its textbook recursion.

The oracle is Bar-Shalom, Li, Kirubarajan 2001, section 11.6.6, steps 1 to 5, in plain sums and
probabilities that are not logarithms; headings by the direction of summed unit vectors. It shares
no code with the package.
"""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.estimation.imm.ekf_bank import EkfBank, EkfModel
from odometry.estimation.imm.estimator import Imm, Members
from odometry.estimation.imm.mode_belief import ModeBelief
from tests.odometry.estimation.imm.ekf_member import EkfMember
from tests.reference.imm_systems import assert_same, linear_model, linear_system, positive

seeds = st.integers(0, 2**32 - 1)


def turned_back(angle):
    return math.atan2(math.sin(angle), math.cos(angle))


def weighted(weights, means, covariances, angles):
    """Moments of one mixture."""
    n = len(means[0])
    mean = [sum(w * x[a] for w, x in zip(weights, means, strict=True)) for a in range(n)]
    for a in angles:
        sine = sum(w * math.sin(x[a]) for w, x in zip(weights, means, strict=True))
        cosine = sum(w * math.cos(x[a]) for w, x in zip(weights, means, strict=True))
        mean[a] = math.atan2(sine, cosine)
    spread = [[0.0] * n for _ in range(n)]
    for w, x, P in zip(weights, means, covariances, strict=True):
        d = [x[a] - mean[a] for a in range(n)]
        for a in angles:
            d[a] = turned_back(d[a])
        for a in range(n):
            for b in range(n):
                spread[a][b] += w * (P[a][b] + d[a] * d[b])
    return np.array(mean), np.array(spread)


def oracle_step(belief, transition, filters, z, angles):
    """One cycle; `filters[j](mean, covariance, z)` gives mean, covariance, likelihood."""
    probabilities, means, covariances = belief
    modes = range(len(probabilities))
    c = [sum(transition[i][j] * probabilities[i] for i in modes) for j in modes]
    new = []
    for j in modes:
        mixing = [transition[i][j] * probabilities[i] / c[j] for i in modes]
        mean, covariance = weighted(mixing, means, covariances, angles)
        new.append(filters[j](mean, covariance, z))
    total = sum(new[j][2] * c[j] for j in modes)
    return (
        [new[j][2] * c[j] / total for j in modes],
        [new[j][0] for j in modes],
        [new[j][1] for j in modes],
    )


def likelihood_of(residual, S):
    squared = residual @ np.linalg.inv(S) @ residual
    return math.exp(-squared / 2) / math.sqrt(np.linalg.det(2 * math.pi * S))


def kalman(system, u):
    F, G, Q, H, R = system

    def step(x, P, z):
        x, P = F @ x + G @ u, F @ P @ F.T + Q
        S = H @ P @ H.T + R
        K = P @ H.T @ np.linalg.inv(S)
        return x + K @ (z - H @ x), P - K @ S @ K.T, likelihood_of(z - H @ x, S)

    return step


@settings(max_examples=60)
@given(seeds, st.integers(1, 4), st.integers(1, 4), st.integers(1, 3))
def test_random_linear_banks(seed, modes, states, measured):
    rng = np.random.default_rng(seed)
    systems, transition, start = linear_system(rng, modes, states, measured)
    bank = Members(tuple(EkfMember(linear_model(*system)) for system in systems))
    imm = Imm(bank, lambda _: transition, floor=0.0)
    belief = ModeBelief(start[1], start[2], np.log(start[0]))
    oracle = start
    for _ in range(8):
        u, z = rng.normal(size=2), rng.normal(size=measured) * 2
        belief = imm.step(belief, u, z, 0.1)
        filters = [kalman(system, u) for system in systems]
        oracle = oracle_step(oracle, transition, filters, z, ())
        assert_same(belief, oracle, 1e-9)
        mean, covariance = weighted(*oracle, ())
        np.testing.assert_allclose(imm.merged(belief)[0], mean, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(imm.merged(belief)[1], covariance, rtol=1e-9, atol=1e-9)


def pose_filter(mode, R, u, step_s):
    """A textbook EKF of Salvi 2024 eq. 3 of a mode (k, m, Q), yaw kept in (-pi, pi]."""
    k, m, Q = mode

    def step(x, P, z):
        v, w = k * u[0], m * u[1]
        F = np.array(
            [
                [1, 0, -v * math.sin(x[2]) * step_s],
                [0, 1, v * math.cos(x[2]) * step_s],
                [0, 0, 1],
            ]
        )
        x = x + np.array([v * math.cos(x[2]), v * math.sin(x[2]), w]) * step_s
        P = F @ P @ F.T + Q
        S = P + R
        residual = z - x
        residual[2] = turned_back(residual[2])
        K = P @ np.linalg.inv(S)
        x = x + K @ residual
        x[2] = turned_back(x[2])
        return x, P - K @ S @ K.T, likelihood_of(residual, S)

    return step


def pose_bank(k, m, Q, R):
    def transition(x, u, step_s):
        v, w = k * u[0], m * u[1]
        return x + np.stack([v * np.cos(x[:, 2]), v * np.sin(x[:, 2]), w], axis=-1) * step_s

    def jacobian(x, u, step_s):
        F = np.tile(np.eye(3), (len(k), 1, 1))
        F[:, 0, 2] = -k * u[0] * np.sin(x[:, 2]) * step_s
        F[:, 1, 2] = k * u[0] * np.cos(x[:, 2]) * step_s
        return F

    model = EkfModel(
        states=3,
        transition=transition,
        transition_jacobian=jacobian,
        process_noise=lambda *_: Q,
        measurement=lambda x: x,
        measurement_jacobian=lambda _: np.eye(3),
        measurement_covariance=R,
        state_angles=(2,),
        measurement_angles=(2,),
    )
    return EkfBank(model, len(k))


@settings(max_examples=60)
@given(seeds, st.integers(1, 5))
def test_random_banks_of_poses(seed, modes):
    """Headings all round the circle; the beliefs of the modes lie up to a right angle apart."""
    rng = np.random.default_rng(seed)
    k, m = rng.uniform(0.4, 1.0, modes), rng.uniform(0.2, 1.0, modes)
    Q = np.array([0.02 * positive(rng, 3) for _ in range(modes)])
    R = 0.1 * positive(rng, 3)
    transition = rng.dirichlet(np.ones(modes), size=modes) * 0.98 + 0.02 / modes
    heading = rng.uniform(-np.pi, np.pi)
    means = rng.normal(size=(modes, 3)) * [0.2, 0.2, 0.0] + [0, 0, heading]
    means[:, 2] += rng.uniform(-0.75, 0.75, modes)
    means[:, 2] = [turned_back(angle) for angle in means[:, 2]]
    covariances = np.array([0.1 * positive(rng, 3) for _ in range(modes)])
    oracle = rng.dirichlet(np.ones(modes) * 3), means, covariances
    imm = Imm(pose_bank(k, m, Q, R), lambda _: transition, state_angles=(2,), floor=0.0)
    belief = ModeBelief(oracle[1], oracle[2], np.log(oracle[0]))
    for _ in range(8):
        u, step_s = rng.uniform(-2, 2, 2), rng.uniform(0.02, 0.2)
        z = weighted(*oracle, (2,))[0] + rng.normal(size=3) * 0.3
        belief = imm.step(belief, u, z, step_s)
        filters = [pose_filter(mode, R, u, step_s) for mode in zip(k, m, Q, strict=True)]
        oracle = oracle_step(oracle, transition, filters, z, (2,))
        turns = np.exp(1j * (belief.means[:, 2] - np.array(oracle[1])[:, 2]))
        np.testing.assert_allclose(turns, 1, atol=1e-9)
        np.testing.assert_allclose(belief.means[:, :2], np.array(oracle[1])[:, :2], atol=1e-9)
        np.testing.assert_allclose(belief.covariances, oracle[2], atol=1e-9)
        np.testing.assert_allclose(belief.probabilities, oracle[0], rtol=0, atol=1e-9)
