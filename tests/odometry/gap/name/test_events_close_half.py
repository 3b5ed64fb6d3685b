"""Names in bursts close half of the gap where their events were not chosen, or do not stand."""

from types import SimpleNamespace

import pytest

from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import InBursts
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.config import GapConfig
from odometry.gap.name import accepted_effects
from odometry.gap.name.accepted_effects import Standing
from odometry.gap.name.explanation import Explanation
from odometry.gap.prepare.statistic import Gap

CONFIG = GapConfig()
BURSTS = in_course(TractionLoss(), InBursts((((10.0, 14.0), (30.0, 33.0)),)))
SMALL = Gap(0.03, 0.018, 0.04)  # of which the interval begins within that of the floor
FLOOR = Gap(0.02, 0.015, 0.025)


def refused(monkeypatch, effect, share):
    """Why an effect is refused that leaves noise on the measured runs, and a small gap held out."""
    reasons = []
    search = SimpleNamespace(
        config=CONFIG,
        held_floor=FLOOR,
        fitter=SimpleNamespace(spread=lambda _: 1.0),
        _held_out_left=lambda _: (SMALL, share),
        _most=lambda _: 0.8,
        _least_part=lambda names: Standing._least_part(search, names),
        _least_of_rest=lambda _: CONFIG.least_of_rest,
        refuse=lambda _, reason: reasons.append(reason),
        _standing=lambda found, _: found,
    )
    monkeypatch.setattr(accepted_effects, "structure_left", lambda *_: [])
    monkeypatch.setattr(accepted_effects, "grown", lambda *_: Explanation(None, (), ()))
    steps = (SimpleNamespace(effect=effect, fitted=None),)
    Standing._without_structure(search, Explanation(None, steps, ()), ())
    return reasons


@pytest.mark.parametrize(
    ("effect", "share", "stands"),
    [(BURSTS, 0.21, False), (BURSTS, 0.55, True), (TractionLoss(), 0.21, True)],
)
def test_what_was_chosen_by_its_errors_closes_half(monkeypatch, effect, share, stands):
    reasons = refused(monkeypatch, effect, share)
    assert (
        reasons == []
        if stands
        else reasons[0].startswith("it closes 21 % of the gap on held-out data")
    )
