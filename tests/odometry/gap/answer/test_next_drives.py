"""Which drive distinguishes two effects, and with what odds."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.commands.late_treads import ActuatorLag, CommandDelay
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment
from odometry.effects.measurement.reference_fault import Compass
from odometry.effects.measurement.sensor_mount import HeadingOffset, LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.motion.slope_icr import SlopeByIcr
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.answer.drives import drives_of, scene_of
from odometry.gap.answer.next_drives import (
    as_driven,
    chi_squared_left,
    next_drives,
    odds_of,
    rivalling,
)
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitted

CONFIG = GapConfig()
SURE = 1e-8


@pytest.fixture(scope="module")
def scenes(make_scene):
    """Over hills, at up to 1 m/s."""
    return (make_scene(70, lambda _, twist: twist, duration_s=60.0),)


@pytest.fixture
def fit(known):
    """An effect as it was fitted, with a variance of each of its parameters."""

    def fitted(effect, values, variance=SURE):
        covariance = np.diag(np.broadcast_to(variance, len(values)).astype(float))
        none = np.zeros(0)
        added = (Added(effect, np.array(values)),)
        return Fitted(known.base, added, covariance, none, none, 0.0)

    return fitted


def left(pair, scene, known):
    return chi_squared_left(*map(rivalling, pair), scene, known, CONFIG)


def test_the_odds_are_those_of_drawn_noise():
    """Rows of white noise about the truth, a rival off by D: how often it loses by 12."""
    rng = np.random.default_rng(0)
    for distance in (2.0, 4.0, 6.0):
        off = np.full(50, distance / np.sqrt(50))
        noise = rng.standard_normal((20000, 50))
        gains = ((noise + off) ** 2).sum(axis=1) - (noise**2).sum(axis=1)
        assert odds_of(distance**2, 12.0) == pytest.approx((gains > 12.0).mean(), abs=0.01)
    assert odds_of(0.0, 12.0) == 0.0


def test_no_drive_tells_what_is_equal_by_its_equations(scenes, known, fit):
    """An arm ahead and turning about a point behind move the sensor in the same way."""
    arm = fit(LeverArm(), [0.1, 0.0], 1e-4)
    skid = fit(LateralSkid(), [-0.1], 1e-4)
    assert not next_drives({"lever_arm": arm, "lateral_skid": skid}, scenes, known, CONFIG)


def test_without_gyroscope_late_commands_are_late_stamps(scenes, known, fit):
    """From rest to rest; on a slope the attitude says when the robot turned, as it does."""
    rivals = {
        "time_offset": fit(TimeOffset(), [0.3], 1e-6),
        "command_delay": fit(CommandDelay(), [0.3], 1e-6),
    }
    silent = [scene.without_gyroscope() for scene in scenes]
    (found,) = next_drives(rivals, silent, known, CONFIG)
    assert "slope" in found.words


def test_the_most_varied_drive_is_proposed_for_all_that_it_decides(scenes, known, fit):
    """Any drive distinguishes a lost speed from a turned yaw; none does so for equal equations."""
    rivals = {
        "lateral_skid": fit(LateralSkid(), [-0.1], 1e-4),
        "lever_arm": fit(LeverArm(), [0.1, 0.0], 1e-4),
        "wheel_scale": fit(WheelScale(), [0.9, 0.9], 1e-4),
        "actuator_lag": fit(ActuatorLag(), [0.2], 1e-4),
    }
    found = next_drives(rivals, scenes, known, CONFIG)
    assert [one.between[1] for one in found] == ["wheel_scale", "actuator_lag"]
    assert {one.words.split()[0] for one in found} == {"curves"}


def test_what_follows_the_heading_needs_a_drive_that_looks_all_round(known, fit, make_scene):
    """On one straight a compass that is off by the heading is a yaw that is off."""
    straight = make_scene(71, lambda _, twist: twist * [1.0, 0.0, 0.0], duration_s=60.0)
    straight = replace(
        straight, inputs=replace(straight.inputs, heading_rad=0.0 * straight.inputs.time_s)
    )
    rivals = {
        "heading_offset": fit(HeadingOffset(), [0.06], 1e-6),
        "reference_fault": fit(Compass(), [0.0, 0.06], 1e-6),
    }
    (found,) = next_drives(rivals, [straight], known, CONFIG)
    assert found.words.startswith("circles of 1 m radius to both sides with steps")
    del rivals["reference_fault"]
    rivals["lateral_skid"] = fit(LateralSkid(), [-0.1], 1e-4)
    (found,) = next_drives(rivals, [straight], known, CONFIG)
    assert found.words.startswith("curves")


def test_slopes_are_distinguished_from_wheels_on_a_slope_alone(scenes, known, fit):
    """On level ground the one does nothing; sizes are known to next to nothing."""
    slope = fit(SlopeByIcr(0.3, 0.3), [1.0, 1.0, 2.0], 1e-2)
    wheels = fit(WheelScale(), [1.0, 1.0], SURE)
    pair = (slope, wheels)
    for drive in drives_of(scenes, known.base, CONFIG):
        chi_squared = left(pair, scene_of(drive, known.base, scenes[0]), known)
        assert (chi_squared > 1.0) == ("slope" in drive.words)
    (found,) = next_drives({"slope_sliding": slope, "wheel_scale": wheels}, scenes, known, CONFIG)
    assert "slope" in found.words
    assert found.between == ("slope_sliding", "wheel_scale")
    assert found.odds > 0.9


def test_what_is_open_of_a_rival_is_fitted_to_the_drive(scenes, known, fit):
    """Factors that are not known at all take the place of any other factors."""
    scene = scene_of(drives_of(scenes, known.base, CONFIG)[-1], known.base, scenes[0])
    true = fit(WheelScale(), [0.98, 0.99])
    surely = left((true, fit(WheelScale(), [1.0, 1.0])), scene, known)
    openly = left((true, fit(WheelScale(), [1.0, 1.0], 1.0)), scene, known)
    assert surely > 100
    assert openly < 0.02 * surely


def test_a_lag_shows_where_speed_changes(scenes, known, fit):
    pair = (fit(ActuatorLag(), [0.2]), fit(WheelScale(), [1.0, 1.0], 1e-4))
    by_words = {
        drive.words.split(" ")[0]: left(pair, scene_of(drive, known.base, scenes[0]), known)
        for drive in drives_of(scenes, known.base, CONFIG)
    }
    assert by_words["straights"] > 100


def test_a_drive_is_cut_as_the_measured_ones(scenes, known, fit):
    for drive in drives_of(scenes, known.base, CONFIG):
        scene = scene_of(drive, known.base, scenes[0])
        assert scene.windows.shape[1] == scenes[0].windows.shape[1]
        assert (scene.windows < len(scene.poses)).all()
        span_s = scene.pose_s[scene.windows[:, -1]] - scene.pose_s[scene.windows[:, 0]]
        np.testing.assert_allclose(span_s, CONFIG.horizon_s, atol=0.3)
        assert np.abs(drive.speeds_m_s).max() <= 1.01
        same = as_driven(rivalling(fit(WheelScale(), [1.0, 1.0])), scene)
        np.testing.assert_allclose(same.poses, scene.poses, atol=0.05)


def test_after_its_moment_an_effect_is_there(fit):
    lost = in_course(TractionLoss(), FromAMoment())
    rival = rivalling(fit(lost, [0.8, 0.7, 30.0]))
    (added,) = rival.effects
    assert isinstance(added.effect, TractionLoss)
    np.testing.assert_array_equal(added.values, [0.8, 0.7])
    assert rival.covariance.shape == (2, 2)
