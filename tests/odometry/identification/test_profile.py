"""Profiled intervals against a general minimiser and bisection over the same loss."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize

from odometry.errors import IdentificationError
from odometry.identification.identify import identify
from odometry.identification.problem import Problem
from odometry.identification.profile import with_profiles
from odometry.identification.start import SolverConfig
from odometry.models.icr_slope import IcrSlope
from odometry.windows.travel.noise import pose_variances

CONFIG = SolverConfig(loss="squares", starts=2)
MODEL = "icr_symmetric"


@pytest.fixture(scope="module")
def curved(winding, synthetic, stated):
    """Half a metre and half a radian of noise: a width is one over a turn, and not normal."""
    run = synthetic.noisy(winding, np.random.default_rng(3), position_m=0.5, yaw_rad=0.5)
    config = replace(stated, position_sigma_m=0.5, yaw_sigma_rad=0.5, horizon_m=6.0)
    return identify([run], MODEL, window_config=config, solver_config=CONFIG)


def brute(fit, name, window_config):
    """Ends where the least squares over the others, by Nelder-Mead, are t^2 above the best."""
    place = fit.names.index(name)
    at = [parameter.name for parameter in fit.model.parameters].index(name)
    free = np.array([parameter.name in fit.names for parameter in fit.model.parameters])
    problem = Problem(fit.model, fit.windows, fit.packed, free, pose_variances(window_config))

    def cost(chosen):
        residuals = problem.residuals(chosen)
        return np.sum(np.einsum("kij,kj->ki", problem.whitening, residuals) ** 2)

    best = fit.packed[free]

    def rise(value):
        others = np.delete(best, place)
        found = minimize(
            lambda rest: cost(np.insert(rest, place, value)),
            others,
            method="Nelder-Mead",
            options={"xatol": 1e-7, "fatol": 1e-9, "maxiter": 4000},
        )
        return found.fun - cost(best)

    step = 1e-4 * fit.sigmas[name]
    columns = [
        (problem.residuals(best + step * axis) - problem.residuals(best - step * axis)) / (2 * step)
        for axis in np.eye(len(best))
    ]
    whitened = np.einsum("kij,fkj->kif", problem.whitening, columns).reshape(-1, len(best))
    plain = np.linalg.inv(whitened.T @ whitened)[place, place]
    of = fit.intervals[name]
    half = (of.high - of.low) / 2
    allowed = (half**2) / plain  # t^2 times the ratio of both variances
    ends = []
    for side in (-1, 1):
        near, far = fit.packed[at], fit.packed[at] + side * half
        while rise(far) < allowed:
            near, far = far, far + side * half
        for _ in range(18):
            middle = (near + far) / 2
            near, far = (middle, far) if rise(middle) < allowed else (near, middle)
        ends.append((near + far) / 2)
    return ends


def test_the_ends_are_where_a_general_minimiser_finds_them(curved):
    (ground,) = curved.terrains.values()
    (profiled,) = with_profiles(curved, CONFIG).terrains.values()
    fit = ground.fit
    assert "b_hat" not in fit.at_bound
    low, high = brute(fit, "b_hat", curved.window_config)
    of, plain = profiled.fit.intervals["b_hat"], fit.intervals["b_hat"]
    width = plain.high - plain.low
    assert (of.low, of.high) == pytest.approx((low, high), abs=3e-3 * width)
    assert abs(of.high - plain.high) > 3 * 3e-3 * width  # no symmetric interval would pass
    assert of.freedom == plain.freedom


def test_where_the_loss_is_quadratic_the_interval_is_students(winding, synthetic, stated):
    run = synthetic.noisy(winding, np.random.default_rng(1))
    found = identify([run], "full_linear", window_config=stated, solver_config=CONFIG)
    (plain,) = found.terrains.values()
    (profiled,) = with_profiles(found, CONFIG).terrains.values()
    for name, of in plain.fit.intervals.items():
        width = of.high - of.low
        ends = (profiled.fit.intervals[name].low, profiled.fit.intervals[name].high)
        assert ends == pytest.approx((of.low, of.high), abs=0.02 * width)


def test_the_interval_of_a_parameter_that_alone_is_free_is_students(winding, synthetic, stated):
    run = synthetic.noisy(winding, np.random.default_rng(1))
    (free,) = identify([run], MODEL, window_config=stated, solver_config=CONFIG).terrains.values()
    held = {"alpha": free.fit.values["alpha"]}
    found = identify([run], MODEL, window_config=stated, solver_config=CONFIG, fixed=held)
    (plain,) = found.terrains.values()
    (profiled,) = with_profiles(found, CONFIG).terrains.values()
    of, ends = plain.fit.intervals["b_hat"], profiled.fit.intervals["b_hat"]
    width = of.high - of.low
    assert (ends.low, ends.high) == pytest.approx((of.low, of.high), abs=0.03 * width)


def test_a_model_fitted_in_stages_has_no_profile(curved):
    (name, ground), *_ = curved.terrains.items()
    staged = replace(ground, fit=replace(ground.fit, model=_Staged()))
    with pytest.raises(IdentificationError, match="stages"):
        with_profiles(replace(curved, terrains={name: staged}), CONFIG)


class _Staged:
    name = "icr_slope"
    stages = IcrSlope.stages
