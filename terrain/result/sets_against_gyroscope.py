"""Whether a gyroscope agrees with the parameters of the terrains, where no yaw was measured.

The filter's own ICRs at the end of a run follow the last turns, and say less of the whole.
"""

from collections.abc import Sequence

import numpy as np

from odometry.arrays import AnyArray, FloatArray, IntArray
from odometry.effects.tables import model_of
from odometry.parameters import TerrainParameters
from odometry.recording.run import Run
from odometry.recording.sensors import YawRate
from odometry.windows.recorded.run_inputs import inputs_of
from odometry.windows.travel.motion_ratios import (
    FEWEST_WINDOWS,
    HORIZON_M,
    LEAST_TURN_RAD,
    MotionRatios,
)
from terrain.result.run_result import RunResult
from terrain.result.sets_against_poses import SetAgainstPoses

LONGEST_S = 20.0  # of a window: a bias of the gyroscope turns longer ones by too much
MOST = 6.0  # times as far, or less far: beyond, the gyroscope has another unit, or sign


def sets_against_gyroscope(result: RunResult) -> list[SetAgainstPoses]:
    """Turns on each terrain of the parameter set that was in force for long enough.

    `turn` is NaN where a bias of the gyroscope might be the reason.
    """
    rates = result.run.yaw_rate
    if rates is None or len(rates.stamps_s) < 2:
        return []
    run = result.run
    rows = np.searchsorted(result.replay.stamps_s, run.odometry.stamps_s, side="right") - 1
    names: AnyArray = np.array(result.replay.terrains, dtype=object)[np.maximum(rows, 0)]
    edges = _edges(run, rates)
    found = []
    for name, table in result.parameters.terrains.items():
        ends = _on(names == name, edges)
        if len(ends) >= FEWEST_WINDOWS:
            found.append(_compared(name, table, run, rates, ends))
    return found


def _edges(run: Run, rates: YawRate) -> IntArray:
    """Rows of odometry.csv, HORIZON_M of wheel travel apart, within the gyroscope's time."""
    stamps_s = run.odometry.stamps_s
    speeds_m_s = np.abs(run.odometry.stack("v_left", "v_right")).mean(axis=1)
    travel_m = np.append(0.0, np.cumsum(speeds_m_s[:-1] * np.diff(stamps_s)))
    edges = np.searchsorted(travel_m, np.arange(0.0, travel_m[-1], HORIZON_M))
    within = (stamps_s[edges] >= rates.stamps_s[0]) & (stamps_s[edges] <= rates.stamps_s[-1])
    return np.asarray(np.unique(edges[within]))


def _on(there: AnyArray, edges: IntArray) -> IntArray:
    """First and last rows (K, 2) of the windows that lie on one terrain alone."""
    counts = np.append(0, np.cumsum(there))
    ends = np.stack([edges[:-1], edges[1:]], axis=-1)
    whole = counts[ends[:, 1]] - counts[ends[:, 0]] == ends[:, 1] - ends[:, 0]
    return np.asarray(ends[whole])


def _compared(
    name: str, table: TerrainParameters, run: Run, rates: YawRate, ends: IntArray
) -> SetAgainstPoses:
    """Turns of the gyroscope over those that a terrain's parameters predict, in windows (K, 2)."""
    stamps_s = run.odometry.stamps_s
    lasts_s = np.diff(stamps_s[ends], axis=1)[:, 0]
    ends, lasts_s = ends[lasts_s < LONGEST_S], lasts_s[lasts_s < LONGEST_S]
    model = model_of(table, run.robot, f"terrain {name!r}")
    rates_rad_s = model.twist(model.pack(table.values), inputs_of(run))[:, 2]
    path_rad = np.append(0.0, np.cumsum(rates_rad_s[:-1] * np.diff(stamps_s)))
    predicted = np.diff(path_rad[ends], axis=1)[:, 0]
    middles = (rates.yaw_rate_rad_s[1:] + rates.yaw_rate_rad_s[:-1]) / 2
    turned_rad = np.append(0.0, np.cumsum(middles * np.diff(rates.stamps_s)))
    measured = np.diff(np.interp(stamps_s[ends], rates.stamps_s, turned_rad), axis=1)[:, 0]
    turn = turn_sd = float("nan")
    if len(ends) >= FEWEST_WINDOWS and np.sqrt(np.mean(predicted**2)) > LEAST_TURN_RAD:
        alone, beside_bias = (_ratio([predicted, *others], measured) for others in ([], [lasts_s]))
        both = np.array([alone[0], beside_bias[0]])
        same_side = np.prod(both - 1) > 0
        if same_side and (both > 1 / MOST).all() and (both < MOST).all():
            turn, turn_sd = min(alone, beside_bias, key=lambda of: abs(of[0] - 1))
    nan = float("nan")
    ratios = MotionRatios(turn, turn_sd, nan, nan)
    return SetAgainstPoses(name, len(ends), ratios, "gyroscope")


def _ratio(predicted: Sequence[FloatArray], measured: FloatArray) -> tuple[float, float]:
    """Factor of the first of `predicted` (each (K,)) in what was measured (K,), and its deviation.

    By least squares; the standard deviation by leaving out each window once (jackknife).
    """
    table = np.stack(predicted, axis=-1)
    squares = np.einsum("ki,kj->kij", table, table)
    products = table * measured[:, None]
    ratio = float((np.linalg.pinv(squares.sum(axis=0), hermitian=True) @ products.sum(axis=0))[0])
    others = np.linalg.pinv(squares.sum(axis=0) - squares, hermitian=True)
    left_out = np.einsum("kij,kj->ki", others, products.sum(axis=0) - products)[:, 0]
    return ratio, float(np.sqrt((len(measured) - 1) * np.var(left_out)))
