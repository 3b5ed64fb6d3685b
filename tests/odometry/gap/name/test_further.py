"""What has no name, searched further than rivals of names, and what few stretches leave open."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import Gradual
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.unknown.residual import Residual
from odometry.effects.unknown.residual_variables import FURTHER, REPEATED
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import judge
from odometry.gap.fit.fitter import Fitter
from odometry.gap.name import accepted_effects, further
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.further import FEW, Further, further_candidates
from odometry.gap.name.verdict import MAY_BE_CHANCE
from odometry.gap.prepare.measured import measured_of
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.statistic import floor_of

CONFIG = GapConfig()
ON_ROLL = Residual("roll", tuple(("v_x", k) for k in range(3)), "v_x", (-0.05, 0.0, 0.05))


def lost_on_one_side(columns, twist):
    """Forward speed that is lost with the right side down."""
    share = 0.5 * np.clip(columns["roll"] / 0.05, 0.0, 1.0)
    return twist * (1.0 - share[:, None] * [1.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def scene(make_scene):
    return make_scene(5, lost_on_one_side)


@pytest.fixture(scope="module")
def other(make_scene):
    return make_scene(6, lost_on_one_side)


@pytest.fixture
def few_stretches(monkeypatch):
    """What is held out alone leaves open whether anything gains."""
    monkeypatch.setattr(accepted_effects, "closes_held_out", lambda *_: MAY_BE_CHANCE)


def searched(known, scene, held_out, residual=ON_ROLL):
    """A search, and the explanation by one smooth function."""
    fitter = Fitter(known, measured_of([scene], known, CONFIG))
    floor = floor_of(known.held_back, CONFIG.part_s)
    search = Further(fitter, fitter.fit([]), (held_out,), floor, floor, CONFIG, lambda: None)
    steps = judge(fitter, search.start, [residual], CONFIG, lambda: None)
    return search, Explanation(search.start, tuple(steps), ())


@pytest.mark.usefixtures("few_stretches")
def test_what_few_stretches_leave_open_the_measured_ones_decide(known, scene, other):
    search, found = searched(known, scene, other)
    assert search._fails(found) == MAY_BE_CHANCE
    assert search.sure_with_measured == [found]
    kept = search.further(Explanation(search.start, (), (), unexplained=True))
    assert kept.steps
    assert kept.fitted.cost <= found.fitted.cost
    assert not kept.unexplained


def skidding(_, twist):
    """A centre of rotation 0.2 m ahead of where it was."""
    return twist + twist[:, 2:] * [0.0, -0.2, 0.0]


@pytest.mark.usefixtures("few_stretches")
@pytest.mark.parametrize(
    ("effect", "duration_s", "stands"),
    [
        (LateralSkid(), 35.0, True),
        (LateralSkid(), 75.0, False),  # of so many stretches a gain can be sure
        (in_course(LateralSkid(), Gradual()), 35.0, False),
    ],
)
def test_a_name_that_lasts_may_stand_by_the_stretches_measured(
    known, make_scene, effect, duration_s, stands
):
    held_out = make_scene(6, skidding, duration_s=duration_s)
    few = len(np.unique(numbered_pieces([held_out], CONFIG.part_s))) <= FEW
    assert few == (duration_s < 40)
    search, found = searched(known, make_scene(5, skidding), held_out, effect)
    assert (search._fails(found) == "") == stands


@pytest.mark.usefixtures("few_stretches")
def test_what_closes_less_than_half_there_is_left_out(known, scene, other):
    """On the measured runs it gains as surely as before."""
    search, found = searched(known, scene, other)
    added = found.fitted.effects[0]
    small = replace(found.fitted, effects=(replace(added, values=0.2 * added.values),))
    part = replace(found, steps=(replace(found.steps[0], fitted=small),))
    assert search._fails(part)
    assert search.sure_with_measured == []


def test_without_a_gap_nothing_is_searched_further(known, make_scene, monkeypatch):
    still = make_scene(8)
    search, found = searched(known, still, make_scene(9))
    monkeypatch.setattr(further, "grown_of", None)
    assert not search._is_sure_with_measured(found, CONFIG.least_of_rest)
    nothing = Explanation(search.start, (), ())
    assert search.further(nothing) is nothing


def test_what_is_tried_further_is_no_rival_of_names(known, scene):
    more = further_candidates([scene], known.base, CONFIG)
    assert set(FURTHER) - {REPEATED} < {one.variable for one in more}  # nothing is repeated here
    search, _ = searched(known, scene, scene)
    assert not set(FURTHER) & {one.variable for one in search.small_functions}
    assert len({one.key for one in (*more, *search.small_functions)}) > len(more)


def test_after_a_variable_that_does_not_hold_another_is_tried(known, scene, other, monkeypatch):
    search, found = searched(known, scene, other)
    offered = []

    def grown(_, begun, candidates, __):
        offered.append({one.variable for one in candidates})
        return found if len(offered) == 1 else replace(begun, steps=())

    monkeypatch.setattr(further, "grown_of", grown)
    monkeypatch.setattr(Further, "_standing", lambda _, begun, __: replace(begun, steps=()))
    monkeypatch.setattr(further, "with_course", lambda _, begun: begun)
    search.further(Explanation(search.start, (), (), unexplained=True))
    assert offered[0] - offered[1] == {"roll"}


@pytest.mark.parametrize(("share", "is_taken"), [(0.55, False), (0.65, True)])
def test_what_closes_less_than_what_there_is_does_not_take_its_place(
    known, scene, monkeypatch, share, is_taken
):
    search, found = searched(known, scene, scene)
    there = Explanation(search.start, (), (), unexplained=True, base_closes=True)
    search.sure_with_measured.append(found)
    monkeypatch.setattr(Further, "_tried_in_turn", lambda *_: [])
    monkeypatch.setattr(Further, "_held_out_left", lambda _, one: (0, share if one.steps else 0.6))
    assert bool(search.further(there).steps) is is_taken


@pytest.mark.usefixtures("few_stretches")
@pytest.mark.parametrize("is_above", [True, False])
def test_a_gap_that_is_surely_there_is_searched_whatever_chi_squared_says(
    known, scene, other, is_above
):
    """Many noisy poses hide in chi-squared a degree of freedom what moves the ends of windows."""
    search, _ = searched(known, scene, other)
    search.__dict__["is_above"] = is_above
    nothing = Explanation(search.start, (), ())
    assert bool(search.further(nothing).steps) == is_above
