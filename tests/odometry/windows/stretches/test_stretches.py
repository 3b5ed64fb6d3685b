"""Stretches of positions: their shapes, their derivatives and their noise."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.errors import WindowError
from odometry.models.catalogue import MODELS
from odometry.windows.config import WindowConfig
from odometry.windows.recorded.measured_poses import lacks_yaw
from odometry.windows.stretches.stretch_motion import (
    linearised_shape_residuals,
    rotations,
    shape_residuals,
)
from odometry.windows.stretches.stretch_noise import (
    covariance_parts,
    known_covariance,
    likeliest_noise,
    whitening,
)
from odometry.windows.stretches.stretches import stretches_of
from tests.odometry.positions_drives import ICR, drive, emptied

MODEL = MODELS["icr"]
TRUTH = MODEL.pack(ICR)
CONFIG = WindowConfig()


def cut(seed=1, length_m=8.0, **settings):
    return stretches_of([emptied(drive(seed, **settings))], length_m, CONFIG)


def test_stretches_lie_end_to_end_and_have_one_length():
    of = cut()
    assert np.ptp(of.travel_m) < 0.4
    assert np.abs(of.last[:-1] - of.first[1:]).max() <= 2 * 4  # samples of two positions
    assert of.measured.shape == (len(of), of.steps, 2)


def test_no_stretch_holds_a_gap_of_the_positions():
    run = emptied(drive(2))
    kept = np.abs(run.pose["t"] - 60.0) > 2.0
    of = stretches_of([replace(run, pose=run.pose.rows(np.flatnonzero(kept)))], 8.0, CONFIG)
    begin_s = of.ends.start_s[:: of.steps]
    assert not np.any((begin_s < 58.0) & (begin_s + of.lasts_s[:, -1] > 62.0))
    assert of.left_out.total() == 1


def test_too_few_positions_are_an_error_that_counts_them():
    run = drive(3)
    with pytest.raises(WindowError, match="3 measured positions"):
        stretches_of([replace(run, pose=run.pose.rows(slice(3)))], 8.0, CONFIG)


def test_runs_of_two_antennas_are_refused():
    with pytest.raises(WindowError, match=r"\[sensors\] pose"):
        stretches_of([drive(1), drive(2, arm_m=(0.3, 0.0))], 8.0, CONFIG)


def test_yaw_is_lacking_where_fewer_than_half_of_the_positions_have_one():
    run = drive(4)
    yaw = run.pose["yaw"].copy()
    yaw[: len(yaw) // 2 - 1] = np.nan
    assert not lacks_yaw(
        replace(run, pose=replace(run.pose, columns={**run.pose.columns, "yaw": yaw}))
    )
    yaw[: len(yaw) // 2 + 1] = np.nan
    assert lacks_yaw(replace(run, pose=replace(run.pose, columns={**run.pose.columns, "yaw": yaw})))
    assert not lacks_yaw(replace(run, pose=None))


def test_the_rotation_is_the_best_of_many():
    rng = np.random.default_rng(5)
    ways, measured = rng.normal(size=(2, 4, 6, 2))
    found = rotations(ways, measured)

    def misfit(angle):
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        turned = np.stack(
            [c * ways[..., 0] - s * ways[..., 1], s * ways[..., 0] + c * ways[..., 1]], axis=-1
        )
        off = np.concatenate([np.zeros((4, 1, 2)), turned - measured], axis=1)
        return np.sum((off - off.mean(axis=1, keepdims=True)) ** 2, axis=(1, 2))

    tried = np.linspace(-np.pi, np.pi, 2001)
    least = np.min([misfit(np.full(4, angle)) for angle in tried], axis=0)
    at_found = [np.sum(misfit(found)[k]) for k in range(4)]
    assert np.all(at_found <= least + 1e-5)


@pytest.mark.parametrize("gyroscope", [False, True])
def test_the_derivative_is_that_of_differences(gyroscope):
    of = cut(6, gyroscope=gyroscope, arm_m=(0.3, -0.2), noise_m=0.1)
    values = TRUTH + np.array([0.05, -0.03, 0.02, 0.03, -0.02])
    rows, by_values = linearised_shape_residuals(MODEL, values, of)
    np.testing.assert_allclose(rows, shape_residuals(MODEL, values, of), atol=1e-12)
    for p in range(5):
        step = np.zeros(5)
        step[p] = 1e-6
        differences = (
            shape_residuals(MODEL, values + step, of) - shape_residuals(MODEL, values - step, of)
        ) / 2e-6
        np.testing.assert_allclose(by_values[..., p], differences, atol=2e-6)


def test_the_truth_leaves_nothing_by_treads_and_next_to_nothing_by_gyroscope():
    assert np.abs(shape_residuals(MODEL, TRUTH, cut(7))).max() < 1e-9
    assert np.abs(shape_residuals(MODEL, TRUTH, cut(7, gyroscope=True))).max() < 0.02


@pytest.mark.parametrize("gyroscope", [False, True])
def test_whitened_rows_are_white_and_blind_to_a_turn(gyroscope):
    of = cut(8, gyroscope=gyroscope)
    parts, known = covariance_parts(of), known_covariance(of)
    variances = np.square([0.1, 0.05, 0.02])
    white = whitening(of, variances, parts, known)
    turned = np.stack([-of.measured[..., 1], of.measured[..., 0]], axis=-1).reshape(len(of), -1)
    assert np.abs(np.einsum("kij,kj->ki", white[:, :, : turned.shape[1]], turned)).max() < 1e-9
    covariance = np.einsum("p,pkij->kij", variances, parts) + known
    whitened = white @ covariance @ white.swapaxes(1, 2)
    rank = np.trace(whitened, axis1=1, axis2=2)
    np.testing.assert_allclose(rank, white.shape[1] - 1, rtol=1e-9)
    np.testing.assert_allclose(whitened @ whitened, whitened, atol=1e-9)


def test_the_variances_of_drawn_rows_come_back():
    of = cut(9, duration_s=600.0)
    truth, rng = np.square([0.1, 0.04, 0.02]), np.random.default_rng(0)
    covariance = np.einsum("p,pkij->kij", truth, covariance_parts(of))
    drawn = np.linalg.cholesky(covariance) @ rng.standard_normal((len(of), 2 * of.steps, 1))
    found = likeliest_noise(of, drawn[..., 0], np.zeros((*drawn.shape[:2], 0)), np.ones(len(of)))
    sigmas = np.sqrt(np.diag(np.linalg.inv(found.precision)))
    assert np.all(np.abs(found.variances - truth) < 3.5 * sigmas)
    np.testing.assert_allclose(found.variances, truth, rtol=0.5)
