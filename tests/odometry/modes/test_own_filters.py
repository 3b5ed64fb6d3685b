"""Filters of one mode each, when the lead among the modes changes."""

import numpy as np

from odometry.estimation.mode_belief import ModeBelief
from odometry.modes.own_filters import with_lead

LOGS = np.log([0.1, 0.9])
ALONE = ModeBelief(np.array([[1.0], [50.0]]), np.array([[[1.0]], [[2.0]]]), LOGS)
ALL = ModeBelief(np.array([[3.0], [4.0]]), np.array([[[5.0]], [[6.0]]]), LOGS)


def test_a_mode_that_takes_the_lead_begins_where_the_estimator_is():
    begun = with_lead(ALONE, ALL, led=0)
    np.testing.assert_array_equal(begun.means, [[1.0], [4.0]])
    np.testing.assert_array_equal(begun.covariances, [[[1.0]], [[6.0]]])


def test_a_mode_that_keeps_the_lead_goes_on():
    assert with_lead(ALONE, ALL, led=1) is ALONE
