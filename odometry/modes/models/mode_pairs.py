"""Which modes predict the same motion: for how long two must be driven to be distinguished."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from odometry.arrays import FloatArray
from odometry.modes.models.traction import TractionModes, twists_of
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.modes_config import ModesConfig
from odometry.modes.recorded.bank_inputs import STANDING_M_S
from odometry.recording.run import Run

SURE = ModesConfig.sure  # of one of two modes that were as probable before
LOG_ODDS = float(np.log(SURE / (1 - SURE)))
TRIED_S = np.geomspace(0.01, 1e4, 601)


@dataclass(frozen=True)
class Pair:
    """Two modes, and the time of driving that distinguishes the second from the first [s]."""

    names: tuple[str, str]
    seconds: float


def pairs(modes: VelocityModes | TractionModes, runs: Sequence[Run]) -> tuple[Pair, ...]:
    """All pairs of modes, the most similar first.

    How long the treads must turn as in the runs until the log-odds of the right mode are expected
    to be those of SURE, if models and noise are as identified: the Kullback-Leibler divergence of
    what the modes predict, in the worse direction. Only what has settled counts.

    Parameters
    ----------
    modes : VelocityModes or TractionModes
    runs : sequence of Run
        Whose tread speeds are driven.
    """
    speeds = np.concatenate([run.odometry.stack("v_left", "v_right") for run in runs])
    step_s = float(np.median(np.concatenate([np.diff(run.odometry.stamps_s) for run in runs])))
    if isinstance(modes, VelocityModes):
        seconds = _velocity_seconds(modes, speeds, step_s)
    else:
        has_gyroscope = any(run.yaw_rate is not None for run in runs)
        seconds = _traction_seconds(modes, speeds, step_s if has_gyroscope else np.inf)
    seconds = np.maximum(seconds, seconds.T)
    found = [
        Pair((first, modes.names[j]), float(seconds[i, j]))
        for i, first in enumerate(modes.names)
        for j in range(i + 1, len(modes.names))
    ]
    return tuple(sorted(found, key=lambda pair: -pair.seconds))


def _velocity_seconds(modes: VelocityModes, speeds: FloatArray, step_s: float) -> FloatArray:
    """For row against column (M, M); no sooner than errors change, each such time counting once.

    By the yaw rate, and of modes of one model by noise, as in `track_checks.similar_modes`: where
    models differ, however little, noise is what a road or a recording may change as well. Never
    where yaw rates differ by less than those of one mode do from turn to turn.
    """
    gains, variances = modes.steady_gains()[:, 1], modes.measurement_variance
    apart = gains[:, None] - gains[None]
    one_model = (apart == 0).all(axis=-1)
    driven = speeds.T @ speeds / len(speeds)
    of_yaw = np.einsum("ija,ab,ijb->ij", apart, driven, apart)
    ratio = variances[:, None] / variances[None]
    of_noise = (ratio - 1 - np.log(ratio)).sum(axis=-1)
    divergence = np.where(one_model, of_noise, of_yaw / variances[None, :, 1]) / 2
    lasting = (ModesConfig.alike_sigmas * modes.lasting_share()) ** 2
    of_turns = lasting * np.einsum("ia,ab,ib->i", gains, driven, gains)
    alike = ~one_model & (of_yaw <= np.maximum(of_turns[:, None], of_turns))
    equal = (divergence <= 0) | alike
    once_s = max(modes.errors_last_s, step_s)
    needed = once_s * np.maximum(1.0, LOG_ODDS / np.where(equal, 1.0, divergence))
    return np.where(equal, np.inf, needed)


def _traction_seconds(modes: TractionModes, speeds: FloatArray, gyro_s: float) -> FloatArray:
    """The same, of a known pose, one measured later, and a yaw rate each `gyro_s` between."""
    driven = speeds[np.abs(speeds).mean(axis=1) > STANDING_M_S]
    if not len(driven):
        return np.full((len(modes.names), len(modes.names)), np.inf)
    twists = np.stack([twists_of(of, driven, modes.track_width) for of in modes.gains])
    squares = np.stack([((twists - of) ** 2).mean(axis=1) for of in twists])
    added = np.abs(driven).mean() * modes.process_variance[[0, 0, 1]]
    moved = squares[..., None, :] * TRIED_S[:, None] ** 2
    variances = added * TRIED_S[:, None] + modes.measurement_variance[:3]
    of_gyro = squares[..., 2:] / modes.measurement_variance[3] * TRIED_S / gyro_s
    log_odds = ((moved / variances).sum(axis=-1) + of_gyro) / 2
    separable = log_odds >= LOG_ODDS
    return np.where(separable.any(axis=-1), TRIED_S[separable.argmax(axis=-1)], np.inf)
