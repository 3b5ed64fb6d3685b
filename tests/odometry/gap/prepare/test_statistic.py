"""The gap and its interval, beside their definitions."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.gap.prepare.pieces import pieces
from odometry.gap.prepare.simulate import simulated_poses
from odometry.gap.prepare.statistic import Gap, drawn_gaps, floor_of, gap_of, squared_errors
from odometry.geometry import se2


@pytest.fixture
def exact(make_scene, known):
    """Poses are exactly those of the simulation."""
    scene = make_scene(80, duration_s=100.0)
    return replace(scene, poses=simulated_poses(known.base, (), scene))


def displaced(scene, offsets_m):
    """The last pose of each window is off by this much; windows then share no pose."""
    apart = scene.where(np.arange(len(scene)) % 2 == 0)
    poses = apart.poses.copy()
    off = np.stack([offsets_m, 0 * offsets_m, 0 * offsets_m], axis=-1)
    lasts = apart.windows[:, -1]
    poses[lasts] = se2.compose(poses[lasts], off)
    return replace(apart, poses=poses)


def test_the_gap_is_the_rms_distance_at_the_ends(exact, known, rng):
    offsets_m = rng.normal(size=(len(exact) + 1) // 2)
    scene = displaced(exact, offsets_m)
    errors = squared_errors(known.base, (), scene)
    np.testing.assert_allclose(errors, offsets_m**2, atol=1e-12)
    gap = gap_of(known.base, (), [scene], 10.0)
    assert gap.value == pytest.approx(np.sqrt((offsets_m**2).mean()))
    assert gap.low < gap.value < gap.high


def test_the_gap_of_several_runs_is_that_of_all_their_windows(make_scene, known):
    scenes = [make_scene(81, duration_s=100.0), make_scene(82, duration_s=30.0)]
    errors = np.concatenate([squared_errors(known.base, (), scene) for scene in scenes])
    gap = gap_of(known.base, (), scenes, 10.0)
    assert gap.value == pytest.approx(np.sqrt(errors.mean()))
    assert gap == gap_of(known.base, (), scenes, 10.0)


def test_equal_errors_leave_no_doubt(exact, known):
    gap = gap_of(known.base, (), [displaced(exact, np.full((len(exact) + 1) // 2, 0.3))], 10.0)
    assert (gap.value, gap.low, gap.high) == pytest.approx((0.3, 0.3, 0.3))


def test_the_interval_is_that_of_the_mean_of_pieces(make_scene, known):
    """Beside the normal approximation, for a run of 64 pieces."""
    scene = make_scene(83, duration_s=640.0)
    errors = squared_errors(known.base, (), scene)
    places = pieces(scene, 10.0)
    means = np.array([errors[places == p].mean() for p in np.unique(places)])
    sigma = means.std(ddof=1) / np.sqrt(len(means))
    gap = gap_of(known.base, (), [scene], 10.0)
    expected = np.sqrt(errors.mean() + 1.96 * sigma * np.array([-1, 1]))
    half = (expected[1] - expected[0]) / 2
    assert [gap.low, gap.high] == pytest.approx(expected, abs=0.2 * half)


def test_windows_of_one_piece_are_drawn_together(exact, known):
    """A bad piece of ten seconds widens the interval more than as many bad windows apart."""
    count = (len(exact) + 1) // 2
    together = np.where(np.arange(count) < 5, 1.0, 0.01)
    apart = np.where(np.arange(count) % 5 == 0, 1.0, 0.01)
    widths = []
    for offsets_m in (together, apart):
        gap = gap_of(known.base, (), [displaced(exact, offsets_m)], 20.0)
        widths.append(gap.high - gap.low)
    assert widths[0] > 2 * widths[1]


def test_each_stretch_of_the_floor_has_its_own_base(exact, known):
    other = replace(known.base, values=known.base.values * [1, 1, 1, 0.9, 0.9])
    own = replace(exact, poses=simulated_poses(other, (), exact))
    exactly = floor_of([(known.base, exact), (other, own)], 10.0)
    assert exactly.value < 1e-9
    assert floor_of([(other, exact), (known.base, own)], 10.0).value > 0.03


def test_kinds_of_errors_are_drawn_together(make_scene, rng):
    """Errors twice as large make every drawn gap twice as large, whatever is drawn."""
    scenes = [make_scene(81, duration_s=100.0), make_scene(82, duration_s=30.0)]
    squares = rng.uniform(size=sum(map(len, scenes)))
    once, twice = drawn_gaps((squares, 4 * squares), scenes, 10.0, rng)
    np.testing.assert_allclose(twice, 2 * once)
    assert np.ptp(once) > 0.1


def test_two_runs_of_one_piece_are_drawn_as_two(make_scene, rng):
    """One is right, one is 1 m off: gaps of 0, of both, and of 1 m as a fair coin has them."""
    scenes = [make_scene(seed, duration_s=15.0) for seed in (81, 82)]
    squares = np.repeat([0.0, 1.0], [len(scene) for scene in scenes])
    assert len(scenes[0]) == len(scenes[1])
    (drawn,) = drawn_gaps((squares,), scenes, 100.0, rng)
    values, counts = np.unique(np.round(drawn, 12), return_counts=True)
    np.testing.assert_allclose(values, [0.0, np.sqrt(0.5), 1.0])
    np.testing.assert_allclose(counts / counts.sum(), [0.25, 0.5, 0.25], atol=0.05)


def test_one_stretch_has_no_interval(exact, known):
    scene = displaced(exact, np.full((len(exact) + 1) // 2, 0.3))
    one, several = (gap_of(known.base, (), [scene], part_s) for part_s in (1000.0, 10.0))
    floor = Gap(0.1, 0.08, 0.12)
    assert (one.pieces, one.has_interval, one.is_above(floor)) == (1, False, False)
    assert (several.pieces, several.has_interval, several.is_above(floor)) == (10, True, True)
    assert not several.is_above(Gap(0.4, 0.3, 0.5))
