import math

import pytest

from odometry.errors import ConfigError
from odometry.identification.start import SolverConfig
from odometry.windows.config import WindowConfig


@pytest.mark.parametrize(
    "name", ["horizon_m", "stride", "pose_gap_s", "position_sigma_m", "yaw_sigma_rad"]
)
@pytest.mark.parametrize("value", [0.0, -1.0, math.inf, math.nan])
def test_lengths_times_and_deviations_are_finite_and_above_zero(name, value):
    with pytest.raises(ConfigError, match=f"{name} = {value}"):
        WindowConfig(**{name: value})


@pytest.mark.parametrize("value", [-0.1, math.nan])
def test_a_temporal_horizon_is_not_negative(value):
    with pytest.raises(ConfigError, match="horizon_s"):
        WindowConfig(horizon_s=value)


@pytest.mark.parametrize("value", [0.0, 1.1, math.nan])
def test_the_shortest_window_is_a_share(value):
    with pytest.raises(ConfigError, match="shortest"):
        WindowConfig(shortest=value)


@pytest.mark.parametrize(
    "settings", [{"loss": "cauchy"}, {"starts": 0}, {"undetermined": 0.0}, {"undetermined": -1.0}]
)
def test_settings_of_the_solver_are_checked(settings):
    (name,) = settings
    with pytest.raises(ConfigError, match=name):
        SolverConfig(**settings)
