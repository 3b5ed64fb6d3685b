"""What a gyroscope that repeats its value may differ from the treads by."""

import numpy as np
import pytest

from odometry.estimation.transition import STATES, Y_LEFT, Y_RIGHT
from odometry.estimation.watches.gyroscope_hold import (
    BANDED,
    NOISY_S,
    SOUND,
    GyroscopeHold,
    _difference,
)


def held(rate_rad_s, width_m, changing_s=0.0):
    """A value that repeats, of a robot whose width is known exactly."""
    mean = np.zeros(STATES)
    mean[[Y_LEFT, Y_RIGHT]] = width_m / 2, -width_m / 2
    belief = mean, np.zeros((STATES, STATES))
    return GyroscopeHold(rate_rad_s, 0.0, 0.0, belief, "grass", 0.0, 0.0, False, changing_s)


@pytest.mark.parametrize("width_m", [0.5, 2.0])
@pytest.mark.parametrize(("left", "right"), [(1.0, 1.0), (-0.5, 1.5), (0.0, 0.0)])
def test_a_share_of_the_speed_over_the_width_is_allowed(left, right, width_m):
    speed = (abs(left) + abs(right)) / 2
    for hold, (at_rest, share) in (
        (held(0.0, width_m), BANDED),
        (held(0.0, width_m, changing_s=2 * NOISY_S), SOUND),
        (held(1.0, width_m), SOUND),
    ):
        _, allowed_rad_s = _difference(hold, left, right)
        assert allowed_rad_s == pytest.approx(at_rest + share * speed / width_m)
