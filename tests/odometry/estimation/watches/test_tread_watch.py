"""By how much a constant reading must contradict the other tread and the gyroscope."""

import math

import numpy as np
import pytest

from odometry.estimation.transition import ALPHA_LEFT, ALPHA_RIGHT, STATES, Y_LEFT, Y_RIGHT
from odometry.estimation.watches.tread_watch import SAME_S, TreadWatch, contradicted

WIDTH_M, SPEED_M_S = 0.6, 1.0


def belief():
    mean = np.zeros(STATES)
    mean[[Y_LEFT, Y_RIGHT, ALPHA_LEFT, ALPHA_RIGHT]] = WIDTH_M / 2, -WIDTH_M / 2, 1.0, 1.0
    return mean, 1e-8 * np.eye(STATES)


def is_off(by_m_s, slip_scale, same_s=2 * SAME_S):
    """Whether the left reading is in doubt where right tread and gyroscope give a speed beside it.

    0.15 m/s, and of the faster tread 0.3 and 0.15 times the scale of slip's standard deviation.
    """
    speeds, known = (SPEED_M_S, SPEED_M_S), belief()
    watch = TreadWatch(speeds, 0, 0.0, (10.0 - same_s, 10.0), (known, known))
    after = contradicted(watch, 10.0, known, by_m_s / WIDTH_M, slip_scale)
    assert after.stuck == -1  # not before it has lasted
    return not math.isnan(after.off_since_s)


@pytest.mark.parametrize("sign", [-1, 1])
@pytest.mark.parametrize(("slip_scale", "limit_m_s"), [(1.0, 0.6), (4.0, 0.75), (0.0, 0.45)])
def test_a_reading_is_in_doubt_beyond_what_treads_slip(sign, slip_scale, limit_m_s):
    assert is_off(sign * (limit_m_s + 0.01), slip_scale)
    assert not is_off(sign * (limit_m_s - 0.01), slip_scale)


def test_a_reading_that_changed_lately_is_not_in_doubt():
    assert not is_off(2.0, 1.0, same_s=0.9 * SAME_S)
