"""Names that do not have the form of what they stand for, and functions that do hardly better."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.tread_slip import SlipBySpeed
from odometry.effects.interface.corrected import Added
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import InBursts
from odometry.effects.motion.contact_effects import SlopeByContact
from odometry.effects.motion.curvature import Curvature
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.fit.agreement import POSITIONS, YAW, Disagreement
from odometry.gap.fit.contest import Judged
from odometry.gap.fit.evenness import Unevenness
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form import of_their_form
from odometry.gap.name.unnamed import in_bursts


def stands(monkeypatch, effect, values):
    """Whether a name of even strength that no function beats stands; a refusal has a reason."""
    monkeypatch.setattr("odometry.gap.name.form.smooth_in_place", lambda *_: None)
    monkeypatch.setattr("odometry.gap.name.form.unevenness", lambda *_: Unevenness(0.0, 1.0))
    refused = []
    fitted = SimpleNamespace(effects=(Added(effect, np.array(values)),))
    found = Explanation(None, (Judged(effect, fitted, 90.0, 80.0, 70.0, 0.1),), ())
    search = SimpleNamespace(
        fitter=SimpleNamespace(measured=SimpleNamespace(scenes=())),
        config=GapConfig(),
        refuse=lambda *reason: refused.append(reason),
    )
    is_named = bool(of_their_form(search, found, ()).steps)
    assert bool(refused) != is_named
    return is_named


@pytest.mark.parametrize(("mu", "expected"), [(0.6, True), (2.0, False)])
def test_what_other_effects_have_bent_is_asked_again(monkeypatch, mu, expected):
    """Contacts were a robot when they were named, and are none beside what was added since."""
    assert stands(monkeypatch, SlopeByContact(), [mu, 0.2, 0.3, 0.0, 0.03]) == expected


@pytest.mark.parametrize(("factors", "expected"), [((1.2, 0.4), False), ((1.05, 0.95), True)])
def test_a_name_of_which_yaw_and_positions_disagree_does_not_stand(monkeypatch, factors, expected):
    of = Disagreement(YAW, POSITIONS, factors, 9.0)
    monkeypatch.setattr("odometry.gap.name.form.disagreement", lambda *_: of)
    assert stands(monkeypatch, SlipBySpeed(), [0.1]) == expected


def test_a_name_that_passed_by_what_another_did_is_tested_again(monkeypatch):
    """A slip by speed is beaten in its place; without it, so is the curvature beside it."""
    curvature, slip = Curvature(), SlipBySpeed()
    function = Residual("speed", (("omega", 0), ("omega", 1)), "omega", (0.0, 1.0))
    beaten_with = {(curvature, slip): slip, (curvature,): curvature}

    def in_place(_, alone, place, __):
        names = tuple(added.effect for added in alone.effects)
        return function if names[place] is beaten_with[names] else None

    def explained(effects):
        added = tuple(Added(one, np.ones(len(one.parameters))) for one in effects)
        steps = [Judged(one, None, 9.0, 8.0, 7.0, 0.1) for one in effects[:-1]]
        last = Judged(effects[-1], SimpleNamespace(effects=added), 9.0, 8.0, 7.0, 0.1)
        return Explanation(None, (*steps, last), ())

    monkeypatch.setattr("odometry.gap.name.form.smooth_in_place", in_place)
    monkeypatch.setattr("odometry.gap.name.form._of_no_form", lambda *_: "")
    monkeypatch.setattr("odometry.gap.name.form.is_more_than_one", lambda *_: "")
    refused = []
    search = SimpleNamespace(
        fitter=SimpleNamespace(fit=lambda effects, _: explained(effects).fitted),
        refuse=lambda effect, _: refused.append(effect),
        in_order=lambda _, effects: explained(effects),
    )
    assert of_their_form(search, explained([curvature, slip]), ()).steps == ()
    assert refused == [slip, curvature]


@pytest.mark.parametrize(
    ("cost", "of_events", "stands"),
    [
        (1500.0, (0.6, 0.5, ""), True),
        (2500.0, (0.6, 0.5, ""), False),
        (1500.0, (0.97, 0.5, ""), False),
        (1500.0, (0.6, 0.005, ""), False),
        (1500.0, (0.6, 0.5, "a slow course explains more"), False),
    ],
)
def test_events_close_nearly_all_by_themselves_and_at_once(monkeypatch, cost, of_events, stands):
    """Of an excess of 10 000, 95 or 85 % close; a variable or the place says when, or a course."""
    area, chance, slow = of_events
    effect = in_course(TractionLoss(), InBursts((((1.0, 2.0),),)))
    start = SimpleNamespace(cost=11_000.0, effects=())
    fitted = SimpleNamespace(cost=cost, effects=(Added(effect, np.array([0.5, 0.5])),))
    step = Judged(effect, fitted, 9000.0, 8000.0, 7000.0, 0.1)
    monkeypatch.setattr("odometry.gap.name.unnamed.burst_effects", lambda *_: (effect,))
    monkeypatch.setattr("odometry.gap.name.unnamed.judge", lambda *args: [step for _ in args[2]])
    monkeypatch.setattr("odometry.gap.name.unnamed.variable_of_events", lambda *_: ("speed", area))
    monkeypatch.setattr("odometry.gap.name.unnamed.chance_of_places", lambda *_: chance)
    monkeypatch.setattr("odometry.gap.name.unnamed.slow_course_instead", lambda *_: slow)
    refused = []
    fitter = SimpleNamespace(
        measured=SimpleNamespace(expected=1000.0, scenes=()),
        calibration=SimpleNamespace(base=None),
        spread=lambda _: 5.0,
    )
    search = SimpleNamespace(
        config=GapConfig(),
        fitter=fitter,
        has_excess=lambda _: True,
        best_earner=lambda judged, _: next(iter(judged), None),
        progress=None,
        refuse=lambda *reason: refused.append(reason),
    )
    assert bool(in_bursts(search, Explanation(start, (), ())).steps) == stands
    assert bool(refused) != stands
