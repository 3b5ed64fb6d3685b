"""Information of a calibration: errors that are equal within pieces of the runs count as one."""

import numpy as np
import pytest

from odometry.gap.prepare.calibration import TOGETHER_S, _information
from odometry.gap.prepare.pieces import pieces
from odometry.gap.solve import Solved


@pytest.fixture(scope="module")
def scenes(make_scene):
    """Two runs, of whole pieces of five windows alone."""
    made = [
        make_scene(seed, duration_s=duration_s) for seed, duration_s in ((3, 200.0), (4, 100.0))
    ]
    whole = []
    for scene in made:
        number = pieces(scene, TOGETHER_S)
        whole.append(scene.where((np.bincount(number) == 5)[number]))
    return whole


@pytest.fixture(scope="module")
def count(scenes):
    """Pieces, and rows of each."""
    rows = sum(scene.measured.size for scene in scenes)
    numbers = sum(len(np.unique(pieces(scene, TOGETHER_S))) for scene in scenes)
    return numbers, rows // numbers


def solved(jacobian, errors):
    """A linear problem at its solution."""
    values, *_ = np.linalg.lstsq(jacobian, errors, rcond=None)
    return Solved(values, errors - jacobian @ values, jacobian)


def test_a_mean_is_as_sure_as_the_scatter_of_the_means_of_pieces(scenes, count, rng):
    """The textbook's variance of a mean of as many independent ones."""
    errors = np.repeat(rng.normal(size=count[0]), count[1]) + rng.normal(size=np.prod(count))
    found = _information(solved(np.ones((len(errors), 1)), errors), scenes)
    means = errors.reshape(count).mean(axis=1)
    np.testing.assert_allclose(found, count[0] / np.var(means, ddof=1))


def test_copies_within_a_piece_divide_what_many_rows_would_say(scenes, count, rng):
    """All rows of a piece equal: the information is that of one row of each, times its scatter."""
    single, error = rng.normal(size=(count[0], 2)), rng.normal(size=count[0])
    repeated = solved(np.repeat(single, count[1], axis=0), np.repeat(error, count[1]))
    found = _information(repeated, scenes)
    normal = single.T @ single
    scores = single * repeated.rows[:: count[1], None]
    scatter = scores.T @ scores * count[0] / (count[0] - 1)
    own = np.trace(np.linalg.solve(normal, scatter)) / 2
    assert own == pytest.approx(1.0, abs=0.5)
    np.testing.assert_allclose(found, normal / own)


def test_independent_errors_leave_the_normal_matrix(scenes, count, rng):
    """One factor for all numbers, of one within sampling and never below."""
    factors = []
    for _ in range(60):
        jacobian = rng.normal(size=(np.prod(count), 4)) * [1.0, 0.1, 10.0, 3.0]
        found = _information(solved(jacobian, rng.normal(size=len(jacobian))), scenes)
        normal = jacobian.T @ jacobian
        factors.append(normal[0, 0] / found[0, 0])
        np.testing.assert_allclose(factors[-1] * found, normal)
    assert min(factors) == 1.0
    assert np.mean(factors) == pytest.approx(1.1, abs=0.1)


def test_errors_larger_than_noise_count_as_much(scenes, count):
    """Alternating signs: no piece leans to a side, and each is three standard deviations."""
    rows = np.prod(count)
    errors = 3.0 * np.where(np.arange(rows) % 2, 1.0, -1.0)
    found = _information(solved(np.ones((rows, 1)), errors), scenes)
    np.testing.assert_allclose(found, (rows - 1) / 9.0)


@pytest.mark.parametrize("held", [1, 3])
def test_values_held_at_a_bound_do_not_change_what_is_known_of_the_others(scenes, count, rng, held):
    """Their derivative is zero."""
    jacobian = np.repeat(rng.normal(size=(count[0], 2)), count[1], axis=0)
    errors = np.repeat(rng.normal(size=count[0]), count[1])
    alone = _information(solved(jacobian, errors), scenes)
    widened = np.hstack([jacobian, np.zeros((len(jacobian), held))])
    found = _information(solved(widened, errors), scenes)
    np.testing.assert_allclose(found[:2, :2], alone)
