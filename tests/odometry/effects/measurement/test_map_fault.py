"""A map that is stretched, turns or drifts, and a yaw that drifts."""

import numpy as np
import pytest

from odometry.effects.measurement.map_fault import (
    DriftingMap,
    DriftingYaw,
    StretchedMap,
    TurningMap,
)
from odometry.geometry import se2
from tests.odometry.effects.reports import PERIOD_S, reported

COUNT = 60
STAMPS_S = PERIOD_S * np.arange(COUNT)
FAULTS = [
    (StretchedMap(), np.array([0.08, -0.05, 0.02])),
    (TurningMap(), np.array([0.02])),
    (DriftingMap(2), np.array([0.3, 0.1, -0.05, 0.2])),
    (DriftingYaw(2), np.array([0.01, -0.03])),
]


def driven(rng):
    """Poses of a robot on the map, far from its origin."""
    steps = np.column_stack([rng.uniform(0, 0.2, (COUNT, 1)), rng.uniform(-0.05, 0.3, (COUNT, 2))])
    poses = [np.array([20.0, -30.0, 0.5])]
    for step in steps[1:]:
        poses.append(se2.compose(poses[-1], step))
    return np.array(poses)


def on_the_faulty_map(effect, values, true):
    """By the equations, written once more."""
    x, y, yaw = true.T
    t = STAMPS_S
    if isinstance(effect, StretchedMap):
        e_xx, e_yy, e_xy = values
        return np.column_stack([x + e_xx * x + e_xy * y, y + e_xy * x + e_yy * y, yaw])
    if isinstance(effect, TurningMap):
        cos, sin = np.cos(values[0] * t), np.sin(values[0] * t)
        return np.column_stack([cos * x - sin * y, sin * x + cos * y, yaw + values[0] * t])
    if isinstance(effect, DriftingMap):
        return np.column_stack([x + values[2] * t, y + values[3] * t, yaw])
    return np.column_stack([x, y, yaw + values[1] * t])


@pytest.mark.parametrize(("effect", "values"), FAULTS, ids=lambda one: getattr(one, "form", ""))
def test_poses_of_the_robot_are_the_inverse(rng, effect, values):
    true = driven(rng)
    faulty = on_the_faulty_map(effect, values, true)
    found = effect.robot_poses(values, reported(faulty, run=1))
    np.testing.assert_allclose(found, true, atol=1e-9)


@pytest.mark.parametrize(("effect", "values"), FAULTS, ids=lambda one: getattr(one, "form", ""))
def test_a_drive_from_the_origin_moves_as_it_is_reported(rng, effect, values):
    """Motion from any pose to any later one, in the frame of the first."""
    true = driven(rng)
    faulty = on_the_faulty_map(effect, values, true)
    simulated = se2.between(true[0], true)
    simulated[:, 2] = true[:, 2] - true[0, 2]
    seen = effect.seen(values, simulated, reported(faulty, run=1))
    for first in (0, 20, 41):
        expected = se2.between(faulty[first], faulty[first:])
        found = se2.between(seen[first], seen[first:])
        np.testing.assert_allclose(found, expected, atol=1e-9)


def test_noise_of_the_places_has_no_part_in_the_error(rng):
    """Else a map that shrinks would shrink the noise with it."""
    true, values = driven(rng), np.array([0.3, 0.3, 0.0])
    noisy = true + np.column_stack([rng.normal(0, 0.1, (COUNT, 2)), np.zeros(COUNT)])
    simulated = se2.between(true[0], true)
    simulated[:, 2] = true[:, 2] - true[0, 2]
    clean, other = (StretchedMap().seen(values, simulated, reported(of)) for of in (true, noisy))
    np.testing.assert_allclose(np.diff(other, axis=0), np.diff(clean, axis=0), atol=1e-12)


@pytest.mark.parametrize("effect", [DriftingMap(1), DriftingYaw(1)])
def test_values_of_one_run_say_nothing_of_another(rng, effect):
    poses = driven(rng)
    values = np.full(len(effect.parameters), 0.1)
    for run in (1, None):
        assert (effect.robot_poses(values, reported(poses, run)) == poses).all()
    assert effect.with_run().parameters[0].name.endswith("_of_1")
