import numpy as np
import pytest

from odometry.modes.response import BLOCK_S
from odometry.modes.yaw_rate_noise import NOT_MEASURED, yaw_rate_variance
from tests.odometry.modes.mode_drives import ROBOT, asked_twists, run_of_tables, wandering

STEP_S = 0.02
GAINS = {
    "ice": np.array([[[1.0, 0.0], [0.0, 0.0], [0.1, 0.5]], [[1.0, 0.0], [0.0, 0.0], [0.0, 0.7]]]),
    "tar": np.array([[[1.0, 0.0], [0.0, 0.0], [0.0, 0.9]], [[1.0, 0.0], [0.0, 0.0], [0.2, 0.8]]]),
}
LAG_S = 0.0
FITS = [(GAINS["ice"], LAG_S), (GAINS["tar"], LAG_S)]


def drive(rng, labels, errors, *, gyro=True):
    """What the modes of the labels ask for, a stamp late as a lag of nothing is, and errors."""
    treads = wandering(rng, len(labels), STEP_S)
    asked = np.empty(len(labels))
    for name in set(labels):
        gains, rows = GAINS[name], np.asarray(labels) == name
        late = np.append(treads[rows][:1], treads[rows][:-1], axis=0)
        asked[rows] = asked_twists(gains, late, ROBOT.track_width)[:, 2]
    columns = {"t": STEP_S * np.arange(len(labels)), "v_left": treads[:, 0]}
    columns |= {"v_right": treads[:, 1], "terrain": np.array(labels, dtype=object)}
    return run_of_tables(columns | ({"gyro_z": asked + errors} if gyro else {}))


def variance(*runs):
    return yaw_rate_variance(runs, ("ice", "tar"), FITS, ROBOT.track_width)


def test_white_noise_is_what_it_is(rng):
    labels = ["ice"] * 20_000 + ["tar"] * 20_000
    found = variance(drive(rng, labels, 0.05 * rng.normal(size=len(labels))))
    blocks = len(labels) * STEP_S / BLOCK_S
    assert found == pytest.approx(0.05**2, rel=4 * np.sqrt(2 / blocks))


def test_an_error_that_lasts_counts_for_as_many_samples(rng):
    """A bias over blocks of n samples is as white noise of n times its square."""
    found = variance(drive(rng, ["tar"] * 5000, 0.1))
    assert found == pytest.approx(0.1**2 * BLOCK_S / STEP_S, rel=1e-3)


def test_what_was_not_measured_is_left_out(rng):
    errors = np.full(5000, 0.1)
    errors[::7] = np.nan
    assert variance(drive(rng, ["ice"] * 5000, errors)) == pytest.approx(1.0, rel=1e-3)


def test_runs_without_a_gyroscope_are_left_out(rng):
    with_one, without = (drive(rng, ["ice"] * 2000, 0.1, gyro=gyro) for gyro in (True, False))
    assert variance(without, with_one) == variance(with_one)
    assert variance(without) == NOT_MEASURED


def test_too_short_for_a_block_says_nothing(rng):
    assert variance(drive(rng, ["ice"] * 50, 0.1)) == NOT_MEASURED


def test_a_stretch_of_one_stamp_is_too_short(rng):
    labels = ["ice"] * 2000 + ["tar"] + ["ice"] * 2000
    assert variance(drive(rng, labels, 0.1)) == pytest.approx(1.0, rel=1e-2)
