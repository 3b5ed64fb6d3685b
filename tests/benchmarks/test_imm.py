"""Time of one step of the IMM on poses against filterpy's IMMEstimator, in one run.

Both take the same models, steps and measurements. filterpy's EKF cannot be a member as it is: its
`update` wants the measurement's Jacobian, so it is given by a subclass, as is the transition.
The drive keeps off the cut of the heading, where filterpy's linear means would err.
"""

import time

import numpy as np
import pytest
from filterpy.kalman import ExtendedKalmanFilter, IMMEstimator

from odometry.estimation.imm.ekf_bank import EkfBank, EkfModel
from odometry.estimation.imm.estimator import Imm, Members
from odometry.estimation.imm.markov import ModeChain
from odometry.estimation.imm.mode_belief import ModeBelief
from tests.odometry.estimation.imm.ekf_member import EkfMember

STEP_S, STEPS = 0.05, 200
Q = np.diag([4e-4, 4e-4, 1e-4]) * STEP_S
R = np.diag([0.02, 0.02, 0.01]) ** 2
H = np.eye(3)


def moved(x, u, step_s, k, m):
    ahead = k * u[0] * step_s
    turn = np.broadcast_to(m * u[1] * step_s, x[..., 2].shape)
    return x + np.stack([ahead * np.cos(x[..., 2]), ahead * np.sin(x[..., 2]), turn], axis=-1)


def moved_jacobian(x, u, step_s, k):
    F = np.zeros((*x.shape[:-1], 3, 3))
    F[..., [0, 1, 2], [0, 1, 2]] = 1.0
    F[..., 0, 2] = -k * u[0] * np.sin(x[..., 2]) * step_s
    F[..., 1, 2] = k * u[0] * np.cos(x[..., 2]) * step_s
    return F


def pose_model(k, m):
    return EkfModel(
        states=3,
        transition=lambda x, u, step_s: moved(x, u, step_s, k, m),
        transition_jacobian=lambda x, u, step_s: moved_jacobian(x, u, step_s, k),
        process_noise=lambda *_: Q,
        measurement=lambda x: x,
        measurement_jacobian=lambda _: H,
        measurement_covariance=R,
        state_angles=(2,),
        measurement_angles=(2,),
    )


class FilterpyMember(ExtendedKalmanFilter):
    def __init__(self, k, m):
        super().__init__(dim_x=3, dim_z=3)
        self.k, self.m, self.Q, self.R = k, m, Q, R
        self.x, self.P = np.zeros(3), 0.01 * np.eye(3)

    def predict(self, u):
        self.F = moved_jacobian(self.x, u, STEP_S, self.k)
        super().predict(u)

    def predict_x(self, u):
        self.x = moved(self.x, u, STEP_S, self.k, self.m)

    def update(self, z):
        super().update(z, lambda _: H, lambda x: x, residual=residual)


def residual(measured, predicted):
    difference = measured - predicted
    difference[2] = np.pi - np.mod(np.pi - difference[2], 2 * np.pi)
    return difference


def drive():
    rng = np.random.default_rng(0)
    pose, inputs, seen = np.zeros(3), [], []
    for step in range(STEPS):
        u = np.array([1.0, 0.6 * np.cos(0.03 * step)])
        pose = moved(pose, u, STEP_S, 0.8, 0.6)
        inputs.append(u)
        seen.append(pose + rng.normal(size=3) * [0.02, 0.02, 0.01])
    return inputs, seen


def filterpys(k, m, transition):
    imm = IMMEstimator(
        [FilterpyMember(*mode) for mode in zip(k, m, strict=True)], np.ones(len(k)), transition
    )
    for u, z in zip(*drive(), strict=True):
        imm.predict(u)
        imm.update(z)
    return imm.x, imm.mu


def ours(imm, modes):
    belief = ModeBelief.alike(np.zeros(3), 0.01 * np.eye(3), np.full(modes, 1 / modes))
    for u, z in zip(*drive(), strict=True):
        belief = imm.step(belief, u, z, STEP_S)
        mean, _ = imm.merged(belief)
    return mean, belief.probabilities


BANKS = {
    "filterpy's filters, looped": lambda k, m: Members(
        tuple(EkfMember(pose_model(*mode)) for mode in zip(k, m, strict=True))
    ),
    "all filters at once": lambda k, m: EkfBank(pose_model(k, m), len(k)),
}


@pytest.mark.benchmark(group="200 steps of an IMM on poses")
@pytest.mark.parametrize("modes", [3, 16])
@pytest.mark.parametrize("make_bank", BANKS.values(), ids=BANKS)
def test_imm_against_filterpys(benchmark, make_bank, modes):
    k, m = np.linspace(0.5, 1.0, modes), np.linspace(0.9, 0.4, modes)
    chain = ModeChain(np.full(modes, 5.0))
    imm = Imm(make_bank(k, m), chain.transition, state_angles=(2,), floor=0.0)
    theirs, theirs_s = [], []

    def run_theirs_before_each_round():
        started = time.perf_counter()
        theirs.append(filterpys(k, m, chain.transition(STEP_S)))
        theirs_s.append(time.perf_counter() - started)
        return (imm, modes), {}

    mean, probabilities = benchmark.pedantic(ours, setup=run_theirs_before_each_round, rounds=9)
    their_mean, their_probabilities = theirs[-1]
    np.testing.assert_allclose(mean, their_mean, atol=1e-4)
    np.testing.assert_allclose(probabilities, their_probabilities, atol=1e-3)
    median_s = benchmark.stats.stats.median
    benchmark.extra_info["step_us"] = median_s / STEPS * 1e6
    benchmark.extra_info["filterpys_step_us"] = float(np.median(theirs_s)) / STEPS * 1e6
    benchmark.extra_info["figure"] = float(np.median(theirs_s)) / median_s
