"""An effect of many parameters gives way to simpler ones that it includes, where they cost less."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import LeverArm
from odometry.effects.measurement.time_offset import ClockDrift, TimeOffset
from odometry.effects.motion.curvature import Curvature
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.motion.terrain import NewIcrs
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import Judged
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.names import by_fewer, by_parts, simplest

CANDIDATES = (WheelScale(), LateralSkid(), LeverArm(), NewIcrs(), TimeOffset())


def explanation(effects, cost, first=()):
    names = [effect.name for effect in effects]
    return SimpleNamespace(effects=tuple(effects), names=tuple(names), cost=cost, first=first)


@pytest.fixture(autouse=True)
def nothing_is_idle(monkeypatch):
    monkeypatch.setattr("odometry.gap.name.names.without_idle", lambda _, found: found)


def exchanged(effects, cost, cost_of_pair, first=()):
    """Names of what is left where every other explanation costs so much, by its effects."""

    def in_order(_, others):
        return explanation(others, cost_of_pair(*(effect.name for effect in others)))

    search = SimpleNamespace(in_order=in_order)
    return by_parts(search, explanation(effects, cost, first), CANDIDATES).names


@pytest.mark.parametrize(
    ("of_pair", "expected"),
    [(90.0, ("wheel_scale", "lateral_skid")), (110.0, ("terrain",))],
)
def test_wheels_and_a_skid_stand_for_new_icrs_where_they_cost_less(of_pair, expected):
    def cost_of(*names):
        return of_pair if "lateral_skid" in names else 200.0

    assert exchanged([NewIcrs()], 100.0, cost_of) == expected


def test_other_effects_stay_beside_the_parts():
    names = exchanged([TimeOffset(), NewIcrs()], 100.0, lambda *_: 90.0)
    assert names == ("time_offset", "wheel_scale", "lateral_skid")


def test_what_includes_nothing_stays():
    assert exchanged([WheelScale()], 100.0, lambda *_: 0.0) == ("wheel_scale",)


def test_of_both_that_of_more_evidence_gives_the_name():
    first = [
        SimpleNamespace(effect=effect, evidence=evidence)
        for effect, evidence in ((WheelScale(), 100.0), (LateralSkid(), 900.0))
    ]

    def cost_of_pair(*names):
        return 90.0 if set(names) == {"wheel_scale", "lateral_skid"} else 120.0

    names = exchanged([NewIcrs()], 100.0, cost_of_pair, first)
    assert names == ("lateral_skid", "wheel_scale")


@pytest.mark.parametrize(
    ("lacks", "cost", "expected"),
    [
        ("", 99.0, ("curvature", "lateral_skid")),
        ("", 101.0, ("terrain",)),
        ("without beta_1 it closes as much", 99.0, ("terrain",)),
    ],
)
def test_one_cause_is_not_exchanged_for_names_that_are_not_what_they_say(
    lacks, cost, expected, monkeypatch
):
    """The same width in every turn is no curvature, though its three parameters cost less."""
    monkeypatch.setattr(
        "odometry.gap.name.names.lacks_essence",
        lambda _, fit, place, __: lacks if fit.effects[place].effect.name == "curvature" else "",
    )
    effects = [Curvature(), LateralSkid()]
    fitted = SimpleNamespace(
        effects=[Added(one, np.array([p.start for p in one.parameters])) for one in effects]
    )
    others = Explanation(
        None, tuple(Judged(one, fitted, 9.0, 8.0, 7.0, 0.1) for one in effects), ()
    )
    monkeypatch.setattr(Explanation, "cost", property(lambda _: cost))
    search = SimpleNamespace(
        stepwise=lambda _: others, config=GapConfig(), fitter=SimpleNamespace()
    )
    whole = explanation([NewIcrs()], 100.0)
    whole.steps = ("one",)
    assert by_fewer(search, whole, CANDIDATES).names == expected


@pytest.mark.parametrize(
    ("constant", "form"), [(4996.0, "constant"), (5040.0, "constant"), (5060.0, "drift")]
)
def test_a_clock_that_is_late_and_hardly_drifts_is_late(constant, form, monkeypatch):
    """Of 10,000 that is closed it may lose 50: less than that is no drift to speak of."""
    drift = ClockDrift()
    fitted = SimpleNamespace(effects=(Added(drift, np.array([0.3, 1e-4])),))
    found = explanation([drift], 5000.0)
    found.fitted = fitted
    monkeypatch.setattr("odometry.gap.name.names.cost_of", lambda _: 15_000.0)
    search = SimpleNamespace(
        in_order=lambda _, effects: explanation(effects, constant),
        config=GapConfig(),
        spread_of=lambda _: 1.0,
        start=None,
    )
    (effect,) = simplest(search, found, (TimeOffset(), drift, LeverArm())).effects
    assert effect.form == form
