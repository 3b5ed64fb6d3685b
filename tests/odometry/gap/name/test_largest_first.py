"""The verdict is the effect without which most of the gap comes back, not that of most evidence."""

from types import SimpleNamespace

import pytest

from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.motion.lateral_skid import LateralSkid
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.name.names import _largest_first
from odometry.gap.name.search import _beside
from odometry.gap.prepare.statistic import Measure

LATE, SKID = TimeOffset(), LateralSkid()
FUNCTION = Residual("speed", (("v_x", 0), ("v_x", 1)), "v_x", (0.0, 1.0))


def ordered(monkeypatch, effects, gap_without, evidence=100.0):
    """The order in which effects are put, where a gap comes back without each.

    The new first one has so much evidence by itself.
    """

    def gap_of(_, added, *__):
        return gap_without[next(one for one in gap_without if one not in added)]

    monkeypatch.setattr("odometry.gap.name.names.root_mean_square", gap_of)
    measured = SimpleNamespace(scenes=())
    search = SimpleNamespace(
        fitter=SimpleNamespace(
            measured=measured, fit=lambda of, _: SimpleNamespace(base=None, effects=of)
        ),
        floor=SimpleNamespace(measure=Measure.POSITION),
        config=GapConfig(),
        in_order=lambda _, order: SimpleNamespace(
            effects=tuple(order), steps=[SimpleNamespace(evidence=evidence)]
        ),
    )
    found = SimpleNamespace(effects=tuple(effects), fitted=SimpleNamespace(effects=()))
    return _largest_first(search, found).effects


@pytest.mark.parametrize(
    ("without_late", "without_skid", "first"), [(0.03, 0.18, SKID), (0.18, 0.03, LATE)]
)
def test_most_of_the_gap_decides(monkeypatch, without_late, without_skid, first):
    gaps = {LATE: without_late, SKID: without_skid}
    assert ordered(monkeypatch, [LATE, SKID], gaps)[0] is first


def test_what_does_nothing_by_itself_is_not_first(monkeypatch):
    gaps = {LATE: 0.03, SKID: 0.18}
    assert ordered(monkeypatch, [LATE, SKID], gaps, evidence=-38.0)[0] is LATE


def test_what_does_nothing_by_itself_is_no_second_name():
    first = [
        SimpleNamespace(effect=effect, evidence=evidence)
        for effect, evidence in ((SKID, 237.0), (LATE, -38.0))
    ]
    found = SimpleNamespace(first=first, names=(SKID.name,))
    assert _beside(found, [SKID, LATE]) == []
    first[1].evidence = 5.0
    assert _beside(found, [SKID, LATE]) == [LATE]
    found.first = ()
    assert _beside(found, [SKID, LATE]) == [LATE]


def test_one_name_and_smooth_functions_stay_as_they_are(monkeypatch):
    gaps = {LATE: 0.0, SKID: 1.0}
    assert ordered(monkeypatch, [LATE], gaps) == (LATE,)
    assert ordered(monkeypatch, [LATE, FUNCTION], gaps) == (LATE, FUNCTION)
