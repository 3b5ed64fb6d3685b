"""A moment of one run is not carried to another: each has its own, evaluated on other runs."""

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.config import GapConfig
from odometry.gap.fit import own_moments
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.own_moments import observed_s, with_own_moments
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.statistic import gap_of

SHARE, FIRST_S, SECOND_S = 0.6, 50.0, 83.0


@pytest.fixture(scope="module")
def lost(make_scene):
    def make(seed, moment_s, number):
        def planted(columns, twist):
            return np.where(columns["t"][:, None] >= moment_s, SHARE, 1.0) * twist

        return make_scene(seed, planted, duration_s=120.0, name=f"run_{number}").numbered(number)

    return make


@pytest.fixture(scope="module")
def scenes(lost):
    return lost(1, FIRST_S, 0), lost(2, SECOND_S, 1)


@pytest.fixture(scope="module")
def loss(scenes):
    effect = in_course(TractionLoss(), FromAMoment((observed_s(scenes[0]),)))
    return Added(effect, np.array([SHARE, SHARE, FIRST_S]))


def test_two_measured_runs_have_a_moment_each(known, scenes):
    fitter = Fitter(known, measured_of(scenes, known, GapConfig()))
    effect = in_course(TractionLoss(), FromAMoment(tuple(observed_s(one) for one in scenes)))
    fit = fitter.fit([effect])
    k, m, *moments_s = fit.effects[0].values
    assert (k, m) == pytest.approx((SHARE, SHARE), abs=0.01)
    assert moments_s == pytest.approx([FIRST_S, SECOND_S], abs=0.5)
    assert fitter.spread(fit) < 1.2


def test_a_run_of_two_that_has_none_never_begins(known, make_scene, lost):
    other = make_scene(3, lambda _, twist: twist, duration_s=120.0, name="whole").numbered(1)
    both = (lost(1, FIRST_S, 0), other)
    fitter = Fitter(known, measured_of(both, known, GapConfig()))
    effect = in_course(TractionLoss(), FromAMoment(tuple(observed_s(one) for one in both)))
    first_s, second_s = fitter.fit([effect]).effects[0].values[2:]
    assert first_s == pytest.approx(FIRST_S, abs=0.5)
    assert second_s > observed_s(other)[1]


def test_the_other_run_has_a_moment_of_its_own(known, scenes, loss):
    (found,), judged = with_own_moments(known.base, [loss], scenes[1:], scenes[:1], known)
    assert found.by_name == pytest.approx(
        {"k": SHARE, "m": SHARE, "moment_1": FIRST_S, "moment_2": SECOND_S}, abs=3.0
    )
    assert gap_of(known.base, [found], judged, 10.0).value < 0.03
    assert gap_of(known.base, [loss], judged, 10.0).value > 0.1


def test_windows_that_tell_the_moment_and_those_near_it_do_not_judge(known, scenes, loss):
    (found,), (judged,) = with_own_moments(known.base, [loss], scenes[1:], scenes[:1], known)
    begins_s, moment_s = scenes[1].start_s, found.values[-1]
    np.testing.assert_array_equal(np.isin(judged.start_s, begins_s[::2]), True)
    assert np.abs(judged.start_s - moment_s).min() > 2.0


def test_a_run_without_it_never_begins(known, make_scene, scenes, loss):
    other = make_scene(3, lambda _, twist: twist, duration_s=120.0, name="whole").numbered(1)
    (found,), judged = with_own_moments(known.base, [loss], [other], scenes[:1], known)
    assert found.values[-1] > observed_s(judged[0])[1]
    assert gap_of(known.base, [found], judged, 10.0).value < 0.03


@pytest.mark.parametrize("seed", range(4))
def test_of_moments_that_close_as_much_the_first_is_taken(known, scenes, loss, monkeypatch, seed):
    """As where the robot stands between them: rounding does not choose."""
    rng = np.random.default_rng(seed)

    def level_around(_base, effects, scene):
        level = np.maximum(np.abs(effects[0].values[-1] - SECOND_S), 5.0)
        return np.full(len(scene), level * (1.0 + 1e-13 * rng.normal()))

    monkeypatch.setattr(own_moments, "squared_errors", level_around)
    (found,), _ = with_own_moments(known.base, [loss], scenes[1:], scenes[:1], known)
    first_s = observed_s(scenes[1].where(np.arange(len(scenes[1])) % 2 == 1))[0]
    tried_s = first_s + np.arange(120.0)
    assert found.values[-1] == tried_s[tried_s >= SECOND_S - 5.0][0]


def test_pieces_of_the_measured_run_know_its_moment(known, scenes, loss):
    (found,), (judged,) = with_own_moments(known.base, [loss], scenes[:1], scenes[:1], known)
    assert found is loss
    assert len(judged) == len(scenes[0])


def test_what_is_always_there_is_judged_on_all(known, scenes):
    scale = Added(WheelScale(), np.array([0.9, 0.9]))
    effects, judged = with_own_moments(known.base, [scale], scenes[1:], scenes[:1], known)
    assert effects == (scale,)
    assert judged[0] is scenes[1]


def test_a_moment_before_which_hardly_any_way_was_driven_is_none(scenes):
    """A loss that begins as the robot does is there all along."""
    scene = scenes[0]
    of_moments = FromAMoment((observed_s(scene),))
    share = (scene.travel_m - scene.travel_m[0]) / np.ptp(scene.travel_m)
    early_s, later_s = (np.interp(of, share, scene.time_s) for of in (0.04, 0.06))
    assert early_s > scene.pose_s[scene.windows[:, -1]].min()
    assert not of_moments.is_meant(np.array([early_s]))
    assert of_moments.is_meant(np.array([later_s]))
