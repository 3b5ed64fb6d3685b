"""How far the turning centre of a traction mode is off on drives not identified from."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import nnls

from odometry.arrays import FloatArray
from odometry.modes.identify.held_out_gains import LEAST_WINDOWS, USUAL
from odometry.modes.models.traction import LEFT_TURN, RIGHT_TURN, TractionModes, twists_of
from odometry.modes.models.turning_centres import (
    LATE_S,
    centres,
    mean_centre_m,
    predicted_steps,
)
from odometry.modes.recorded.bank_inputs import pose_signals
from odometry.modes.recorded.measured_steps import LEAST_STEPS, StepWindows, step_windows
from odometry.modes.recorded.pose_steps import AHEAD, ASIDE, TURN, PoseSteps, pose_steps
from odometry.modes.recorded.turning_points import STEP_M
from odometry.recording.run import Run
from odometry.windows.recorded.spans import runs_of

WINDOW_S = 8.0  # those of 4 s leave more to noise, those of 16 s are too few
OVERLAP = 8  # every so many of the windows, which end each half second: they overlap by half
OUT = 0.632  # of the squares of gains that a drive was left out of: Efron 1983, JASA 78, 316
# Of a window's variance: in one in which poses become late it is large, and nothing else says so.
LEAST_NOISE = 0.25
IN_TIME = int(np.flatnonzero(LATE_S == 0.0)[0])

EACH_GAIN = np.zeros((8, 2, 3, 5))
"""Gains, each 1 for one term of all speeds: two shared, three of left and three of right turns."""
EACH_GAIN[range(5), LEFT_TURN, :, range(5)] = 1.0
EACH_GAIN[[0, 1, 5, 6, 7], RIGHT_TURN, :, range(5)] = 1.0


@dataclass(frozen=True)
class Drive:
    """A stretch in one mode.

    `moved` (9, L, K, 3) is by each gain of EACH_GAIN, and by all of the mode, for late poses.
    """

    steps: PoseSteps
    windows: StepWindows
    moved: FloatArray

    @property
    def normal(self) -> FloatArray:
        """Normal equations (2, 8, 9) of the speeds ahead and aside."""
        tables = [self.moved[:-1, IN_TIME, :, of] for of in (AHEAD, ASIDE)]
        wanted = self.steps.moved[:, : len(tables)].T
        return np.stack(
            [one @ np.column_stack([one.T, of]) for one, of in zip(tables, wanted, strict=True)]
        )

    def errors(self, gains: FloatArray, centre_m: float) -> FloatArray:
        """Of centres by gains (2, 8): errors and variances (W, 2, 2)."""
        ahead, aside = (
            np.tensordot(gains[of], self.moved[:-1, ..., of], 1) for of in (AHEAD, ASIDE)
        )
        predicted = np.stack([ahead, aside, self.moved[-1, ..., TURN]], axis=-1)
        every = np.ones(len(self.steps), dtype=np.bool_)
        both = np.stack(centres(self.steps, predicted, centre_m, self.windows, every), axis=-1)
        return both[np.isfinite(both).all(axis=(1, 2))]


def centre_errors(
    modes: TractionModes, runs: Sequence[Run]
) -> tuple[FloatArray, FloatArray] | None:
    """Spread of the errors of centres (M, 2) [m], and share of the variance of their windows.

    Every stretch of a mode is predicted by gains of its others, by linear least squares, and by
    those of the mode. The first err by more than the mode does on a new drive, since they are of
    fewer drives, and the second by less. To the left, and ahead; None where a mode has one stretch
    alone or too few windows turn.
    """
    own, out = [], []
    for place, mode in enumerate(modes.gains):
        drives, centre_m = list(_drives(modes, place, runs)), mean_centre_m(mode, modes.track_width)
        if len(drives) < 2:
            return None
        first = np.column_stack([mode[LEFT_TURN, :2], mode[RIGHT_TURN, :2, 2:]])
        prior = np.eye(len(EACH_GAIN)) * (STEP_M / USUAL) ** 2
        near, every = (first @ prior)[..., None], sum(one.normal for one in drives)
        own.append(np.concatenate([one.errors(first, centre_m) for one in drives]))
        rest = [every - one.normal for one in drives]
        gains = [np.linalg.solve(of[..., :-1] + prior, of[..., -1:] + near) for of in rest]
        pairs = zip(drives, gains, strict=True)
        errors = [one.errors(np.asarray(of[..., 0]), centre_m) for one, of in pairs]
        out.append(np.concatenate(errors))
    if min(sum(map(len, own)), sum(map(len, out))) < LEAST_WINDOWS:
        return None
    both = zip(_spread(out), _spread(own), strict=True)
    squares, noise = (OUT * of_out + (1 - OUT) * of_own for of_out, of_own in both)
    return np.sqrt(squares), np.tile(np.maximum(noise, LEAST_NOISE), (len(own), 1))


def _spread(by_mode: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray]:
    """Squared spread (M, 2) and share of the variance (2,), of errors (W, 2, 2) of each mode.

    A mode whose own windows have a larger spread keeps that.
    """
    errors, variances = np.moveaxis(np.concatenate(by_mode), -1, 0)
    usual = np.median(variances, axis=0)
    squares, noise = np.empty((len(by_mode), 2)), np.empty(2)
    for side in (0, 1):
        weights = 1 / np.maximum(variances[:, side], usual[side])
        table = np.column_stack([np.ones(len(errors)), variances[:, side]]) * weights[:, None]
        (squares[:, side], noise[side]), _ = nnls(table, errors[:, side] ** 2 * weights)
    for place, (own, of) in enumerate(np.moveaxis(one, -1, 0) for one in by_mode):
        if len(own) >= LEAST_WINDOWS:
            mean = np.average(own**2 - noise * of, weights=1 / np.maximum(of, usual), axis=0)
            squares[place] = np.maximum(squares[place], mean)
    return squares, noise


def _drives(modes: TractionModes, place: int, runs: Sequence[Run]) -> Iterator[Drive]:
    """Stretches in a mode that have a window."""
    each = (*EACH_GAIN, modes.gains[place])
    for signals in map(pose_signals, runs):
        for first, after in runs_of(signals.labels == modes.names[place]):
            rows = slice(int(first), int(after))
            stamps_s, speeds = signals.stamps_s[rows], signals.tread_speeds_m_s[rows]
            steps = pose_steps(stamps_s, signals.measured[rows, :3], signals.gaps_s)
            if len(steps) < LEAST_STEPS:
                continue
            every = step_windows(steps.begin_s, steps.end_s, WINDOW_S)
            some = slice(None, None, OVERLAP)
            windows = StepWindows(every.ends_s[some], every.first[some], every.after[some])
            twists = np.array([twists_of(of, speeds, modes.track_width) for of in each])
            moved = predicted_steps(steps, stamps_s, twists, float(modes.lag_s[place]))
            yield Drive(steps, windows, np.moveaxis(moved, 1, 0))
