"""Terrain carried through the image by a step of the robot, and its derivatives."""

import numpy as np

from terrain.calibration.carried_rays import carried_derivatives, carried_rays

DIFFERENCE = 1e-6


def made(seed, features=40):
    """Rays, mount and steps of a camera that looks down ahead."""
    rng = np.random.default_rng(seed)
    rays = np.column_stack([rng.uniform(-0.6, 0.6, features), rng.uniform(-0.5, 0.4, features)])
    values = np.array([rng.uniform(0.3, 2.0), 0.1, rng.uniform(0.1, 0.9), 0.3])
    place_m = rng.uniform(-0.4, 0.6, 2)
    steps = rng.normal(size=(features, 3)) * [0.3, 0.05, 0.2]
    return rays, values, place_m, steps


def test_derivatives_are_those_of_finite_differences():
    for seed in range(6):
        rays, values, place_m, steps = made(seed)
        here, slopes = carried_derivatives(rays, values, place_m, steps)
        np.testing.assert_array_equal(here, carried_rays(rays, values, place_m, steps))
        assert np.isfinite(here).all(axis=1).sum() > 15
        moved = [
            [carried_rays(rays, values + sign * axis, place_m, steps) for sign in (1, -1)]
            for axis in DIFFERENCE * np.eye(4)
        ] + [
            [carried_rays(rays, values, place_m, steps + sign * axis) for sign in (1, -1)]
            for axis in DIFFERENCE * np.eye(3)
        ]
        differences = [(more - less) / (2 * DIFFERENCE) for more, less in moved]
        for column, expected in enumerate(differences):
            known = np.isfinite(expected).all(axis=1)
            np.testing.assert_allclose(
                slopes[known, :, column], expected[known], rtol=2e-6, atol=2e-6
            )


def test_one_step_of_all_features_is_the_same_as_one_each():
    rays, values, place_m, steps = made(7)
    for of_one, of_each in zip(
        carried_derivatives(rays, values, place_m, steps[0]),
        carried_derivatives(rays, values, place_m, np.tile(steps[0], (len(rays), 1))),
        strict=True,
    ):
        np.testing.assert_allclose(of_one, of_each, rtol=0, atol=1e-12)
