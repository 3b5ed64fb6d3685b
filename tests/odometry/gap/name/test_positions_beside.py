"""Positions beside names that are judged by headings, or by what a gyroscope reports."""

import numpy as np
import pytest

from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.gyroscope_error import GyroscopeError
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.config import GapConfig
from odometry.gap.name.verdict import closes_held_out
from odometry.gap.prepare.pieces import numbered_pieces
from odometry.gap.prepare.statistic import Gap, Measure

CONFIG = GapConfig()


@pytest.fixture
def reason_by(make_scene, monkeypatch):
    """Why an effect does not stand whose measure falls by half, beside positions that rise."""

    def reason(measure, effect, rise, scatter=0.0):
        scene = make_scene(4)
        to_and_fro = scatter * (-1.0) ** numbered_pieces([scene], CONFIG.part_s)
        errors = {
            measure: {"before": 0.1, "after": 0.05},
            Measure.POSITION: {"before": 0.1, "after": 0.1 * (1 + rise + to_and_fro)},
        }

        def errors_of(stage, _, scene, measure):
            return np.zeros(len(scene)) + errors[measure][stage] ** 2

        monkeypatch.setattr("odometry.gap.name.verdict.squared_errors", errors_of)
        before, after = ("before", ()), ("after", (Added(effect, np.array([])),))
        floor = Gap(0.02, 0.015, 0.025, measure=measure)
        return closes_held_out(before, after, [scene], floor, CONFIG)

    return reason


@pytest.mark.parametrize(
    ("rise", "scatter", "stands"),
    [(0.005, 0.0, True), (0.03, 0.0, False), (0.03, 0.2, True), (0.12, 0.2, False)],
)
def test_positions_may_not_rise_surely_where_headings_are_judged(reason_by, rise, scatter, stands):
    """Headings that fall by half, beside positions that rise, alike or here more and there less."""
    reason = reason_by(Measure.HEADING, TractionLoss(), rise, scatter)
    assert (reason == "") == stands
    assert stands or reason.startswith("the gap on held-out data gets worse")


def test_positions_that_the_base_moves_do_not_refuse_a_fault_of_the_gyroscope(reason_by):
    """It moves no position: the base fits the measured runs a little better, others less."""
    assert reason_by(Measure.GYROSCOPE, GyroscopeError(), 0.12) == ""
    assert reason_by(Measure.GYROSCOPE, TractionLoss(), 0.12)
