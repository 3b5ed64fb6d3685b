from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binomtest

from odometry.errors import ConfigError
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.icr_ekf import IcrEkf
from odometry.parameters import ParameterSet, TerrainParameters
from odometry.run import Frame

WIDTH = 0.5
NAMES = ("y_left", "y_right", "x_icr")


def frame(stamp_s, pose=None, speeds=(0.4, 0.8)):
    pose = None if pose is None else np.array(pose, dtype=float)
    return Frame(stamp_s, np.array(speeds, dtype=float), 0, pose, None)


def table(y_left, y_right, x_icr, sigma_m=None, **alphas):
    values = {"y_left": y_left, "y_right": y_right, "x_icr": x_icr, **alphas}
    if sigma_m is None:
        return TerrainParameters("icr", values)
    return TerrainParameters("icr", values, NAMES, sigma_m**2 * np.eye(3))


def filter_of(*, terrains=None, **settings):
    return IcrEkf(WIDTH, ParameterSet(terrains or {}), IcrEkfConfig(**settings))


def driven(ekf, terrain="a", steps=30, estimate=None):
    """A drive without poses, so that cross terms grow."""
    estimate = estimate or ekf.start(frame(0, (0, 0, 0)), terrain)
    start_s = estimate.stamp_s
    for i in range(1, steps + 1):
        estimate = ekf.step(estimate, frame(start_s + 0.1 * i), terrain)
    return estimate


def drawn_pose(ekf, estimate, rng):
    """A pose as likely as the filter thinks: from the Gaussian of its own innovation."""
    sigma = np.array([ekf.config.position_sigma_m] * 2 + [ekf.config.yaw_sigma_rad])
    expected = estimate.covariance[:3, :3] + np.diag(sigma**2)
    return rng.multivariate_normal(estimate.mean[:3], expected)


# --- start


def test_it_starts_at_the_pose_with_the_sensors_uncertainty():
    ekf = filter_of(terrains={"a": table(0.4, -0.3, 0.1, 0.02)}, yaw_sigma_rad=0.03)
    start = ekf.start(frame(5, (1, 2, 3)), "a")
    np.testing.assert_array_equal(start.mean, [1, 2, 3, 0.4, -0.3, 0.1])
    np.testing.assert_allclose(
        start.covariance, np.diag(np.square([0.02, 0.02, 0.03, 0.02, 0.02, 0.02]))
    )
    assert (start.stamp_s, start.terrain) == (5, "a")


@pytest.mark.parametrize("pose", [None, (np.nan, 0, 0), (0, 0, np.nan)])
def test_it_starts_at_the_origin_without_a_pose(pose):
    np.testing.assert_array_equal(filter_of().start(frame(0, pose), "a").mean[:3], [0, 0, 0])


def test_a_terrain_without_a_table_starts_from_the_broad_prior():
    start = filter_of().start(frame(0), "a")
    np.testing.assert_allclose(start.mean[3:], [WIDTH / 2, -WIDTH / 2, 0])
    np.testing.assert_allclose(start.covariance[3:, 3:], (WIDTH / 2) ** 2 * np.eye(3))


# --- measurements


@pytest.mark.parametrize("pose", [(np.nan, 1, 1), (1, np.nan, 1), (1, 1, np.nan), (np.inf, 0, 0)])
def test_a_pose_with_nan_is_as_good_as_none(pose):
    ekf = filter_of()
    before = driven(ekf)
    with_nan = ekf.step(before, frame(3.1, pose), "a")
    without = ekf.step(before, frame(3.1), "a")
    np.testing.assert_array_equal(with_nan.mean, without.mean)
    np.testing.assert_array_equal(with_nan.covariance, without.covariance)
    assert with_nan.innovation is None


def test_slip_factors_multiply_the_measured_speeds():
    slipping = filter_of(terrains={"a": table(0.3, -0.3, 0, alpha_left=0.5, alpha_right=0.75)})
    plain = filter_of(terrains={"a": table(0.3, -0.3, 0)})
    moved = slipping.step(slipping.start(frame(0, speeds=(2, 4)), "a"), frame(0.5), "a")
    expected = plain.step(plain.start(frame(0, speeds=(1, 3)), "a"), frame(0.5), "a")
    np.testing.assert_allclose(moved.mean, expected.mean)


def test_without_tread_speeds_it_stays():
    ekf = filter_of()
    start = ekf.start(frame(0, (1, 2, 3), speeds=(np.nan, np.nan)), "a")
    np.testing.assert_array_equal(ekf.step(start, frame(1), "a").mean, start.mean)


@pytest.mark.parametrize("yaw", [np.pi - 0.01, -np.pi + 0.01, np.pi])
def test_yaw_wraps(yaw):
    """A pose at +-pi + 0.02 from a belief on the other side is a small innovation."""
    ekf = filter_of(gate_probability=1.0)
    start = ekf.start(frame(0, (0, 0, yaw), speeds=(0, 0)), "a")
    for shift in (0.02, -0.02):
        measured = np.angle(np.exp(1j * (yaw + shift)))
        after = ekf.step(start, frame(0.1, (0, 0, measured)), "a")
        assert after.innovation.residual[2] == pytest.approx(shift, abs=1e-12)
        assert -np.pi < after.mean[2] <= np.pi
        moved = np.angle(np.exp(1j * (after.mean[2] - yaw)))
        assert moved / shift == pytest.approx(0.75, abs=0.25)


def test_turning_on_the_spot_past_the_half_turn():
    """Whole turns with poses wrapped as sensors wrap them: no pose is ever refused."""
    ekf = filter_of(terrains={"a": table(0.25, -0.25, 0)})
    estimate = ekf.start(frame(0, (0, 0, 0), speeds=(-0.25, 0.25)), "a")
    for i in range(1, 200):
        yaw = np.angle(np.exp(0.1j * i))
        estimate = ekf.step(estimate, frame(0.1 * i, (0, 0, yaw), speeds=(-0.25, 0.25)), "a")
        assert estimate.innovation.accepted
    np.testing.assert_allclose(estimate.mean[3:], [0.25, -0.25, 0], atol=1e-6)


# --- gate


@pytest.mark.parametrize("probability", [0.9, 0.99])
def test_the_gate_is_a_probability(probability, rng):
    """Of true poses it refuses 1 - probability, within what chance allows once in 1000."""
    terrains = {"a": table(0.3, -0.3, 0, 0.02)}
    ekf = filter_of(terrains=terrains, gate_probability=probability)
    before = driven(ekf)
    at_the_pose = ekf.step(before, frame(3.1), "a")
    poses = [drawn_pose(ekf, at_the_pose, rng) for _ in range(2000)]
    answers = [ekf.step(before, frame(3.1, pose), "a").innovation.accepted for pose in poses]
    refused = answers.count(False)
    assert binomtest(refused, 2000, 1 - probability).pvalue > 1e-3


def test_a_refused_pose_changes_nothing_but_the_count():
    ekf = filter_of(gate_probability=0.99)
    before = driven(ekf)
    refused = ekf.step(before, frame(3.1, (1e3, 0, 0)), "a")
    without = ekf.step(before, frame(3.1), "a")
    np.testing.assert_array_equal(refused.mean, without.mean)
    np.testing.assert_array_equal(refused.covariance, without.covariance)
    assert (refused.innovation.accepted, refused.rejected_in_row) == (False, 1)


def test_patience_then_the_pose_is_believed():
    ekf = filter_of(gate_probability=0.99, gate_patience=3)
    estimate = driven(ekf)
    icr_block = estimate.covariance[3:, 3:]
    for i in range(1, 4):
        estimate = ekf.step(estimate, frame(3 + 0.1 * i, (100, 50, 1)), "a")
        assert not estimate.innovation.accepted
        if i < 3:
            assert estimate.rejected_in_row == i
            assert abs(estimate.mean[0]) < 50
    np.testing.assert_array_equal(estimate.mean[:3], [100, 50, 1])
    assert estimate.rejected_in_row == 0
    np.testing.assert_allclose(np.diag(estimate.covariance)[:3], [4e-4, 4e-4, 1e-4])
    assert np.all(estimate.covariance[:3, 3:] == 0)
    assert np.all(np.diag(estimate.covariance)[3:] >= np.diag(icr_block))


def test_a_pose_that_passes_ends_the_row():
    ekf = filter_of(gate_probability=0.99)
    before = driven(ekf)
    refused = ekf.step(before, frame(3.1, (1e3, 0, 0)), "a")
    after = ekf.step(refused, frame(3.1, refused.mean[:3]), "a")
    assert (after.innovation.accepted, after.rejected_in_row) == (True, 0)


# --- switch


def switched(ekf, estimate, terrain):
    """The estimates just before and just after a switch with no time between."""
    before = ekf.step(estimate, frame(estimate.stamp_s), estimate.terrain)
    return before, ekf.step(estimate, frame(estimate.stamp_s), terrain)


def test_a_switch_takes_the_table_and_resets_exactly_the_icr_block():
    """P_B on the ICR block, zero cross terms, the pose block as it was."""
    terrains = {"a": table(0.4, -0.4, 0), "b": table(0.3, -0.35, 0.1, 0.02, alpha_left=0.9)}
    ekf = filter_of(terrains=terrains, reset_sigma_widths=0.3)
    before, after = switched(ekf, driven(ekf), "b")
    assert np.abs(before.covariance[:3, 3:]).max() > 1e-4
    np.testing.assert_array_equal(after.mean, [*before.mean[:3], 0.3, -0.35, 0.1])
    np.testing.assert_array_equal(after.covariance[:3, :3], before.covariance[:3, :3])
    np.testing.assert_allclose(after.covariance[3:, 3:], 0.15**2 * np.eye(3), rtol=1e-12)
    assert np.all(after.covariance[:3, 3:] == 0)
    assert np.all(after.covariance[3:, :3] == 0)
    np.testing.assert_array_equal(after.alphas, [0.9, 1])
    assert after.terrain == "b"


def test_a_switch_to_a_terrain_without_a_table_takes_the_broad_prior():
    ekf = filter_of(terrains={"a": table(0.4, -0.4, 0)})
    _, after = switched(ekf, driven(ekf), "c")
    np.testing.assert_allclose(after.mean[3:], [WIDTH / 2, -WIDTH / 2, 0])
    np.testing.assert_allclose(after.covariance[3:, 3:], (WIDTH / 2) ** 2 * np.eye(3))


def test_the_same_name_is_no_switch():
    ekf = filter_of(terrains={"a": table(0.4, -0.4, 0)})
    estimate = driven(ekf)
    assert estimate.learned == {}
    assert np.abs(estimate.covariance[:3, 3:]).max() > 1e-4


@pytest.mark.parametrize(
    ("learned_sigma_m", "expected"),
    [(0.01, (0.45, -0.4, 0.05)), (0.03, (0.3, -0.35, 0.1))],
)
def test_what_was_learned_comes_back_where_it_is_more_certain_than_the_table(
    learned_sigma_m, expected
):
    terrains = {"a": table(0.4, -0.4, 0), "b": table(0.3, -0.35, 0.1, 0.02)}
    ekf = filter_of(terrains=terrains)
    there = ekf.start(frame(0, (0, 0, 0), speeds=(0, 0)), "b")
    covariance = there.covariance.copy()
    covariance[3:, 3:] = learned_sigma_m**2 * np.eye(3)
    mean = np.array([0, 0, 0, 0.45, -0.4, 0.05])
    left = switched(ekf, replace(there, mean=mean, covariance=covariance), "a")[1]
    np.testing.assert_array_equal(left.mean[3:], [0.4, -0.4, 0])
    back = switched(ekf, left, "b")[1]
    np.testing.assert_array_equal(back.mean[3:], expected)


def test_a_terrain_that_was_left_before_anything_was_learned_is_as_uncertain_as_ever():
    """Neither a table nor a measurement: on the way back it is the broad prior again."""
    ekf = filter_of(terrains={"a": table(0.4, -0.4, 0)})
    visited = driven(ekf, "c", 2, switched(ekf, driven(ekf), "c")[1])
    back = switched(ekf, driven(ekf, "a", 2, visited), "c")[1]
    np.testing.assert_allclose(back.covariance[3:, 3:], (WIDTH / 2) ** 2 * np.eye(3))


def test_the_step_before_a_switch_is_predicted_with_the_old_icrs():
    terrains = {"a": table(0.4, -0.4, 0), "b": table(0.2, -0.2, 0)}
    ekf = filter_of(terrains=terrains)
    start = ekf.start(frame(0, (0, 0, 0)), "a")
    after = ekf.step(start, frame(1), "b")
    np.testing.assert_array_equal(after.mean[:3], ekf.step(start, frame(1), "a").mean[:3])
    assert after.mean[2] == pytest.approx(0.4 / 0.8)


def test_the_estimate_that_went_in_is_not_changed():
    ekf = filter_of(terrains={"a": table(0.4, -0.4, 0)})
    before = driven(ekf)
    copies = before.mean.copy(), before.covariance.copy(), dict(before.learned)
    ekf.step(before, frame(3.1, (1, 1, 0.1)), "b")
    np.testing.assert_array_equal(before.mean, copies[0])
    np.testing.assert_array_equal(before.covariance, copies[1])
    assert before.learned == copies[2]


# --- jumps


def test_jumps_have_the_stated_false_alarm_rate(rng):
    """Nine innovations as likely as they should be, then a tenth: 1 - probability jump."""
    terrains = {"a": table(0.3, -0.3, 0, 0.02)}
    ekf = filter_of(terrains=terrains, detect_jumps=True, jump_probability=0.95)
    before = driven(ekf)
    at_the_pose = ekf.step(before, frame(3.1), "a")
    alarms = 0
    for _ in range(2000):
        loaded = replace(before, recent=tuple(rng.chisquare(3, 9)))
        alarms += ekf.step(loaded, frame(3.1, drawn_pose(ekf, at_the_pose, rng)), "a").jumped
    assert binomtest(alarms, 2000, 0.05).pvalue > 1e-3


def on_two_grounds(ekf, first_m, second_m, rng, change=100):
    """Turn to and fro; the true half distance of the ICRs changes on the way."""
    yaw, estimates = 0.0, [ekf.start(frame(0, (0, 0, 0), speeds=(-0.4, 0.4)), "a")]
    for i in range(1, 2 * change):
        yaw += 0.1 * 0.4 / (first_m if i < change else second_m)
        pose = np.array([0, 0, np.angle(np.exp(1j * yaw))])
        pose += rng.normal(0, [0.02, 0.02, 0.01])
        estimates.append(ekf.step(estimates[-1], frame(0.1 * i, pose, (-0.4, 0.4)), "a"))
    return estimates


def test_a_jump_is_found_and_the_icr_block_reset(rng):
    ekf = filter_of(terrains={"a": table(0.25, -0.25, 0, 0.01)}, detect_jumps=True)
    estimates = on_two_grounds(ekf, 0.25, 0.5, rng)
    jumps = [i for i, estimate in enumerate(estimates) if estimate.jumped]
    assert jumps
    assert 100 <= jumps[0] <= 110
    assert estimates[jumps[0]].recent == ()
    sigmas = [np.sqrt(np.diag(estimate.covariance)[3:]) for estimate in estimates]
    assert np.all(sigmas[jumps[0]] > 3 * sigmas[jumps[0] - 1])
    widths = [estimate.mean[3] - estimate.mean[4] for estimate in estimates]
    assert widths[-1] == pytest.approx(1.0, rel=0.05)


def test_a_switch_forgets_the_innovations_of_the_ground_before():
    ekf = filter_of(detect_jumps=True)
    estimate = ekf.step(driven(ekf), frame(3.1, (1.5, 1, 0.5)), "a")
    assert len(estimate.recent) == 1
    assert switched(ekf, estimate, "b")[1].recent == ()


def test_no_jump_is_found_where_nothing_jumps_or_nobody_looks(rng):
    terrains = {"a": table(0.25, -0.25, 0, 0.01)}
    steady = on_two_grounds(filter_of(terrains=terrains, detect_jumps=True), 0.25, 0.25, rng)
    blind = on_two_grounds(filter_of(terrains=terrains), 0.25, 0.5, rng)
    assert not any(estimate.jumped for estimate in steady + blind)


# --- the width


@pytest.mark.parametrize("yaw", [-3, 3, 30])
def test_y_left_stays_above_y_right_under_violent_innovations(yaw, rng):
    ekf = filter_of(gate_probability=1.0, reset_sigma_widths=4)
    estimate = ekf.start(frame(0, (0, 0, 0)), "a")
    for i in range(1, 60):
        pose = rng.normal([0, 0, yaw], [50, 50, abs(yaw)])
        estimate = ekf.step(estimate, frame(0.1 * i, pose, rng.uniform(-2, 2, 2)), "a")
        assert estimate.mean[3] - estimate.mean[4] >= 0.1 * WIDTH - 1e-12
        assert np.all(np.isfinite(estimate.mean))


# --- settings


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("position_sigma_m", 0.0),
        ("yaw_sigma_rad", -1.0),
        ("yaw_sigma_rad", float("nan")),
        ("position_noise", -1e-9),
        ("icr_noise_widths", -1.0),
        ("reset_sigma_widths", 0.0),
        ("gate_probability", 0.0),
        ("gate_probability", 1.5),
        ("jump_probability", -1.0),
        ("gate_patience", 0),
        ("jump_window", 0),
    ],
)
def test_settings_without_meaning_are_refused(name, value):
    with pytest.raises(ConfigError, match=name):
        IcrEkfConfig(**{name: value})
