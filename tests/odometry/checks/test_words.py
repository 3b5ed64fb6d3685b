"""Sentences that a reader can follow: nothing said twice, places in words instead of signs."""

from types import SimpleNamespace

import pytest

from odometry.checks.findings.unit_tables import Unit, tread_units
from odometry.checks.poses.far_sensor import _place
from odometry.checks.units.unit_findings import tread_unit


def causes(unit, radius_m):
    """What is said of treads in a unit, one by one."""
    run = SimpleNamespace(
        robot=SimpleNamespace(wheel_radius=radius_m), odometry=None, folder=None, name="r"
    )
    evidence = SimpleNamespace(run=run, period_s=0.05, fastest_m_s=3.0)
    cause = tread_unit("the robot moves", unit, evidence).cause
    assert cause.count("these cannot be distinguished") == (cause.count("; or ") > 0)
    return cause.removesuffix(": these cannot be distinguished").split("; or ")


@pytest.mark.parametrize("words", ["miles per hour", "km/h", "feet per second"])
def test_a_unit_is_named_once(words):
    (unit,) = (unit for unit in tread_units(None) if unit.words == words)
    said = causes(unit, None)
    assert len(set(said)) == len(said)
    assert sum(words in one for one in said) == 1


@pytest.mark.parametrize(
    ("radius_m", "factor", "first"),
    [
        (0.3, 3.28, "in rad/s (of wheels of 0.3 m radius)"),
        (0.3, 3.6, "in rad/s (of wheels of 0.3 m radius)"),
        (0.3, 2.237, "twice too large (the diameter"),
        (0.5, 2.237, "in rad/s (of wheels of 0.5 m radius)"),
        (0.0955, 100.0, "in RPM (of wheels of 0.0955 m radius)"),
        (None, 2.237, "twice too large (the diameter"),
        (None, 3.28, "in km/h"),
        (None, 100.0, "in cm/s"),
        (None, 1000.0, "in mm/s"),
    ],
)
def test_the_likelier_of_equal_units_comes_first(radius_m, factor, first):
    """Wheels whose radius is stated, then their diameter; miles and feet last."""
    said = causes(Unit("of this name", factor), radius_m)
    assert said[0].startswith(f"Tread speeds are {first}")
    rare = [place for place, one in enumerate(said) if "mile" in one or "feet" in one]
    assert rare in ([], [len(said) - 3])  # before the gear ratio and the scale of positions
    assert (said[-1] == "right, and positions are scaled (a web map)") == (factor < 4)


def test_a_place_is_said_in_words():
    assert _place(0.03, -2.52) == "0.03 m ahead of and 2.52 m to the right of"
    assert _place(-1.0, 0.5) == "1.00 m behind and 0.50 m to the left of"
