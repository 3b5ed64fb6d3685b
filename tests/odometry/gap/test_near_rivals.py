"""A name beside something unknown, where others come as near."""

import numpy as np
import pytest

from odometry.effects.measurement.sensor_mount import HeadingOffset
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.name import near_rivals
from odometry.gap.name.near_rivals import undecided
from tests.odometry.gap.test_equivalent import PIECES, Alone, explained_by, judged

SMOOTH = Residual("speed", (("v_x", 0),), "", (0.0, 1.0))


@pytest.mark.parametrize(("evidence", "decided"), [(93.0, True), (95.0, False)])
def test_a_name_is_not_decided_where_another_is_as_near(monkeypatch, evidence, decided):
    silent = np.zeros(PIECES)
    monkeypatch.setattr(near_rivals, "noise_of_windows", lambda fits, _: [silent for _ in fits])
    first, rival = judged(TimeOffset(), 100.0, 104.0), judged(HeadingOffset(), evidence, 103.0)
    found = explained_by(first, rival).with_step(judged(SMOOTH, 50.0, 60.0))
    reason = undecided(found, Alone(), GapConfig())
    others = "heading_offset would explain as much, and something unknown is left beside each"
    assert reason == ("" if decided else others)
