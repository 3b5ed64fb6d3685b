"""Late frames: the same answer as in order, or a clear error."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from odometry.errors import EstimationError
from odometry.estimation.icr_ekf import IcrEkf
from odometry.estimation.in_order import InOrder
from tests.odometry.estimation.sensor_drives import WIDTH, drive, frames_of, noisy_poses

DRIVEN = drive(6.0)
FRAMES = frames_of(
    DRIVEN,
    poses=noisy_poses(DRIVEN, np.random.default_rng(3)),
    yaw_rates=DRIVEN.yaw_rates_rad_s,
)


def in_order():
    ekf = IcrEkf(WIDTH)
    return ekf, InOrder(ekf, ekf.start(FRAMES[0], "a"), keep_s=2.0)


def assert_same(one, other):
    assert one.stamp_s == other.stamp_s
    np.testing.assert_array_equal(one.mean, other.mean)
    np.testing.assert_array_equal(one.covariance, other.covariance)
    assert one.scale.slip_log == other.scale.slip_log


@settings(max_examples=20)
@given(st.lists(st.floats(0, 1.5), min_size=60, max_size=60))
def test_however_late_frames_come_the_answer_is_the_same(delays_s):
    ekf, late = in_order()
    estimate = ekf.start(FRAMES[0], "a")
    for frame in FRAMES[1:]:
        estimate = ekf.step(estimate, frame, "ab"[frame.stamp_s > 3])
    arrivals = [
        frame.stamp_s + delay_s for frame, delay_s in zip(FRAMES[1:], delays_s, strict=True)
    ]
    for k in np.argsort(arrivals, kind="stable"):
        late.step(FRAMES[1 + k], "ab"[FRAMES[1 + k].stamp_s > 3])
    assert_same(late.estimate, estimate)


def test_a_frame_that_is_too_late_is_refused_and_changes_nothing():
    ekf, late = in_order()
    for frame in FRAMES[1:]:
        late.step(frame, "a")
    before = late.estimate
    with pytest.raises(EstimationError, match=r"0\.1 s came when the filter was at 6\.0 s"):
        late.step(FRAMES[1], "a")
    assert_same(late.estimate, before)
    with pytest.raises(EstimationError, match="in time order"):
        ekf.step(before, FRAMES[10], "a")


def test_two_frames_of_one_stamp_keep_their_order():
    ekf, late = in_order()
    estimate = ekf.start(FRAMES[0], "a")
    for frame in (FRAMES[1], FRAMES[1], FRAMES[2]):
        estimate = ekf.step(estimate, frame, "a")
        late.step(frame, "a")
    assert_same(late.estimate, estimate)
