"""A base that moves beyond its calibration, and what explains that."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.motion.contact_effects import SlopeByContact
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.config import GapConfig
from odometry.gap.name.search import Search

FREE = 8  # numbers of a base: a chi-squared of 26 is beyond 99.9 %


def moved(chi_squared):
    return SimpleNamespace(base_alone=chi_squared)


@pytest.mark.parametrize(
    ("after", "before", "is_above", "closes", "explained"),
    [
        (1.0, 27.0, True, True, True),
        (10.0, 27.0, True, True, False),  # a third of the move is left
        (1.0, 25.0, True, True, False),  # as its calibration allows
        (1.0, 27.0, False, True, False),
        (1.0, 27.0, True, False, False),
    ],
)
def test_a_move_is_explained_by_what_brings_the_base_back(
    after, before, is_above, closes, explained
):
    """Where it closes a gap on held-out data that is surely there."""
    known = SimpleNamespace(uncertain=SimpleNamespace(values=[0.0] * FREE))
    fitter = SimpleNamespace(calibration=known)
    search = Search(fitter, moved(before), (), None, None, GapConfig(), lambda: None)
    search.__dict__.update(is_above=is_above, base_closes=closes)
    assert search.explains_move(moved(after), moved(before)) == explained


def candidate(effect, gain, reason):
    fitted = SimpleNamespace(reason=reason, effects=(SimpleNamespace(effect=effect),))
    return SimpleNamespace(effect=effect, gain=gain, fitted=fitted)


@pytest.mark.parametrize(("of_refused", "expected"), [(120.0, None), (104.0, "wheel_scale")])
def test_a_name_does_not_stand_where_a_refused_candidate_gains_much_more(
    monkeypatch, of_refused, expected
):
    """A loss of traction that is a gain explains more: something began then, and no wheel is it."""
    monkeypatch.setattr("odometry.gap.name.search.is_the_effect", lambda fit, _: fit.reason)
    fitter = SimpleNamespace(spread=lambda _: 1.0, measured=SimpleNamespace(scenes=()))
    search = Search(fitter, None, (), None, None, GapConfig(), lambda: None)
    monkeypatch.setattr(search, "pays", lambda *_: True)
    judged = [candidate(TractionLoss(), of_refused, "a gain"), candidate(WheelScale(), 100.0, "")]
    best = search.best_earner(judged, SimpleNamespace(effects=()))
    assert (best and best.effect.name) == expected
    assert "traction_loss" in search.refusals


@pytest.mark.parametrize(
    ("beside", "spread", "tried"),
    [(True, 2.0, True), (False, 2.0, False), (True, 1.0, False)],
)
def test_contact_forces_are_tried_beside_an_effect_where_nothing_quick_pays(
    monkeypatch, beside, spread, tried
):
    """A slope beside late poses: no quick form need be good enough to lead to it."""
    asked = []
    monkeypatch.setattr(
        "odometry.gap.name.search.judge",
        lambda _, __, candidates, *___: asked.extend(candidates) or [],
    )
    monkeypatch.setattr("odometry.gap.name.search.ranked", lambda *_: [])
    fitter = SimpleNamespace(spread=lambda _: spread)
    search = Search(fitter, None, (), None, None, GapConfig(), lambda: None)
    search.__dict__["_contacts"] = (SlopeByContact(),)
    monkeypatch.setattr(search, "best_earner", lambda *_: None)
    monkeypatch.setattr(search, "_reference_first", lambda *_: None)
    found = Added(WheelScale(), np.array([1.05, 1.0]))
    before = SimpleNamespace(effects=(found,) if beside else ())
    search._judged(before, ())
    assert any(effect.slow for effect in asked) == tried


@pytest.mark.parametrize(("reason", "left"), [("not in the calibration", 0), ("", 1)])
def test_contact_forces_that_spoil_the_calibration_do_not_compete(monkeypatch, reason, left):
    """An inertia beside a loss of traction, by drives as fast as those of the calibration."""
    found = Added(WheelScale(), np.array([1.05, 1.0]))
    fit = SimpleNamespace(effects=(found, Added(SlopeByContact(), np.ones(5))))
    judged = SimpleNamespace(effect=SlopeByContact(), fitted=fit, gain=10.0)
    module = "odometry.gap.name.search"
    monkeypatch.setattr(f"{module}.judge", lambda _, __, of, *___: [judged] if of else [])
    monkeypatch.setattr(f"{module}.ranked", lambda _, __, fits, *___: fits)
    monkeypatch.setattr(f"{module}.spoils_calibration", lambda *_: reason)
    fitter = SimpleNamespace(
        spread=lambda _: 2.0, calibration=None, measured=SimpleNamespace(expected=100.0)
    )
    search = Search(fitter, None, (), None, None, GapConfig(), lambda: None)
    search.__dict__["_contacts"] = (SlopeByContact(),)
    monkeypatch.setattr(search, "best_earner", lambda *_: None)
    monkeypatch.setattr(search, "_reference_first", lambda *_: None)
    assert len(search._judged(SimpleNamespace(effects=(found,)), ())) == left
    assert ("slope_sliding" in search.refusals) == bool(reason)
