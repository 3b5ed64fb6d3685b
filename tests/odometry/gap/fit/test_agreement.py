"""Positions and yaw show one strength of an effect that is there, two of one that is not."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import HeadingOffset
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.gap.config import GapConfig
from odometry.gap.fit.agreement import POSITIONS, YAW, Disagreement, disagreement, strengths
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.form_gates import is_one_to_all
from odometry.gap.prepare.measured import measured_of

CONFIG = GapConfig()
LATE_S = 0.3


@pytest.fixture(scope="module")
def fit_of(make_scene, known):
    """An effect fitted to a scene of which some columns of the poses are late."""

    def of(effect, late=(), scale=1.0):
        scene = make_scene(3, lambda _, twist: scale * twist)
        poses = scene.poses.copy()
        for column in late:
            then_s = scene.pose_s - LATE_S
            poses[:, column] = np.interp(then_s, scene.pose_s, scene.poses[:, column])
        fitter = Fitter(known, measured_of([replace(scene, poses=poses)], known, CONFIG))
        return fitter, fitter.fit([effect])

    return of


def test_late_poses_are_late_in_all(fit_of):
    fitter, fit = fit_of(TimeOffset(), late=(0, 1, 2))
    assert fit.effects[0].values == pytest.approx(LATE_S, abs=0.05)
    for one in strengths(fitter, fit, 0).values():
        assert one.factor == pytest.approx(1.0, abs=0.1)
    assert is_one_to_all(disagreement(fitter, fit, 0), CONFIG) == ""


def test_a_yaw_that_alone_is_late_is_not_late_poses(fit_of):
    fitter, fit = fit_of(TimeOffset(), late=(2,))
    of = disagreement(fitter, fit, 0)
    assert (of.stronger, of.weaker) == (YAW, POSITIONS)
    assert "the yaw shows" in is_one_to_all(of, CONFIG)


def test_half_of_what_is_there_is_seen_twice_as_strong(fit_of):
    fitter, fit = fit_of(WheelScale(), scale=0.9)
    half = Added(fit.effects[0].effect, (1 + fit.effects[0].values) / 2)
    for one in strengths(fitter, replace(fit, effects=(half,)), 0).values():
        assert one.factor == pytest.approx(2.0, abs=0.2)


def test_what_an_effect_does_not_change_says_nothing_of_it(fit_of):
    """A constant offset of the heading changes no turn."""
    fitter, fit = fit_of(HeadingOffset())
    assert YAW not in strengths(fitter, fit, 0)
    assert disagreement(fitter, fit, 0) is None


@pytest.mark.parametrize(
    ("factors", "sigmas", "refused"),
    [((1.2, 0.4), 9.0, True), ((1.2, 0.4), 3.0, False), ((1.1, 0.9), 9.0, False)],
)
def test_only_a_large_and_sure_difference_counts(factors, sigmas, refused):
    of = Disagreement(POSITIONS, YAW, factors, sigmas)
    assert bool(is_one_to_all(of, CONFIG)) == refused
    assert is_one_to_all(None, CONFIG) == ""
