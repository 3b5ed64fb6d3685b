"""What may stand in the place of a name: a slow course, a part of itself, shares of motion."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.tread_slip import SlipBySpeed
from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment, InBursts
from odometry.effects.motion.curvature import Curvature
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.effects.unknown.residual import ANGLES, OF_TREADS, TREADS, VARIABLES, Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import judge
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.own_moments import observed_s
from odometry.gap.name import form, names
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form import (
    is_part_of,
    lacks_essence,
    slow_course_in_place,
    without_essence,
)
from odometry.gap.name.form_gates import (
    is_by_its_essence,
)
from odometry.gap.name.general import shares_of_motion
from odometry.gap.name.unnamed import variable_of_events
from odometry.gap.name.verdict import (
    come_by_themselves,
)
from odometry.gap.prepare.measured import measured_of

CONFIG = GapConfig()


@pytest.fixture(scope="module")
def asked_for_a_moment(make_scene, known):
    """Why a loss of traction from a moment is none, where the truth keeps shares of all motion."""

    def of(kept):
        def planted(columns, twist):
            return kept(columns["t"])[:, None] * twist

        scene = make_scene(8, planted).numbered(0)
        fitter = Fitter(known, measured_of([scene], known, CONFIG))
        loss = in_course(TractionLoss(), FromAMoment((observed_s(scene),)))
        search = SimpleNamespace(fitter=fitter, held_out=(scene,), config=CONFIG)
        return slow_course_in_place(search, fitter.fit([loss]), 0)

    return of


def test_what_is_lost_at_once_has_a_moment(asked_for_a_moment):
    assert not asked_for_a_moment(lambda t: np.where(t < 70.0, 1.0, 0.8))


def test_what_comes_and_goes_slowly_has_none(asked_for_a_moment):
    reason = asked_for_a_moment(lambda t: 0.8 + 0.2 * np.cos(2 * np.pi * t / 160.0))
    assert "no moment" in reason


@pytest.fixture(scope="module")
def curved(make_scene, known):
    """The effect of a width fitted where the truth turns by shares that speeds say."""

    def of(share):
        def planted(columns, twist):
            turned = twist.copy()
            turned[:, 1:] *= share(columns["v_left"], columns["v_right"])[:, None]
            turned[:, 0] += 0.015 * (turned[:, 2] - twist[:, 2])  # of the eccentric ICRs
            return turned

        fitter = Fitter(known, measured_of([make_scene(9, planted)], known, CONFIG))
        fit = fitter.fit([Curvature()])
        return without_essence(fitter, fit, 0), fit.effects[0]

    return of


def test_a_width_that_is_the_same_everywhere_is_no_curvature(curved):
    share, added = curved(lambda left, _: np.full(len(left), 0.7))
    assert share > 0.95
    assert "without beta_1" in is_by_its_essence(share, added, CONFIG)


def test_a_width_that_shrinks_towards_the_straight_is(curved):
    def share(left, right):
        radius = np.abs(left + right) / np.maximum(np.abs(right - left), 1e-6)
        return 1 / (0.9 * (1 + 0.8 / (1 + np.sqrt(radius))))

    closed, added = curved(share)
    assert not is_by_its_essence(closed, added, CONFIG)


@pytest.mark.parametrize(("share", "least", "most"), [(0.4, 100.0, np.inf), (0.0, -1.0, 9.0)])
def test_chi_squared_rises_where_what_is_there_is_left_out(make_scene, known, share, least, most):
    """Speeds that fall with the speed; all else, here nothing, is fitted anew."""

    def planted(_, twist):
        return twist * (1 - share * np.abs(twist[:, :1]))

    fitter = Fitter(known, measured_of([make_scene(9, planted)], known, CONFIG))
    fit = fitter.fit([SlipBySpeed()])
    assert least < fitter.rise_without(fit, 0, ("growth",)) < most


@pytest.mark.parametrize(("effect", "is_part"), [(WheelScale(), True), (LateralSkid(), False)])
def test_constant_shares_are_part_of_a_function_that_may_be_constant(
    make_scene, known, effect, is_part
):
    fitter = Fitter(known, measured_of([make_scene(9, lambda _, t: 0.9 * t)], known, CONFIG))
    knots = (0.0, 0.5, 1.0)
    terms = tuple((side, number) for side in ("left", "right") for number in range(3))
    function = fitter.fit([Residual("tread_speed", terms, "speed", knots)])
    assert is_part_of(fitter, fitter.fit([effect]), 0, function) == is_part


def turned_ahead(_, twist):
    """About a point 0.3 m behind, and a little faster to the left."""
    turns = twist[:, 2]
    return twist + np.stack([0 * turns, 0.3 * turns, 0.03 * np.abs(turns)], axis=-1)


@pytest.mark.parametrize(
    ("other", "stays"),
    [(turned_ahead, True), (lambda _, t: t + 0.3 * np.abs(t[:, 2:]) * [0, 1, 0], False)],
    ids=["in proportion to the turn", "to one side whatever the turn"],
)
def test_a_place_stays_where_it_is_the_main_part_of_what_follows_the_turn(
    make_scene, known, other, stays
):
    fitter = Fitter(known, measured_of([make_scene(9, other)], known, CONFIG))
    terms = tuple((part, number) for part in ("v_y", "omega") for number in range(5))
    function = Residual("speed_difference", terms, "", (-0.8, -0.2, 0.0, 0.2, 0.8))
    search = SimpleNamespace(fitter=fitter, start=fitter.fit([]), config=CONFIG)
    search.spread_of = lambda found: max(1.0, fitter.spread(found.fitted))
    nothing = Explanation(search.start, (), ())
    place, smooth = (
        replace(nothing, steps=tuple(judge(fitter, search.start, [one], CONFIG, lambda: None)))
        for one in (LateralSkid(), function)
    )
    assert (names._better(search, place, [smooth]) is place) == stays


def test_what_needs_nothing_is_not_asked(make_scene, known):
    fitter = Fitter(known, measured_of([make_scene(9)], known, CONFIG))
    loss = in_course(TractionLoss(), FromAMoment())
    assert lacks_essence(fitter, fitter.fit([loss]), 0, CONFIG) == ""


@pytest.mark.parametrize(
    ("losses", "in_full"),
    [
        ((90.0, 124.0, 126.0, 300.0), [0, 1]),  # the name closes 100 of 200
        ((126.0, 130.0, 140.0, 150.0), []),
        ((60.0, 50.0, 40.0, 30.0, 20.0, 10.0), [2, 3, 4, 5]),
    ],
)
def test_what_leaves_little_more_to_first_order_is_fitted_in_full(losses, in_full, monkeypatch):
    """A quarter of what the name closes, and four functions at the most."""
    functions = range(len(losses))
    name = SimpleNamespace(effect=SimpleNamespace(slow=False))
    asked = []

    def fit(effects, *_, **__):
        asked.extend(effects)
        return SimpleNamespace(cost=200.0 - 50.0 * len(effects), effects=())

    fitter = SimpleNamespace(
        fit=fit,
        linear_losses=lambda *_: np.array(losses),
        spread=lambda _: 1.0,
        measured=None,
    )
    monkeypatch.setattr(form, "cost_of", lambda fit: fit.cost)
    monkeypatch.setattr(form, "surely_dearer", lambda *_: -np.inf)
    search = SimpleNamespace(fitter=fitter, config=CONFIG, held_out=())
    names = SimpleNamespace(effects=[name], cost=100.0)
    assert form.smooth_in_place(search, names, 0, functions) is None
    assert sorted(asked) == in_full


@pytest.mark.parametrize(
    ("spread", "closes_less", "stands"),
    [(1.2, True, True), (1.2, False, False), (1.4, True, False)],
)
def test_a_name_that_leaves_noise_gives_way_to_what_closes_as_much_elsewhere(
    spread, closes_less, stands, monkeypatch
):
    """No equation is exact of a body: the runs that a function was fitted to follow it better."""
    function = "of anything"
    name = SimpleNamespace(effect=SimpleNamespace(slow=False))

    def fit(effects, *_, **__):
        kept = tuple(SimpleNamespace(effect=one) for one in effects)
        return SimpleNamespace(cost=60.0 if function in effects else 200.0, effects=kept)

    fitter = SimpleNamespace(
        fit=fit, linear_losses=lambda *_: np.array([60.0]), spread=lambda _: spread, measured=None
    )
    monkeypatch.setattr(form, "cost_of", lambda fit: fit.cost)
    monkeypatch.setattr(form, "surely_dearer", lambda *_: np.inf)
    monkeypatch.setattr(form, "closes_less", lambda *_: closes_less)
    search = SimpleNamespace(fitter=fitter, config=CONFIG, held_out=())
    names = SimpleNamespace(effects=[name], cost=100.0)
    instead = form.smooth_in_place(search, names, 0, [function])
    assert instead is (None if stands else function)


def test_shares_of_motion_follow_every_variable(make_scene, known):
    found = shares_of_motion([make_scene(70, lambda _, twist: twist)], known.base, CONFIG)
    of_treads = {one.variable for one in found if one.by == "speed"}
    forward = {one.variable for one in found if one.by == "v_x"}
    known_here = set(VARIABLES) - {"time_since_stop"}  # the drive has none
    assert of_treads == known_here - {"time"}  # that is among the general ones
    assert forward == {one.variable for one in found if one.by == "omega"}
    assert forward == known_here - set(OF_TREADS)
    for one in found:
        added_to = {component for component, _ in one.terms}
        assert added_to == (set(TREADS) if one.by == "speed" else {one.by})
        assert bool(one.knots) == (one.variable not in ANGLES)


@pytest.mark.parametrize(("where", "by_themselves"), [("sand", False), ("both", True)])
def test_events_on_one_terrain_depend_on_it(make_scene, known, where, by_themselves):
    """Twelve short events in 160 s, on sand alone, which is half of the time, or anywhere."""

    def terrain(t):
        return np.where(t % 40 < 20, "sand", "grass")

    scene = make_scene(71, terrain=terrain).numbered(0)
    begins_s = 13.3 * np.arange(12)
    if where == "sand":
        begins_s = np.array([40 * number + at for number in range(4) for at in (2, 8, 15)])
    course = InBursts((tuple((begin, begin + 1.0) for begin in begins_s.tolist()),))
    name, area = variable_of_events(course, [scene], known.base)
    assert bool(come_by_themselves(name, area, CONFIG)) != by_themselves
    assert (name == "terrain") != by_themselves
