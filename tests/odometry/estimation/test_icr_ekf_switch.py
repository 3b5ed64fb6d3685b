"""A switch of the ground: the ICRs are those of its table, or what was learned there."""

from dataclasses import replace

import numpy as np
import pytest

from tests.odometry.estimation.icr_ekf_drives import (
    WIDTH,
    driven,
    filter_of,
    frame,
    switched,
    table,
)


def test_a_switch_takes_the_table_and_resets_exactly_the_icr_block():
    """P_B on the ICR block, zero cross terms, the pose block as it was."""
    terrains = {"a": table(0.4, -0.4, 0), "b": table(0.3, -0.35, 0.1, 0.02, alpha_left=0.9)}
    ekf = filter_of(terrains=terrains, reset_sigma_widths=0.3)
    before, after = switched(ekf, driven(ekf), "b")
    assert np.abs(before.covariance[:3, 3:6]).max() > 1e-4
    np.testing.assert_array_equal(after.mean, [*before.mean[:3], 0.3, -0.35, 0.1, 0, 0.9, 1])
    np.testing.assert_array_equal(after.covariance[:3, :3], before.covariance[:3, :3])
    np.testing.assert_allclose(after.covariance[3:6, 3:6], 0.15**2 * np.eye(3), rtol=1e-12)
    assert np.all(after.covariance[:3, 3:6] == 0)
    assert np.all(after.covariance[3:6, :3] == 0)
    np.testing.assert_array_equal(after.alphas, [0.9, 1])
    assert after.terrain == "b"


def test_a_switch_to_a_terrain_without_a_table_takes_the_broad_prior():
    """Round the mean of the terrains with a table; without any round the ideal drive."""
    ekf = filter_of(terrains={"a": table(0.4, -0.4, 0), "b": table(0.3, -0.35, 0.1)})
    _, after = switched(ekf, driven(ekf), "c")
    np.testing.assert_allclose(after.mean[3:6], [0.35, -0.375, 0.05])
    alone = filter_of(terrains={})
    _, ideal = switched(alone, driven(alone), "c")
    np.testing.assert_allclose(ideal.mean[3:6], [WIDTH / 2, -WIDTH / 2, 0])
    np.testing.assert_allclose(after.covariance[3:6, 3:6], (WIDTH / 2) ** 2 * np.eye(3))


def test_the_same_name_is_no_switch():
    ekf = filter_of(terrains={"a": table(0.4, -0.4, 0)})
    estimate = driven(ekf)
    assert estimate.learned == {}
    assert np.abs(estimate.covariance[:3, 3:6]).max() > 1e-4


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
    covariance[3:6, 3:6] = learned_sigma_m**2 * np.eye(3)
    mean = np.array([0, 0, 0, 0.45, -0.4, 0.05, 0, 1, 1])
    left = switched(ekf, replace(there, mean=mean, covariance=covariance), "a")[1]
    np.testing.assert_array_equal(left.mean[3:6], [0.4, -0.4, 0])
    back = switched(ekf, left, "b")[1]
    np.testing.assert_array_equal(back.mean[3:6], expected)


def test_a_terrain_that_was_left_before_anything_was_learned_is_as_uncertain_as_ever():
    """Neither a table nor a measurement: on the way back it is the broad prior again."""
    ekf = filter_of(terrains={"a": table(0.4, -0.4, 0)})
    visited = driven(ekf, "c", 2, switched(ekf, driven(ekf), "c")[1])
    back = switched(ekf, driven(ekf, "a", 2, visited), "c")[1]
    np.testing.assert_allclose(back.covariance[3:6, 3:6], (WIDTH / 2) ** 2 * np.eye(3))


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
