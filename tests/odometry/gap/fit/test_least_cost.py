"""Searches from many starts: those that cannot be among the best are not begun."""

import numpy as np
import pytest

from odometry.effects.commands.drive_limit import Deadband
from odometry.effects.interface.in_course import in_course
from odometry.effects.interface.time_course import FromAMoment
from odometry.effects.motion.traction_loss import TractionLoss
from odometry.gap.config import GapConfig
from odometry.gap.fit import least_cost as module
from odometry.gap.fit.hypothesis import Hypothesis
from odometry.gap.fit.least_cost import least_cost
from odometry.gap.prepare.measured import measured_of

LASTS_S, MOMENT_S = 60.0, 31.0
LOSS = in_course(TractionLoss(), FromAMoment(((2.0, LASTS_S - 2.0),)))


@pytest.fixture(scope="module")
def measured(make_scene, known):
    def planted(columns, twist):
        lost = np.where(columns["t"] > MOMENT_S, 0.8, 1.0)
        return twist * lost[:, None]

    return measured_of((make_scene(12, planted, duration_s=LASTS_S),), known, GapConfig())


def starts_of(effect, measured, known):
    inputs = measured.scenes[0].inputs
    own = effect.starts(inputs, known.base)
    return [np.concatenate([known.uncertain.values, one]) for one in own]


def test_costs_to_first_order_are_those_of_least_squares(measured, known):
    hypothesis = Hypothesis(known, measured, (LOSS,))
    starts = starts_of(LOSS, measured, known)
    held = np.arange(len(starts[0])) < hypothesis.of_base
    found = hypothesis.first_order_costs(starts, held)
    for start, cost in list(zip(starts, found, strict=True))[::5]:
        rows = hypothesis.rows(start)
        jacobian = hypothesis.derivative(
            hypothesis.rows, start, rows, hypothesis.scales, hypothesis.bounds
        )[:, ~(held | hypothesis.shapes)]
        step = np.linalg.lstsq(jacobian, -rows, rcond=None)[0]
        assert cost == pytest.approx(np.sum((rows + jacobian @ step) ** 2))
    moments = [start[-1] for start in starts]
    assert abs(moments[int(np.argmin(found))] - MOMENT_S) < 4.0


def searched(hypothesis, starts, monkeypatch):
    """Values found, and from how many starts a step was taken."""
    begun = []
    search = module._search
    monkeypatch.setattr(module, "_search", lambda *a: begun.append(a[2]) or search(*a))
    held = np.zeros(len(starts[0]), dtype=np.bool_)
    return least_cost(hypothesis, starts, held, held), begun.count(1)


def test_many_moments_lead_where_all_of_them_do(measured, known, monkeypatch):
    hypothesis, starts = Hypothesis(known, measured, (LOSS,)), starts_of(LOSS, measured, known)
    few, steps = searched(hypothesis, starts, monkeypatch)
    monkeypatch.setattr(module, "PROMISING", len(starts))
    every, steps_of_all = searched(hypothesis, starts, monkeypatch)
    assert (steps, steps_of_all) == (8, len(starts))
    np.testing.assert_array_equal(few.values, every.values)
    assert few.values[-1] == pytest.approx(MOMENT_S, abs=0.2)


def test_starts_that_differ_in_what_they_do_are_all_begun(measured, known):
    effect = Deadband()
    hypothesis, starts = Hypothesis(known, measured, (effect,)), starts_of(effect, measured, known)
    assert module._promising(hypothesis, starts, np.zeros(len(starts[0]), bool)) is starts
