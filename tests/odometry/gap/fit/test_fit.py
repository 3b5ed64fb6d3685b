"""Fits of effects beside the base, and what they leave on windows not fitted."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.sensor_mount import LeverArm
from odometry.effects.measurement.time_offset import TimeOffset
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import judge, penalty
from odometry.gap.fit.fitter import Fitter
from odometry.gap.prepare.measured import Measured, measured_of
from odometry.gap.prepare.statistic import gap_of
from odometry.gap.prepare.uncertain_base import Uncertain

CONFIG = GapConfig()
FACTORS = np.array([0.9, 1.05])


def scaled(columns, twist):  # noqa: ARG001 - of the face of effects
    """The treads move by other factors than recorded; true ICRs at 0.45, -0.42 and 0.02."""
    left, right = FACTORS[0] * columns["v_left"], FACTORS[1] * columns["v_right"]
    omega = (right - left) / 0.87
    return np.column_stack([(right * 0.45 + left * 0.42) / 0.87, -0.02 * omega, omega])


@pytest.fixture(scope="module")
def scenes(make_scene):
    return (make_scene(70, scaled, duration_s=100.0), make_scene(71, scaled, duration_s=60.0))


@pytest.fixture(scope="module")
def open_base(known):
    """A calibration that has the ICRs to a centimetre or two and the factors to a percent."""
    free = np.ones(5, dtype=bool)
    information = np.diag(1 / np.square([0.015, 0.015, 0.02, 0.01, 0.01, 0.01]))
    return replace(
        known,
        uncertain=Uncertain(known.base, free, latency_is_free=True),
        information=information,
    )


@pytest.fixture(scope="module")
def fitter(scenes, open_base):
    return Fitter(open_base, measured_of(scenes, open_base, CONFIG))


@pytest.fixture(scope="module")
def sure(scenes, known):
    return Fitter(known, measured_of(scenes, known, CONFIG))


def test_the_same_fit_is_searched_once(fitter):
    """The effect itself, its start and what is pinned decide; an equal effect is another."""
    scale = WheelScale()
    once = fitter.fit([scale])
    assert fitter.fit([scale]) is once
    elsewhere = Added(scale, 2 * once.effects[0].values - 1)
    for other in (
        fitter.fit([WheelScale()]),
        fitter.fit([scale], once.effects),
        fitter.fit([scale], [elsewhere]),
        fitter.fit([scale], once.effects, pin_slow=True),
    ):
        assert other is not once
        np.testing.assert_allclose(other.effects[0].values, once.effects[0].values, atol=1e-3)


def test_planted_values_are_found_within_their_own_covariance(sure):
    fit = sure.fit([WheelScale()])
    (added,) = fit.effects
    off = added.values - FACTORS
    assert off @ np.linalg.solve(fit.covariance, off) < 13.8  # 99.9 % of chi-squared of two
    assert (np.sqrt(np.diag(fit.covariance)) < 0.005).all()
    assert sure.spread(fit) == pytest.approx(1.0, abs=0.05)
    assert fit.base_moved == 0.0
    assert fit.freedom == 2


def test_the_base_moves_only_as_far_as_its_calibration_lets_it(fitter, sure, open_base):
    """The information of the calibration counts as rows; without it the slip would take all."""
    alone = fitter.fit([])
    moved = np.append(alone.base.values, alone.base.latency_s) - open_base.uncertain.values
    prior = moved @ open_base.information @ moved
    assert alone.base_moved == pytest.approx(prior, rel=1e-6)
    assert alone.base_moved > 50.0
    assert sure.fit([]).base_moved == 0.0
    with_effect = fitter.fit([WheelScale()])
    assert with_effect.base_moved < 10.0
    assert with_effect.chi_squared.sum() < alone.chi_squared.sum()


def test_one_newton_step_agrees_with_an_honest_refit(fitter, scenes, open_base):
    """Each fold by a fit that never saw it."""
    fit = fitter.fit([WheelScale()])
    measured = fitter.measured
    honest = np.zeros_like(fit.held_out)
    ends = np.cumsum([0, *map(len, scenes)])
    for fold in range(CONFIG.folds):
        kept = [measured.folds[a:b] != fold for a, b in itertools.pairwise(ends)]
        others = Measured(
            tuple(s.where(k) for s, k in zip(scenes, kept, strict=True)),
            tuple(w[k] for w, k in zip(measured.whiteners, kept, strict=True)),
            measured.folds[measured.folds != fold],
            measured.pieces[measured.folds != fold],
        )
        refit = Fitter(open_base, others).fit([WheelScale()])
        judged = measured.by_window(measured.rows(refit.base, refit.effects))
        honest[measured.folds == fold] = judged[measured.folds == fold]
    optimism = honest.sum() - fit.chi_squared.sum()
    assert optimism > 2.0
    assert fit.held_out.sum() - fit.chi_squared.sum() == pytest.approx(optimism, rel=0.1)
    np.testing.assert_allclose(fit.held_out, honest, atol=0.2, rtol=0.02)


def test_pieces_are_dealt_to_folds_and_none_is_cut(fitter, scenes):
    measured = fitter.measured
    for piece in np.unique(measured.pieces):
        assert len(set(measured.folds[measured.pieces == piece])) == 1
    assert set(measured.folds) == set(range(CONFIG.folds))
    assert len(np.unique(measured.pieces)) == 16
    assert len(measured.folds) == sum(map(len, scenes))


def test_rows_and_windows_belong_together(sure, scenes, known):
    rows = sure.measured.rows(known.base, ())
    found = sure.measured.by_window(rows)
    sizes = [scene.measured[0].size for scene in scenes]
    expected = [
        (part.reshape(len(scene), -1) ** 2).sum(axis=1)
        for scene, part in zip(scenes, np.split(rows, [len(scenes[0]) * sizes[0]]), strict=True)
    ]
    np.testing.assert_allclose(found, np.concatenate(expected))


def test_known_values_start_a_fit_and_those_of_slow_effects_stay(sure):
    class Slow(LeverArm):
        slow = True

    there = Added(Slow(), np.array([0.1, -0.1]))
    held = sure.fit([there.effect, WheelScale()], [there], pin_slow=True)
    np.testing.assert_array_equal(held.effects[0].values, there.values)
    np.testing.assert_array_equal(held.covariance[:2], 0.0)
    free = sure.fit([there.effect, WheelScale()], [there])
    np.testing.assert_allclose(free.effects[0].values, 0.0, atol=0.01)
    assert free.chi_squared.sum() < held.chi_squared.sum()


def test_evidence_is_the_held_out_gain_less_the_penalty(fitter):
    """Factors are worth a name, an offset of time of next to nothing is not."""
    before = fitter.fit([])
    counted = []
    first, second = judge(
        fitter, before, [TimeOffset(), WheelScale()], CONFIG, lambda: counted.append(1)
    )
    assert (first.effect.name, second.effect.name) == ("wheel_scale", "time_offset")
    assert len(counted) == 2
    gain = (before.held_out - first.fitted.held_out).sum()
    gain += before.base_moved - first.fitted.base_moved
    assert first.gain == pytest.approx(gain)
    spread = max(1.0, first.fitted.held_out.sum() / len(fitter.measured.window_of_row))
    paid = 2 * np.log(len(before.held_out))
    assert penalty(2, before) == pytest.approx(paid)
    assert first.evidence == pytest.approx(gain / spread - paid)
    assert first.least < first.evidence
    fit = first.fitted
    gap = gap_of(fit.base, fit.effects, fitter.measured.scenes, CONFIG.part_s)
    assert first.gap_after == gap.value
