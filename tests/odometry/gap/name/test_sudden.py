"""A tyre that is lost at a moment has a name; one that shrinks slowly has no moment."""

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment, Gradual
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.config import GapConfig
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name.accepted_effects import Standing
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.sudden import sudden_instead, sudden_wheels
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.statistic import floor_of

CONFIG = GapConfig()
KEPT, MOMENT_S = 0.85, 31.0
WIDTH, Y_RIGHT, X_ICR = 0.87, -0.42, 0.02  # of the robot that the scenes are of


@pytest.fixture(scope="module")
def study(make_scene, known):
    """What is found where the left tread loses a share of its speed that is a function of time."""

    def of(share):
        def planted(columns, twist):
            lost = (1 - KEPT) * share(columns["t"]) * columns["v_left"]
            by_lost = np.array([Y_RIGHT / WIDTH, -X_ICR / WIDTH, 1 / WIDTH])
            return twist + lost[:, None] * by_lost

        scene = make_scene(4, planted)
        fitter = Fitter(known, measured_of([scene], known, CONFIG))
        floor = floor_of(known.held_back, CONFIG.part_s)
        start = fitter.fit([])
        search = Standing(fitter, start, (scene,), floor, floor, CONFIG, lambda: None)
        return sudden_wheels(search, Explanation(start, (), ())), search

    return of


def test_the_moment_and_the_side_are_estimated(study):
    found, _ = study(lambda t: t > MOMENT_S)
    (added,) = found.fitted.effects
    assert added.effect.key == ("wheel_scale", "factors", "from_a_moment")
    np.testing.assert_allclose(added.values[:2], [KEPT, 1.0], atol=0.01)
    assert added.values[2] == pytest.approx(MOMENT_S, abs=0.5)


def test_what_comes_slowly_has_no_moment(study):
    found, search = study(lambda t: np.clip(t / t[-1], 0, 1))
    assert not found.steps
    assert "not the cause" in search.refusals["wheel_scale"].reason


def test_what_begins_at_a_moment_has_to_close_nearly_all(study):
    _, search = study(lambda t: t > MOMENT_S)
    for effect in (TractionLoss(), WheelScale()):
        sudden = in_course(effect, FromAMoment())
        assert search._most_fitted([sudden]) == CONFIG.bursts_closed
        assert search._most_fitted([effect]) == CONFIG.mostly_closed


@pytest.mark.parametrize(
    ("share", "course"),
    [(lambda t: t > MOMENT_S, "from_a_moment"), (lambda t: np.clip(t / t[-1], 0, 1), "gradual")],
    ids=["a step", "a ramp"],
)
def test_a_step_takes_the_place_of_a_ramp_where_it_is_one(study, share, course):
    _, search = study(share)
    last_s = search.fitter.measured.scenes[0].time_s[-1]
    slow = in_course(WheelScale(), Gradual(float(last_s)))
    ramp = search.in_order(Explanation(search.start, (), ()), [slow])
    found = sudden_instead(search, ramp)
    assert [effect.course for effect in found.effects] == [course]
    assert found.cost <= ramp.cost


def test_names_beside_the_wheels_stay(study):
    _, search = study(lambda t: t > MOMENT_S)
    slow = in_course(WheelScale(), Gradual(160.0))
    both = search.in_order(Explanation(search.start, (), ()), [TimeOffset(), slow])
    found = sudden_instead(search, both)
    assert [effect.name for effect in found.effects] == ["time_offset", "wheel_scale"]
    assert found.effects[-1].course == "from_a_moment"
