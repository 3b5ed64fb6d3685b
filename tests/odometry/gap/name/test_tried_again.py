"""A name of contact forces that a smooth function displaced is asked again on held-out data."""

from types import SimpleNamespace

import pytest

from odometry.effects.motion.contact_effects import SlopeByContact
from odometry.effects.motion.slope_icr import SlopeByIcr
from odometry.effects.unknown.residual import Residual
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.names import _tried_again

SMOOTH = Residual("speed", (("v_x", 0),), "", (0.0, 1.0))


def explanation(*effects):
    steps = tuple(SimpleNamespace(effect=one, fitted=None) for one in effects)
    return Explanation(None, steps, ())


@pytest.mark.parametrize(
    ("named", "stood", "stands", "less", "expected"),
    [
        pytest.param([SlopeByContact()], [], True, False, "again", id="nothing stood"),
        pytest.param([SlopeByContact()], [SMOOTH], True, False, "again", id="closes more"),
        pytest.param([SlopeByContact()], [SMOOTH], True, True, "stood", id="closes less"),
        pytest.param([SlopeByContact()], [SMOOTH], False, False, "stood", id="does not stand"),
        pytest.param([SlopeByIcr()], [SMOOTH], True, False, "stood", id="no contact forces"),
        pytest.param([SlopeByContact()], [SlopeByIcr()], True, False, "stood", id="another name"),
    ],
)
def test_it_is_named_where_it_stands_and_closes_no_less(
    monkeypatch, *, named, stood, stands, less, expected
):
    monkeypatch.setattr("odometry.gap.name.names.closes_less", lambda *_: less)
    names, before = explanation(*named), explanation(*stood)
    search = SimpleNamespace(that_stand=lambda found, _: found if stands else explanation(SMOOTH))
    found = _tried_again(search, names, before, ())
    assert found is {"again": names, "stood": before}[expected]
