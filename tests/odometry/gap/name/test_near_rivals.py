"""A name beside something unknown, where others come as near."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.commands.late_treads import CommandDelay
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import HeadingOffset
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.effects.unknown.residual import Residual
from odometry.gap.config import GapConfig
from odometry.gap.name import near_rivals
from odometry.gap.name.near_rivals import as_near, undecided
from tests.odometry.gap.answer.test_equivalent import PIECES, Alone, explained_by, judged

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


@pytest.mark.parametrize(
    ("late_s", "period_s", "gain", "near"),
    [
        (0.2, 0.5, 850.0, ["command_delay"]),
        (0.6, 0.5, 850.0, []),
        (0.2, 0.5, 780.0, []),
        (0.2, None, 850.0, []),
    ],
)
def test_late_stamps_are_late_treads_within_a_period_of_the_gyroscope(
    monkeypatch, late_s, period_s, gain, near
):
    """Without one the evidence decides, and gates of their own."""
    silent = np.zeros(PIECES)
    monkeypatch.setattr(near_rivals, "noise_of_windows", lambda fits, _: [silent for _ in fits])
    monkeypatch.setattr(near_rivals, "gyroscope_of", lambda yaw_rate: yaw_rate)
    gyroscope = period_s and SimpleNamespace(stamps_s=period_s * np.arange(9))
    scene = SimpleNamespace(run=SimpleNamespace(yaw_rate=gyroscope), pose_s=np.arange(5.0))
    monkeypatch.setattr("odometry.gap.name.form_gates.run_of", lambda _: None)
    fitter = Alone()
    fitter.measured = SimpleNamespace(scenes=[scene])
    best, rival = judged(TimeOffset(), 996.0, 1000.0), judged(CommandDelay(), gain - 4, gain)
    best.fitted.effects = (Added(TimeOffset(), np.array([late_s])),)
    found = as_near(best, [best, rival], fitter, GapConfig())
    assert [one.effect.name for one in found] == near
