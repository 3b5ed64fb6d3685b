"""Coefficients and courses in time that each run has of its own."""

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added
from odometry.effects.unknown.residual import Residual
from odometry.effects.unknown.residual_of_each_run import ResidualOfEachRun
from odometry.gap.config import GapConfig
from odometry.gap.fit.course import _losses as run_losses
from odometry.gap.fit.course import best_course
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.own_moments import with_own_moments
from odometry.gap.fit.own_values import by_turns, damped
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.responses import columns_of, simulated_scenes
from odometry.gap.prepare.statistic import gap_of
from odometry.windows.dense.averaged import averaged_windows

CONFIG = GapConfig()
NOISE_M = 0.02  # of the position at the end of a window


@pytest.fixture(scope="module")
def pushed(make_scene):
    """Runs that a wind over the world pushes, each from another side, by times of 20 s."""

    def make(seed, number, towards):
        def planted(columns, twist):
            gust = 0.1 * np.clip(np.sin(2 * np.pi * columns["t"] / 40.0 + seed), 0.0, None)
            yaw = np.concatenate([[0.0], np.cumsum(twist[:-1, 2] * np.diff(columns["t"]))])
            push = gust * np.exp(1j * (towards - yaw))
            return twist + np.column_stack([push.real, push.imag, np.zeros(len(yaw))])

        scene = make_scene(seed, planted, duration_s=120.0, name=f"run_{number}")
        return averaged_windows(scene).numbered(number)

    return make(5, 0, 0.3), make(6, 1, 2.5)


@pytest.fixture(scope="module")
def course(pushed, known):
    fitter = Fitter(known, measured_of(pushed[:1], known, CONFIG))
    return best_course(fitter, fitter.fit([]), pushed[1:], CONFIG)


def test_a_push_over_the_world_is_distinguished_from_slip(course):
    assert isinstance(course.effect, ResidualOfEachRun)
    assert {component for component, _ in course.effect.terms} == {"world_x", "world_y"}
    assert course.least > CONFIG.least_evidence


def test_another_run_has_its_own_course_judged_on_windows_between(pushed, known, course):
    effects, judged = with_own_moments(
        known.base, course.fitted.effects, pushed[1:], pushed[:1], known
    )
    assert effects[0].effect.runs == 2
    before = gap_of(known.base, (), judged, CONFIG.part_s).value
    after = gap_of(known.base, effects, judged, CONFIG.part_s).value
    assert before > 0.08
    assert before - after > 0.8 * (before - NOISE_M)
    np.testing.assert_array_equal(judged[0].start_s, pushed[1].start_s[::2])


def test_pieces_of_a_fitted_run_have_their_course_found_on_windows_beside_them(pushed, known):
    """Knots within a piece that is held out lie where no fitted window is."""
    run = pushed[0]
    out = np.floor(run.start_s / CONFIG.part_s) % CONFIG.held_back == 1
    fitted, held = run.where(~out), run.where(out)
    fitter = Fitter(known, measured_of([fitted], known, CONFIG))
    found = best_course(fitter, fitter.fit([]), [held], CONFIG)
    of_fit = found.fitted.effects
    effects, judged = with_own_moments(known.base, of_fit, [held], [fitted], known)
    np.testing.assert_array_equal(judged[0].start_s, held.start_s[::2])
    before, of_neighbours, after = (
        gap_of(known.base, of, judged, CONFIG.part_s).value for of in ((), of_fit, effects)
    )
    assert before > 0.08
    assert after - NOISE_M < 0.4 * (of_neighbours - NOISE_M)
    assert before - after > 0.8 * (before - NOISE_M)


def test_a_load_that_moves_moves_the_centre_of_rotation_for_a_while(make_scene, known):
    """To and fro by 0.15 m ahead, each 15 s."""

    def planted(columns, twist):
        ahead_m = np.where(columns["t"] % 30 < 15, 0.15, -0.15)
        return twist - ahead_m[:, None] * twist[:, 2:] * [0, 1, 0]

    scene = averaged_windows(make_scene(8, planted, duration_s=120.0)).numbered(0)
    fitter = Fitter(known, measured_of([scene], known, CONFIG))
    found = best_course(fitter, fitter.fit([]), [scene], CONFIG)
    assert {(component, found.effect.by) for component, _ in found.effect.terms} == {
        ("v_y", "omega")
    }
    assert found.least > CONFIG.least_evidence


def test_where_nothing_is_there_the_course_does_not_pay(make_scene, known):
    still = averaged_windows(make_scene(7, lambda _, twist: twist, duration_s=120.0)).numbered(0)
    fitter = Fitter(known, measured_of([still], known, CONFIG))
    found = best_course(fitter, fitter.fit([]), [still], CONFIG)
    assert found is None or found.least < CONFIG.least_evidence


def test_damped_values_are_the_mean_of_normal_ones(rng):
    """Against the posterior by the covariance of rows and values together."""
    jacobian, rows, spread = rng.normal(size=(9, 3)), rng.normal(size=9), 0.4
    prior = spread**2 * np.eye(3)
    gain = prior @ jacobian.T @ np.linalg.inv(jacobian @ prior @ jacobian.T + np.eye(9))
    np.testing.assert_allclose(damped(jacobian, rows, spread), -gain @ rows, atol=1e-12)


def test_by_turns_each_is_judged_by_the_others(rng):
    jacobian, rows, turn = rng.normal(size=(8, 2)), rng.normal(size=8), np.arange(8) % 2
    for spread, found in zip((0.5, 0.1), by_turns(jacobian, rows, (0.5, 0.1), turn), strict=True):
        values = damped(jacobian[turn == 1], rows[turn == 1], spread)
        np.testing.assert_allclose(found[turn == 0], (rows + jacobian @ values)[turn == 0])


def test_runs_by_themselves_cost_what_they_cost_together(pushed, known):
    """Coefficients of one run do nothing to the rows of the other."""
    measured = measured_of(pushed, known, CONFIG)
    terms, knots = (("v_x", 0), ("v_x", 1), ("omega", 2)), (0.0, 40.0, 80.0)
    effects = [ResidualOfEachRun("time", terms, "", knots, runs=2, spread=s) for s in (0.1, 0.02)]
    simulated = simulated_scenes(known.base, (), measured.scenes)
    rows = measured.rows(known.base, ())
    jacobian = columns_of(effects[0], simulated, measured.whiteners)
    together = by_turns(jacobian, rows, (0.1, 0.02), measured.window_of_row % 2)
    losses = [loss for loss, _ in run_losses(measured, simulated, effects, rows)]
    np.testing.assert_allclose(losses, (together**2).sum(axis=1))


def test_a_plain_smooth_function_is_judged_as_it_is(pushed, known):
    plain = Added(Residual("heading", (("v_x", 0),)), np.array([0.1]))
    effects, judged = with_own_moments(known.base, [plain], pushed[1:], pushed[:1], known)
    assert effects == (plain,)
    assert judged[0] is pushed[1]
