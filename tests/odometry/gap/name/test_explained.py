"""Between none and a name: a gap that noise does not explain, and names that explain too little."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.names import explained
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.statistic import floor_of
from odometry.windows.dense.dense import dense_windows_of

CONFIG = GapConfig()


@pytest.fixture(scope="module")
def study(make_scene, known):
    """What is found on level ground where wheels slip by a factor, and jolts move the robot."""

    def of(factor, jolt, duration_s):
        def planted(columns, twist):  # noqa: ARG001 - of the face of effects
            jolts = np.random.default_rng(5).normal(size=twist.shape)
            return factor * twist + jolt * jolts * [1, 0, 1]

        run = make_scene(1, planted, top_m_s=0.5, duration_s=duration_s).run
        level = {name: 0.0 * run.odometry[name] for name in ("roll", "pitch")}
        columns = {**run.odometry.columns, **level}
        scene = dense_windows_of(
            replace(run, odometry=replace(run.odometry, columns=columns)), CONFIG.horizon_s
        )
        fitter = Fitter(known, measured_of([scene], known, CONFIG))
        floor = floor_of(known.held_back, CONFIG.part_s)
        return explained(fitter, [scene], (floor, floor), CONFIG, lambda: None)

    return of


def scaled(columns, twist):  # noqa: ARG001 - of the face of effects
    """Both wheels move 20 % less than recorded."""
    return 0.8 * twist


def wheel_scale(found):
    return next(one for one in found.first if one.effect.name == "wheel_scale")


def test_without_a_gap_nothing_is_named_or_unexplained(study):
    found = study(1.0, 0.0, 60.0)
    assert (found.names, found.unexplained) == ((), False)


@pytest.mark.slow
def test_jolts_are_a_gap_that_nothing_explains(study):
    found = study(1.0, 0.3, 60.0)
    assert (found.names, found.unexplained) == ((), True)
    assert wheel_scale(found).least < CONFIG.least_evidence


@pytest.mark.slow
def test_a_name_that_leaves_what_is_not_noise_is_dropped(study):
    """Wheels do slip, for sure; but it is not the only cause. A smooth function says how much."""
    found = study(0.85, 0.3, 160.0)
    assert "wheel_scale" not in found.names
    (refusal,) = [one for one in found.refusals if one.name == "wheel_scale"]
    assert "not the cause, or not the only one" in refusal.reason
    assert wheel_scale(found).least > CONFIG.least_evidence


@pytest.mark.slow
def test_a_name_that_closes_nearly_all_of_the_gap_stands_beside_jolts(study):
    found = study(0.6, 0.1, 160.0)
    assert found.names[0] == "wheel_scale"
    assert not found.unexplained
    np.testing.assert_allclose(found.fitted.effects[0].values, 0.6, atol=0.03)


@pytest.mark.slow
def test_a_name_that_leaves_two_and_a_half_times_the_floor_is_not_the_only_cause(study):
    """It closes 0.78 of the excess, as did a constant slip in the place of one that grows."""
    found = study(0.6, 0.15, 160.0)
    assert "wheel_scale" not in found.names
    (refusal,) = [one for one in found.refusals if one.name == "wheel_scale"]
    assert refusal.reason.startswith("it closes 78 % of the gap on held-out data")


def test_a_scale_from_the_start_is_no_loss_from_a_moment(make_scene, known):
    """`traction_loss` from 0 s has more evidence here, by 0.1 of 48,300."""
    scene = make_scene(2, scaled, duration_s=60.0)
    fitter = Fitter(known, measured_of([scene], known, CONFIG))
    floor = floor_of(known.held_back, CONFIG.part_s)
    found = explained(fitter, [scene], (floor, floor), CONFIG, lambda: None)
    assert found.names == ("wheel_scale",)
    np.testing.assert_allclose(found.fitted.effects[0].values, 0.8, atol=0.01)
