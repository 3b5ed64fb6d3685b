"""An unknown part of the motion that comes and goes in run time, in each run by its own."""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import FloatArray
from odometry.effects.unknown.residual import TREADS, WORLD, Residual
from odometry.effects.unknown.residual_of_each_run import ResidualOfEachRun
from odometry.gap.config import GapConfig
from odometry.gap.fit.contest import Judged
from odometry.gap.fit.fitter import Fitted, Fitter
from odometry.gap.fit.own_values import PARITIES, by_turns, with_values_of_each_run
from odometry.gap.prepare.measured import Measured, at_fewer_poses
from odometry.gap.prepare.responses import Responses, columns_of, simulated_scenes
from odometry.gap.prepare.statistic import gap_m, sure_sum
from odometry.windows.dense.dense import DenseWindows

ADDED_TO = (  # components, and what they grow with
    *((TREADS, "speed"), (("left",), "speed"), (("right",), "speed"), (("v_x",), "v_x")),
    *((("omega",), "omega"), (("omega",), ""), (WORLD, ""), (("v_x", "v_y"), "")),
    (("v_y",), "omega"),
)
SPACINGS_S = (2.0, 4.0, 8.0)  # of knots, of windows of 2 s by turns
MOST_KNOTS = 100
SPREADS = (0.03, 0.1, 0.3)  # of coefficients: shares, m/s, rad/s
CHOSEN = 3  # what is added to, spacing and spread: each pays as a parameter
POSES = 10  # of a window, where the course is chosen


def best_course(
    fitter: Fitter, before: Fitted, held_out: Sequence[DenseWindows], config: GapConfig
) -> Judged | None:
    """The course that windows show best of those that they take turns with; None where none does.

    Windows of 2 s by turns: what lasts shorter than about two of them is not detected.
    """
    coarse = at_fewer_poses(fitter.measured, fitter.calibration, POSES)
    rows = coarse.rows(before.base, before.effects)
    simulated = simulated_scenes(before.base, before.effects, coarse.scenes)
    lasts_s = max(float(s.pose_s[-1]) for s in (*fitter.measured.scenes, *held_out))
    tried = [
        (loss, effect)
        for effects in _candidates(lasts_s, len(coarse.scenes))
        for loss, effect in _losses(coarse, simulated, effects, rows)
    ]
    loss, effect = min(tried, key=lambda one: one[0])
    if loss >= float(rows @ rows):
        return None
    return _judged(fitter, before, effect, config)


def _candidates(lasts_s: float, runs: int) -> list[list[ResidualOfEachRun]]:
    """Those that differ in their spread alone go together."""
    found = []
    for spacing_s in SPACINGS_S:
        count = int(np.clip(np.ceil(lasts_s / spacing_s), 1, MOST_KNOTS)) + 1
        knots = tuple(np.linspace(0.0, max(lasts_s, spacing_s), count).tolist())
        for components, by in ADDED_TO:
            terms = tuple((component, k) for component in components for k in range(count))
            found.append(
                [
                    ResidualOfEachRun("time", terms, by, knots, runs=runs, spread=spread)
                    for spread in SPREADS
                ]
            )
    return found


def _losses(
    measured: Measured,
    simulated: Sequence[Responses],
    effects: Sequence[ResidualOfEachRun],
    rows: FloatArray,
) -> list[tuple[float, ResidualOfEachRun]]:
    """Of each run by itself: its coefficients do nothing to the others."""
    one = effects[0]
    of_a_run = Residual(one.variable, one.terms, one.by, one.knots)
    turn = np.asarray(measured.window_of_row % PARITIES)
    spreads = [effect.spread for effect in effects]
    losses, begin = np.zeros(len(effects)), 0
    for scene, white in zip(simulated, measured.whiteners, strict=True):
        jacobian = columns_of(of_a_run, [scene], [white])
        own = slice(begin, begin := begin + len(jacobian))
        left = by_turns(jacobian, rows[own], spreads, turn[own])
        losses += (left**2).sum(axis=-1)
    return list(zip(losses.tolist(), effects, strict=True))


def _judged(fitter: Fitter, before: Fitted, effect: ResidualOfEachRun, config: GapConfig) -> Judged:
    fit = with_values_of_each_run(fitter, before, effect)
    gains = before.chi_squared - fit.held_out
    spread = max(1.0, float(fit.held_out.sum()) / fitter.measured.expected)
    paid = CHOSEN * float(np.log(len(fit.held_out)))
    gain = float(gains.sum())
    least = sure_sum(fitter.by_piece(gains), config.trimmed)
    after = gap_m(fit.base, fit.effects, fitter.measured.scenes)
    return Judged(effect, fit, gain, gain / spread - paid, least / spread - paid, after)
