"""The bias of the gyroscope while modes are undetermined: the truth lies between two modes."""

import numpy as np

from odometry.modes.follow.track import follow_signals
from odometry.modes.models.mode_set import ModeSet
from odometry.modes.models.velocity import VelocityModes
from odometry.modes.recorded.bank_inputs import BIAS_SIGMA_RAD_S, BIAS_WALK_RAD2_S3, Signals
from tests.odometry.modes.mode_drives import velocities, wandering

STEP_S, SIZE = 0.02, 3000
RATE_HZ, NOISE_RAD_S = 10.0, 0.02
LASTING_S = 0.5  # of errors of the modes: a measurement is news by a share of 0.04
A = -RATE_HZ * np.eye(2)


def answers(turn):
    """B of a mode that turns by so much per difference of tread speeds."""
    return RATE_HZ * np.array([[0.5, 0.5], [-turn, turn]])


def modes(*turns):
    count = len(turns)
    B = np.stack([answers(turn) for turn in turns])
    noise = np.full((count, 2), 1e-4), np.full((count, 2), 0.05**2)
    names = tuple("abc"[:count])
    return ModeSet(
        VelocityModes(names, np.tile(A, (count, 1, 1)), B, *noise, LASTING_S), np.full(count, 20.0)
    )


def drive(rng, turn, hold_s):
    """Yaw rates alone; turns are held for so long that a bias looks like another mode."""
    treads = wandering(rng, SIZE, STEP_S, hold_s=hold_s)
    true = velocities(
        np.tile(A, (SIZE, 1, 1)), np.tile(answers(turn), (SIZE, 1, 1)), treads, STEP_S
    )
    omega = true[:, 1] + NOISE_RAD_S * rng.normal(size=SIZE)
    measured = np.column_stack([np.full(SIZE, np.nan), omega])
    labels = np.full(SIZE, "unknown", dtype=object)
    return Signals(STEP_S * np.arange(SIZE), treads, measured, labels)


def test_modes_that_are_not_distinguished_leave_the_bias_as_certain_as_it_was():
    """Each mode explains the turn by a bias of its own, and these differ by little."""
    signals = drive(np.random.default_rng(0), 1.1, hold_s=6.0)
    track = follow_signals(signals, modes(1.0, 1.2))
    most = np.sqrt(BIAS_SIGMA_RAD_S**2 + BIAS_WALK_RAD2_S3 * STEP_S * SIZE)
    assert track.sigmas[:, -1].max() < 1.5 * most
    assert np.abs(track.means[:, -1]).max() < most
