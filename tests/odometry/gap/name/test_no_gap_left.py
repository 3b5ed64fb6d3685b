"""Names that leave more than the noise of the calibration, and no gap."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import judge
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name import accepted_effects, left_by_names
from odometry.gap.name.accepted_effects import Standing
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.left_by_names import leaves_no_gap
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.measures import on_runs
from odometry.gap.prepare.statistic import Gap, Measure, floor_of
from odometry.windows.dense.dense_noise import Noise

CONFIG = GapConfig()
CALM = Noise(0.003, 0.0012, 1e-4, 1e-5)  # a third of what the poses have


def scaled(columns, twist):  # noqa: ARG001 - of the face of effects
    return 0.97 * twist


def turning_less(columns, twist):
    """And turns that no scale of both wheels explains."""
    return scaled(columns, twist) * [1.0, 1.0, 0.7]


@pytest.fixture(scope="module")
def calmer(known, make_scene):
    """A calibration whose noise is less than that of all runs; its floor is theirs."""
    kept = tuple((known.base, make_scene(seed)) for seed in (900, 901, 902))
    return replace(known, noise=CALM, held_back=kept)


def searched(calmer, make_scene, planted):
    """A search, the explanation by the scale of both wheels, and the runs held out."""
    fitter = Fitter(calmer, measured_of([make_scene(1, planted)], calmer, CONFIG))
    floor = floor_of(calmer.held_back, CONFIG.part_s)
    held_out = (make_scene(3, planted),)
    search = Standing(fitter, fitter.fit([]), held_out, floor, floor, CONFIG, lambda: None)
    steps = judge(fitter, search.start, [WheelScale()], CONFIG, lambda: None)
    return search, Explanation(search.start, tuple(steps), ())


def no_gap_left(search, found):
    return leaves_no_gap(search.fitter, found.fitted, search.held_out, CONFIG)


def test_a_name_stands_where_all_errors_are_within_their_floors(calmer, make_scene, monkeypatch):
    """Chi-squared is that of a rougher drive: without the change the answer would be none."""
    search, found = searched(calmer, make_scene, scaled)
    assert search.fitter.spread(found.fitted) > CONFIG.left_over
    assert search._less_doubtful(found) is found
    monkeypatch.setattr(left_by_names, "leaves_no_gap", lambda *_: False)
    assert not search._less_doubtful(found).has_name


def test_not_where_headings_are_off(calmer, make_scene):
    search, found = searched(calmer, make_scene, turning_less)
    assert not no_gap_left(search, found)


def wobbling(columns, twist):
    """And turns to and fro by a fifth of a degree: headings are off, and positions hardly."""
    turn_rad_s = 0.005 * np.sin(2 * np.pi * columns["t"] / 4.0)
    return scaled(columns, twist) + turn_rad_s[:, None] * [0.0, 0.0, 1.0]


def test_headings_that_are_no_gap_by_themselves_are_none_beside_a_name(calmer, make_scene):
    """Above their floor, and by less than what is called a gap where nothing has a name."""
    search, found = searched(calmer, make_scene, wobbling)
    model = found.fitted.base, found.fitted.effects
    scenes = search.fitter.measured.scenes
    gap, floor = on_runs(calmer, scenes, CONFIG, Measure.HEADING, model)
    assert floor.high < gap.value < CONFIG.turns_times * floor.value
    assert no_gap_left(search, found)


def with_a_moment(search, found):
    """And a loss of traction from a moment on beside it."""
    late = in_course(TractionLoss(), FromAMoment())
    return search.in_order(found, [*found.effects, late])


def test_what_comes_at_a_moment_takes_no_name_with_it(calmer, make_scene, monkeypatch):
    search, found = searched(calmer, make_scene, scaled)
    both = with_a_moment(search, found)
    assert search._less_doubtful(both).names == found.names
    monkeypatch.setattr(left_by_names, "leaves_no_gap", lambda *_: False)
    assert not search._less_doubtful(both).has_name


def test_where_no_gap_is_left_a_function_beside_a_name_follows_noise(
    calmer, make_scene, monkeypatch
):
    search, found = searched(calmer, make_scene, scaled)
    monkeypatch.setattr(accepted_effects, "leaves_noise", lambda *_: "")
    monkeypatch.setattr(accepted_effects, "is_the_main_part", lambda *_: "a function does more")
    assert search._less_doubtful(found) is found
    monkeypatch.setattr(left_by_names, "leaves_no_gap", lambda *_: False)
    assert not search._less_doubtful(found).has_name


def test_not_where_it_closed_little(calmer, make_scene):
    """Errors that were within their floors before are no gap that a name closes."""
    search, found = searched(calmer, make_scene, lambda columns, twist: twist)  # noqa: ARG005
    assert not no_gap_left(search, found)


@pytest.mark.parametrize(
    ("before_m", "left_m", "expected"),
    [
        pytest.param(0.25, (0.096, 0.057, 0.138), True, id="above it by chance"),
        pytest.param(0.50, (0.130, 0.125, 0.135), False, id="surely above it"),
        pytest.param(0.15, (0.096, 0.057, 0.138), False, id="closes three quarters"),
    ],
)
def test_positions_may_be_above_their_floor_by_chance(monkeypatch, before_m, left_m, expected):
    """As where nothing has a name; the interval of the floor alone is not asked."""
    floor = Gap(0.079, 0.061, 0.095)
    gaps = iter([Gap(before_m, before_m, before_m), Gap(*left_m)])
    monkeypatch.setattr(left_by_names, "on_runs", lambda *_: (next(gaps), floor))
    fit, fitter = SimpleNamespace(base=None, effects=()), SimpleNamespace(calibration=None)
    assert left_by_names._is_within(fitter, fit, (), CONFIG) == expected


def test_not_of_what_begins_at_a_moment(calmer, make_scene):
    search, found = searched(calmer, make_scene, scaled)
    assert no_gap_left(search, found)
    effect = in_course(WheelScale(), FromAMoment())
    late = Added(effect, np.array([*found.fitted.effects[0].values, 0.0]))
    assert not leaves_no_gap(
        search.fitter, replace(found.fitted, effects=(late,)), search.held_out, CONFIG
    )
