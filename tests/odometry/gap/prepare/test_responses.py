"""First-order responses of windows against differences of the simulation itself."""

from dataclasses import replace

import numpy as np
import pytest

from odometry.effects.commands.wheel_scale import WheelScale
from odometry.effects.interface.corrected import Added
from odometry.effects.measurement.gyroscope_error import GyroscopeError
from odometry.effects.measurement.sensor_mount import LeverArm
from odometry.effects.unknown.residual import COMPONENTS, Residual
from odometry.gap.prepare import responses
from odometry.gap.prepare.responses import columns_of, simulated_scenes
from odometry.gap.prepare.simulate import whitened_residuals
from odometry.windows.dense.averaged import averaged_windows
from odometry.windows.dense.dense_noise import whitening

STEP = 1e-5
TERMS = tuple((component, number) for component in COMPONENTS for number in (0, 3))
SENSORS = (
    Added(LeverArm(), np.array([0.4, -0.2])),
    Added(GyroscopeError(), np.array([1.2, 0.001])),
)


@pytest.mark.parametrize("gyroscope", [False, True])
@pytest.mark.parametrize("sensors", [(), SENSORS], ids=["no sensor", "sensors"])
def test_they_are_the_derivatives_of_whitened_residuals(make_scene, known, gyroscope, sensors):
    """Over hills, late poses, beside another effect and what sensors do."""
    scene = averaged_windows(make_scene(11, lambda _, twist: twist, duration_s=40.0))
    if gyroscope:
        rates = np.sin(scene.time_s)
        scene = replace(scene, inputs=replace(scene.inputs, yaw_rate_rad_s=rates))
    base = replace(known.base, latency_s=0.07, gyro_latency_s=0.03)
    effects = (Added(WheelScale(), np.array([0.9, 1.05])), *sensors)
    white, residual = whitening(scene, known.noise), Residual("heading", TERMS, "speed")

    def rows(values):
        return whitened_residuals(base, (*effects, Added(residual, values)), [scene], [white])

    nothing = np.zeros(len(TERMS))
    expected = [(rows(STEP * axis) - rows(nothing)) / STEP for axis in np.eye(len(TERMS))]
    found = columns_of(residual, simulated_scenes(base, effects, [scene]), [white])
    np.testing.assert_allclose(found.T, expected, atol=2e-4 * np.abs(expected).max())


@pytest.mark.parametrize("samples", [1, 2500])
def test_a_few_columns_at_a_time_are_the_same(make_scene, known, monkeypatch, samples):
    """A long run is answered column by column, so that memory stays bounded."""
    scene = make_scene(11, lambda _, twist: twist, duration_s=40.0)
    white, residual = whitening(scene, known.noise), Residual("heading", TERMS, "speed")
    simulated = simulated_scenes(known.base, SENSORS, [scene])
    together = columns_of(residual, simulated, [white])
    sizes = []
    of_some = responses.Responses._of_some

    def watched(self, changes, rows):
        sizes.append(len(changes))
        of_some(self, changes, rows)

    monkeypatch.setattr(responses.Responses, "_of_some", watched)
    monkeypatch.setattr(responses, "MOST_SAMPLES", samples)
    np.testing.assert_array_equal(columns_of(residual, simulated, [white]), together)
    assert sum(sizes) == len(TERMS)
    assert max(sizes) == max(1, samples // len(scene.time_s))
