from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.errors import IdentificationError
from odometry.identification.problem import Problem, StretchProblem
from odometry.identification.solve import solve
from odometry.identification.start import SolverConfig, start_of
from odometry.models.icr import Icr
from odometry.models.radius_of_curvature import RadiusOfCurvature
from odometry.recording.run import Run
from odometry.windows.config import WindowConfig
from odometry.windows.travel.noise import pose_variances, window_covariances
from odometry.windows.travel.windows import windows_of

FREE = np.array([True, False, True, False, True])


@pytest.fixture(scope="module")
def problem(winding, synthetic):
    windows = windows_of([winding], WindowConfig())
    values = Icr().pack(synthetic.icrs)
    return Problem(Icr(), windows, values, FREE, pose_variances(WindowConfig()))


def test_free_parameters_are_put_in_their_places(problem):
    assert problem.names == ("y_left", "x_icr", "alpha_right")
    before = problem.values.copy()
    assert problem.complete(np.array([1.0, 2.0, 3.0])).tolist() == [1, -0.36, 2, 0.97, 3]
    np.testing.assert_array_equal(problem.values, before)


def test_the_search_range_goes_before_the_bounds(problem):
    low, high = problem.bounds()
    assert low.tolist() == [1e-3, -np.inf, 0]
    assert high.tolist() == [np.inf, np.inf, 2]
    model = RadiusOfCurvature()
    free = np.array([False, True, True, False])
    low, high = Problem(model, problem.windows, np.ones(4), free, problem.variances).bounds()
    assert (low.tolist(), high.tolist()) == ([-0.9, 0.0], [1e3, 1e3])


def test_nothing_is_left_at_the_truth(problem):
    np.testing.assert_allclose(problem.residuals(np.array([0.45, 0.06, 0.93])), 0, atol=1e-12)


def test_residuals_are_predicted_less_measured(problem):
    """0.1 rad/s too fast on a single window of known duration turns the yaw too far."""
    away = problem.residuals(np.array([0.40, 0.06, 0.93]))
    windows = problem.windows
    narrower = (0.45 + 0.36) / (0.40 + 0.36)
    turns = np.array(
        [
            windows.steps_s[i:j] @ (0.93 * windows.inputs.right - 0.97 * windows.inputs.left)[i:j]
            for i, j in zip(windows.first, windows.last, strict=True)
        ]
    )
    np.testing.assert_allclose(away[:, 2], turns / 0.81 * (narrower - 1), rtol=0, atol=1e-10)


def test_yaw_residuals_stay_small_where_a_window_turns_around(synthetic, tmp_path):
    """Spinning three turns a window: measured yaw is wrapped, predicted is not."""
    odometry = np.column_stack([np.arange(0, 30, 0.1), np.full(300, -0.8), np.full(300, 0.8)])
    twist_of = synthetic.icr_twist(synthetic.icrs)
    run = Run.read(synthetic.write(tmp_path, odometry, np.arange(0, 29, 0.25), twist_of))
    windows = windows_of([run], WindowConfig(horizon_m=10.0))
    values = Icr().pack(synthetic.icrs)
    problem = Problem(Icr(), windows, values, np.ones(5, bool), np.full(3, 1e-4))
    np.testing.assert_allclose(problem.residuals(values), 0, atol=1e-11)
    assert np.abs(problem.residuals(values * [1.01, 1.01, 1, 1, 1])[:, 2]).max() > 0.1


def test_whitened_covariances_are_unit_matrices(problem):
    covariances = window_covariances(problem.windows, problem.variances)
    factors = problem.whitening
    unit = factors @ covariances @ factors.swapaxes(1, 2)
    np.testing.assert_allclose(unit, np.broadcast_to(np.eye(3), unit.shape), atol=1e-12)


def test_jacobian_is_the_derivative_of_the_residuals(problem):
    at, h = np.array([0.5, -0.1, 0.8]), 1e-6
    columns = [
        (problem.residuals(at + h * e) - problem.residuals(at - h * e)) / (2 * h) for e in np.eye(3)
    ]
    numeric = np.stack(columns, axis=-1)
    np.testing.assert_allclose(problem.jacobian(at), numeric, rtol=1e-6, atol=1e-7)


class Counted(Icr):
    """Counts how often it is asked for a motion."""

    def __init__(self):
        self.asked = []

    def twist(self, values, inputs):
        self.asked.append(values.tobytes())
        return super().twist(values, inputs)


def test_both_at_once_are_what_each_is(problem):
    at = np.array([0.5, -0.1, 0.8])
    apart = replace(problem)
    residuals, jacobian = problem.linearised(at)
    np.testing.assert_allclose(apart.residuals(at), residuals, rtol=0, atol=1e-12)
    np.testing.assert_array_equal(apart.jacobian(at), jacobian)


def test_a_search_computes_no_motion_twice(problem):
    """Residuals, derivative, loss and distances at one point: one motion."""
    model = Counted()
    counted = replace(problem, model=model)
    start = np.array([0.6, 0.1, 0.9])
    solve(counted, start, np.array([0.4, 0.25, 1.0]), SolverConfig(starts=1))
    assert len(model.asked) > 3
    assert len(model.asked) == len(set(model.asked))


def test_points_are_remembered_by_their_values_and_forgotten(problem):
    near, far = np.array([0.45, 0.06, 0.93]), np.array([0.6, 0.1, 0.9])
    fresh = replace(problem)
    first = fresh.residuals(near).copy()
    for factor in (1.0, 1.1, 1.2, 1.3):
        fresh.linearised(far * factor)
    np.testing.assert_allclose(fresh.linearised(near)[0], first, rtol=0, atol=1e-12)
    with pytest.raises(ValueError, match="read-only"):
        fresh.linearised(near)[1][:] = 0.0
    assert np.abs(fresh.linearised(far)[0] - first).max() > 0.01


@pytest.mark.parametrize(("turns_rad", "numbers"), [(None, 7), (np.zeros((1, 4)), 11)])
def test_the_direction_of_a_stretch_takes_one_of_its_numbers(problem, turns_rad, numbers):
    """Four steps of two positions, or of two and a turn."""
    stretches = SimpleNamespace(steps=4, turns_rad=turns_rad)
    of = StretchProblem(problem.model, stretches, problem.values, FREE, problem.variances)
    assert of.numbers_per_window == numbers


def test_as_many_numbers_as_parameters_are_too_few(winding):
    start = start_of(
        Icr(),
        winding.robot,
        fixed={"alpha_left": 1.0},
        released=frozenset(),
        near=None,
        solver_config=SolverConfig(),
    )
    start.require_numbers(5, "stretches", 1)
    with pytest.raises(IdentificationError, match="4 stretches do not determine 4 parameters"):
        start.require_numbers(4, "stretches", 1)
