"""Medians of points that differ in certainty, and their intervals."""

import numpy as np

from odometry.icrs.measured import LEAST_WINDOWS, MeasuredIcrs, icr_medians


def points(icrs, *, sigma_m=0.1, run="one", terrain="yard", omega=1.0):
    """Windows with these ICRs (K, 3)."""
    count = len(icrs)
    sigma_m = np.broadcast_to(sigma_m, count)
    return MeasuredIcrs(
        np.arange(count, dtype=float),
        np.ones(count),
        np.broadcast_to(np.array(run, dtype=object), count),
        np.broadcast_to(np.array(terrain, dtype=object), count),
        np.column_stack([np.ones(count), np.zeros(count), np.broadcast_to(omega, count)]),
        np.ones((count, 2)),
        np.asarray(icrs, dtype=float),
        np.square(sigma_m)[:, None, None] * np.eye(3),
    )


def scattered(seed, count=40, offset=0.0):
    rng = np.random.default_rng(seed)
    return np.array([0.5, -0.4, 0.1]) + offset + 0.1 * rng.standard_t(2, size=(count, 3))


def test_a_median_counts_points_by_their_certainty():
    """Three poor points beside one good one: the good one has more than half of the weight."""
    (median,) = icr_medians(
        points(np.outer([1, 2, 3, 9], np.ones(3)), sigma_m=[1.0, 1.0, 1.0, 0.3])
    )
    np.testing.assert_array_equal(median.icrs, 9)
    assert np.isnan(median.low).all()
    assert np.isnan(median.high).all()


def test_terrains_and_sides_are_apart():
    terrain = ["mud"] * 20 + ["sand"] * 10
    omega = [1.0] * 20 + [-1.0] * 10
    medians = icr_medians(points(scattered(1, 30), terrain=terrain, omega=omega))
    assert [(m.terrain, m.side, m.windows) for m in medians] == [
        ("mud", "left", 20),
        ("sand", "right", 10),
    ]
    assert np.isfinite(medians[1].low).all()
    assert LEAST_WINDOWS == 10


def test_intervals_hold_the_truth():
    """Heavy tails, 40 points: 95 % of the intervals, within the error of 100 draws."""
    holds = []
    for seed in range(100):
        (median,) = icr_medians(points(scattered(seed)))
        holds.append((median.low < [0.5, -0.4, 0.1]) & (median.high > [0.5, -0.4, 0.1]))
    assert 0.87 < np.mean(holds) < 0.99


def test_runs_that_differ_widen_the_interval():
    icrs = np.concatenate([scattered(1), scattered(2, offset=0.3), scattered(3, offset=0.6)])
    runs = ["one"] * 40 + ["two"] * 40 + ["three"] * 40
    (apart,) = icr_medians(points(icrs, run=runs))
    (together,) = icr_medians(points(icrs[np.random.default_rng(0).permutation(120)]))
    assert (apart.high - apart.low > 1.5 * (together.high - together.low)).all()


def test_the_same_seed_gives_the_same_interval():
    (first,), (second,) = (icr_medians(points(scattered(1)), seed=3) for _ in range(2))
    np.testing.assert_array_equal(first.low, second.low)
