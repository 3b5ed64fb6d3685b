"""Names that do not have the form of what they stand for, and functions that do hardly better."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.contact_effects import SlopeByContact
from odometry.effects.corrected import Added
from odometry.effects.in_course import in_course
from odometry.effects.time_course import InBursts
from odometry.effects.tread_slip import TractionLoss
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import Judged
from odometry.gap.fit.evenness import Unevenness
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.form import of_their_form
from odometry.gap.name.unnamed import in_bursts


@pytest.mark.parametrize(("mu", "stands"), [(0.6, True), (2.0, False)])
def test_what_other_effects_have_bent_is_asked_again(monkeypatch, mu, stands):
    """Contacts were a robot when they were named, and are none beside what was added since."""
    monkeypatch.setattr("odometry.gap.name.form.smooth_in_place", lambda *_: None)
    monkeypatch.setattr("odometry.gap.name.form.unevenness", lambda *_: Unevenness(0.0, 1.0))
    effect, refused = SlopeByContact(), []
    fitted = SimpleNamespace(effects=(Added(effect, np.array([mu, 0.2, 0.3, 0.0, 0.03])),))
    found = Explanation(None, (Judged(effect, fitted, 90.0, 80.0, 70.0, 0.1),), ())
    search = SimpleNamespace(
        fitter=None, config=GapConfig(), refuse=lambda *reason: refused.append(reason)
    )
    assert bool(of_their_form(search, found, ()).steps) == stands
    assert bool(refused) != stands


@pytest.mark.parametrize(
    ("cost", "area", "stands"), [(1500.0, 0.6, True), (2500.0, 0.6, False), (1500.0, 0.97, False)]
)
def test_events_must_close_nearly_all_and_come_by_themselves(monkeypatch, cost, area, stands):
    """Of an excess of 10 000, 95 or 85 % close; a variable says when events are, or none does."""
    effect = in_course(TractionLoss(), InBursts((((1.0, 2.0),),)))
    start = SimpleNamespace(cost=11_000.0, effects=())
    fitted = SimpleNamespace(cost=cost, effects=(Added(effect, np.array([0.5, 0.5])),))
    step = Judged(effect, fitted, 9000.0, 8000.0, 7000.0, 0.1)
    monkeypatch.setattr("odometry.gap.name.unnamed.burst_effects", lambda *_: (effect,))
    monkeypatch.setattr("odometry.gap.name.unnamed.judge", lambda *args: [step for _ in args[2]])
    monkeypatch.setattr("odometry.gap.name.unnamed.variable_of_events", lambda *_: ("speed", area))
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
