import numpy as np
import pytest

from odometry.errors import EstimationError
from odometry.estimation.imm.mode_belief import ModeBelief

MEANS, COVARIANCES, LOGS = np.zeros((2, 3)), np.tile(np.eye(3), (2, 1, 1)), np.log([0.25, 0.75])


def test_all_modes_start_alike():
    belief = ModeBelief.alike(np.arange(3.0), 2 * np.eye(3), np.array([0.5, 0.5, 0.0]))
    assert belief.modes == 3
    np.testing.assert_array_equal(belief.means, [[0, 1, 2]] * 3)
    np.testing.assert_array_equal(belief.covariances[2], 2 * np.eye(3))
    np.testing.assert_allclose(belief.probabilities, [0.5, 0.5, 0])


@pytest.mark.parametrize(
    ("means", "covariances", "logs", "message"),
    [
        (np.zeros(3), COVARIANCES, LOGS, r"means of shape \(3,\), expected \(modes, states\)"),
        (np.zeros((0, 3)), np.zeros((0, 3, 3)), np.zeros(0), "means of shape"),
        (np.zeros((3, 3)), COVARIANCES, LOGS, r"expected \(3, 3\), \(3, 3, 3\) and \(3,\)"),
        (MEANS, np.eye(3), LOGS, r"of shapes \(2, 3\), \(3, 3\) and"),
        (MEANS, COVARIANCES, np.zeros(1), r"\(1,\), expected"),
        (MEANS, COVARIANCES, np.log([0.5, 0.6]), "expected a sum of 1"),
        (MEANS, COVARIANCES, np.array([np.nan, 0.0]), "expected a sum of 1"),
        (MEANS + np.array([[0], [np.inf]]), COVARIANCES, LOGS, r"mode 1: mean \[inf"),
        (MEANS, COVARIANCES * [[[np.nan]], [[1]]], LOGS, "mode 0: .*expected finite"),
    ],
)
def test_what_is_no_belief_is_refused(means, covariances, logs, message):
    with pytest.raises(EstimationError, match=message):
        ModeBelief(means, covariances, logs)
