"""Sentences that a reader can follow: nothing said twice, places in words instead of signs."""

from types import SimpleNamespace

import pytest

from odometry.checks.poses import _place
from odometry.checks.unit_findings import tread_unit
from odometry.checks.unit_tables import tread_units


@pytest.mark.parametrize("words", ["miles per hour", "km/h", "feet per second"])
def test_a_unit_is_named_once(words):
    (unit,) = (unit for unit in tread_units(None) if unit.words == words)
    run = SimpleNamespace(
        robot=SimpleNamespace(wheel_radius=None), odometry=None, folder=None, name="r"
    )
    evidence = SimpleNamespace(run=run, period_s=0.05, fastest_m_s=3.0)
    cause = tread_unit("the robot moves", unit, evidence).cause
    assert cause.startswith(f"Tread speeds are in {words}, not m/s; ")
    assert cause.count(words) == 1


def test_a_place_is_said_in_words():
    assert _place(0.03, -2.52) == "0.03 m ahead of and 2.52 m to the right of"
    assert _place(-1.0, 0.5) == "1.00 m behind and 0.50 m to the left of"
