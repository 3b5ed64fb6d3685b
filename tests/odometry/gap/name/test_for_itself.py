"""A name beside smooth functions, where as many of these alone cost less."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from odometry.effects.motion.contact_effects import InertiaByContact
from odometry.effects.motion.inertia_icr import InertiaByIndices
from odometry.effects.unknown.residual import Residual
from odometry.gap.name.accepted_effects import Standing
from odometry.gap.name.explanation import Explanation

SMOOTH = [Residual(name, (("v_y", 0),), "", (0.0, 1.0)) for name in ("curvature", "speed", "time")]


class Costing(Explanation):
    """An explanation that says what it costs."""

    cost = property(lambda self: self.start)


def explanation(cost, *effects):
    return Costing(cost, tuple(SimpleNamespace(effect=one, fitted=None) for one in effects), ())


def stood(monkeypatch, found, alone, undecided, by_names=None):
    """What stands, and why others do not, where `alone` is grown and a name is `undecided`.

    `by_names` are names that leave no gap by themselves.
    """
    monkeypatch.setattr(
        "odometry.gap.name.accepted_effects.by_themselves", lambda *_: by_names, raising=False
    )
    monkeypatch.setattr("odometry.gap.name.accepted_effects.grown", lambda *_: alone)
    monkeypatch.setattr("odometry.gap.name.accepted_effects.undecided", lambda *_: undecided)
    refused = {}
    search = SimpleNamespace(
        fitter=None,
        config=None,
        refuse=lambda effect, reason: refused.update({effect.name: reason}),
        _standing=lambda found, _: replace(found),
    )
    return Standing._for_itself(search, found, ()), refused


@pytest.mark.parametrize(
    ("effects", "alone", "expected"),
    [
        pytest.param([InertiaByIndices(), SMOOTH[0]], (99.0, 1), "unknown", id="one costs less"),
        pytest.param([InertiaByIndices(), SMOOTH[0]], (99.0, 2), "unknown", id="as many"),
        pytest.param([InertiaByIndices(), SMOOTH[0]], (99.0, 3), "inertia", id="it takes more"),
        pytest.param([InertiaByIndices(), SMOOTH[0]], (100.0, 1), "inertia", id="no less"),
        pytest.param([InertiaByIndices(), SMOOTH[0]], (50.0, 0), "inertia", id="nothing alone"),
        pytest.param([InertiaByIndices()], (99.0, 1), "inertia", id="nothing beside it"),
        pytest.param([InertiaByContact(), SMOOTH[0]], (99.0, 1), "inertia", id="contact forces"),
    ],
)
def test_it_stands_by_what_it_does_for_itself(monkeypatch, effects, alone, expected):
    found, (cost, count) = explanation(100.0, *effects), alone
    smooth = explanation(cost, *SMOOTH[:count])
    left, refused = stood(monkeypatch, found, smooth, "")
    assert left.effects[0].name == expected
    why = "a smooth function of curvature explains more in its place"
    assert refused == ({"inertia": why} if expected == "unknown" else {})


@pytest.mark.parametrize("name", [InertiaByIndices(), InertiaByContact()])
def test_it_does_not_stand_where_others_would_as_well(monkeypatch, name):
    """Whatever the smooth functions alone cost."""
    smooth = explanation(200.0, *SMOOTH)
    left, refused = stood(monkeypatch, explanation(100.0, name, SMOOTH[0]), smooth, "others would")
    assert left.names == smooth.names
    assert refused == {"inertia": "others would"}
    left, _ = stood(monkeypatch, explanation(100.0, name), smooth, "others would")
    assert left.names == ("inertia",)


def test_nothing_is_unknown_beside_names_that_leave_no_gap(monkeypatch):
    """Others equal them, and are listed; a smooth function follows what is rougher there."""
    found = explanation(100.0, InertiaByIndices(), SMOOTH[0])
    by_names = explanation(110.0, InertiaByIndices())
    left, refused = stood(monkeypatch, found, explanation(90.0), "others would", by_names)
    assert left.names == ("inertia",)
    assert not refused
