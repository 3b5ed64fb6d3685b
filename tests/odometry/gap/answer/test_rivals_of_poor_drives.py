"""What one sort of drive cannot distinguish is listed as equivalent to the first name."""

from pathlib import Path

import numpy as np
import pytest

from odometry.gap.answer.equivalent import equivalents, rivals_of_one_heading
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import cost_of, judge
from odometry.gap.fit.fitter import Fitter
from odometry.gap.fit.input_noise import noise_of_windows, noisier, surely_dearer, tread_noise_m_s
from odometry.gap.name.candidates import quick_effects
from odometry.gap.name.explanation import Explanation
from odometry.gap.name.general import knots_of_variables, shares_of_motion
from odometry.gap.prepare.measured import measured_of
from odometry.recording.run import Run
from odometry.windows.dense.averaged import averaged_windows
from odometry.windows.dense.dense import dense_windows_of
from tests.odometry.conftest import PERIOD_S, ROBOT, integrated, table

CONFIG = GapConfig()
NOISE_M_S = 0.004
KEPT = 0.96


def straight(seed, speeds_m_s, *, kept=KEPT, yaw_error_rad=0.0, noise_m_s=NOISE_M_S, turned=0.0):
    """Windows of a drive ahead of which a share is lost, with noise of the encoders.

    `turned` [m/s] is recorded as half of a difference of the treads that the robot does not follow.
    """
    rng = np.random.default_rng(seed)
    t = PERIOD_S * np.arange(len(speeds_m_s))
    twist = np.column_stack([kept * speeds_m_s, 0 * t, 0 * t])
    x, y, yaw = (integrated(twist) + rng.normal(size=(len(t), 3)) * [0.01, 0.01, 0.004])[::4].T
    treads = speeds_m_s + noise_m_s * rng.standard_normal((2, len(t)))
    treads += np.array([[-1.0], [1.0]]) * turned
    level = {"roll": 0 * t, "pitch": 0 * t}
    columns = {"t": t, "v_left": treads[0], "v_right": treads[1], **level}
    pose = {"t": t[::4], "x": x, "y": y, "yaw": yaw + yaw_error_rad}
    run = Run(Path("straight"), ROBOT, {}, table(columns), table(pose))
    return averaged_windows(dense_windows_of(run, CONFIG.horizon_s))


def at_one_speed(seed):
    return straight(seed, np.full(1800, 0.8))


def at_many_speeds(seed):
    t = PERIOD_S * np.arange(1800)
    return straight(seed, 0.8 * (1 - np.cos(t)) / 2)


def asked(scene, known, *names):
    """Names that may be true: the first, and those beside it."""
    effects = [one for one in quick_effects([scene], known) if one.name in names]
    fitter = Fitter(known, measured_of([scene], known, CONFIG))
    before = fitter.fit([])
    candidates = judge(fitter, before, effects, CONFIG, lambda: None)
    first = candidates[0]
    found = Explanation(before, (first,), tuple(candidates), {first.effect.name: tuple(candidates)})
    more = rivals_of_one_heading(found, fitter, CONFIG)
    others = equivalents(found, more, fitter, CONFIG)
    return first.effect.name, {one.name for one in others}


LIMIT = ("drive_limit", "saturation", "")
LOSSES = ("drive_limit", "tread_slip", "wheel_scale")


def test_at_one_speed_a_loss_has_many_names(known):
    """A limit keeps the noise of the encoders out, and has more evidence than what is true."""
    first, others = asked(at_one_speed(3), known, *LOSSES)
    assert {first, *others} >= {"drive_limit", "tread_slip", "wheel_scale", "reference_fault"}


def test_at_many_speeds_it_has_one(known):
    first, others = asked(at_many_speeds(3), known, *LOSSES)
    assert first == "wheel_scale"
    assert "drive_limit" not in others


def test_on_one_heading_a_yaw_that_is_off_may_be_the_compass(known):
    t = PERIOD_S * np.arange(1800)
    scene = straight(5, 0.8 * (1 - np.cos(t)) / 2, kept=1.0, yaw_error_rad=0.06)
    first, others = asked(scene, known, "heading_offset", "wheel_scale")
    assert first == "heading_offset"
    assert "reference_fault" in others


def test_noise_of_the_treads_is_that_of_third_differences():
    scene = at_many_speeds(1)
    assert tread_noise_m_s(scene.run) == pytest.approx([NOISE_M_S, NOISE_M_S], rel=0.1)


def test_chi_squared_of_noise_is_what_the_same_noise_again_makes(known):
    """Of runs that differ by the noise of the treads alone, the mean of many draws."""
    scene = at_one_speed(1)
    measured = measured_of([scene], known, CONFIG)
    fit = Fitter(known, measured).fit([])
    (of_windows,) = noise_of_windows([fit], measured)
    rng = np.random.default_rng(7)
    clean = measured.rows(fit.base, ())
    drawn = []
    for _ in range(40):
        again = measured_of([noisier(scene, rng)], known, CONFIG)
        drawn.append(np.sum((again.rows(fit.base, ()) - clean) ** 2))
    assert of_windows.sum() == pytest.approx(np.mean(drawn), rel=0.3)


def test_a_limit_keeps_the_noise_out(known):
    measured = measured_of([at_one_speed(1)], known, CONFIG)
    fitter = Fitter(known, measured)
    limit = next(e for e in quick_effects(measured.scenes, known) if e.key == LIMIT)
    base, limited = noise_of_windows([fitter.fit([]), fitter.fit([limit])], measured)
    assert limited.sum() < 0.1 * base.sum()


def costs_more(scene, known):
    """By how much wheels cost more than a share by the difference of the speeds, both ways."""
    fitter = Fitter(known, measured_of([scene], known, CONFIG))
    wheels = next(e for e in quick_effects([scene], known) if e.name == "wheel_scale")
    shares = shares_of_motion([scene], known.base, CONFIG)
    share = next(e for e in shares if e.variable == "speed_difference" and e.by == "speed")
    fits = fitter.fit([wheels]), fitter.fit([share])
    costs = [cost_of(fit) for fit in fits]
    return costs[0] - costs[1], surely_dearer(*fits, fitter.measured)


def test_a_function_that_follows_the_noise_of_the_treads_is_no_better(known):
    """The robot drives straight whatever the encoders say of the difference of its treads."""
    plain, apart = costs_more(straight(4, np.full(1800, 0.8), noise_m_s=0.02), known)
    assert plain > CONFIG.general_margin
    assert apart < CONFIG.general_margin


def test_a_function_that_is_true_stays_better(known):
    """A share that is lost by turns differs with the difference that the treads then have."""
    t = PERIOD_S * np.arange(1800)
    turned = np.where(t % 20 < 10, 0.05, -0.05)
    kept = np.where(turned > 0, 0.9, 1.0)
    plain, apart = costs_more(straight(4, np.full(1800, 0.8), kept=kept, turned=turned), known)
    assert plain > apart > 100


def test_on_one_straight_nothing_follows_the_heading(known):
    """Where each window begins, its measured heading is off by the noise of its turn."""
    all_round = [scene for _, scene in known.held_back]
    assert "heading" not in knots_of_variables([at_one_speed(1)], known.base, CONFIG)
    assert "heading" in knots_of_variables(all_round, known.base, CONFIG)
