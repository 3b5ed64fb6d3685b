"""Time of the contact simulator: 160 s at 50 Hz, one drive and fifty at once."""

from pathlib import Path

import numpy as np
import pytest

from odometry.simulation.commands import excitation
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.slope import Plane
from odometry.simulation.contact.vehicle import read_contact_vehicle

J8 = Path(__file__).parents[2] / "data" / "vehicles" / "j8.toml"


@pytest.mark.parametrize("drives", [1, 50])
@pytest.mark.parametrize("law", ["coulomb", "shear"])
def test_simulate_contact(benchmark, drives, law):
    vehicle = read_contact_vehicle(J8, {"law": law})
    seeds = [np.random.default_rng(seed) for seed in range(drives)]
    speeds = np.stack([excitation(160.0, 0.02, max_speed_m_s=1.0, rng=rng) for rng in seeds])
    drive = benchmark.pedantic(
        simulate_contact, (vehicle, speeds, 0.02), {"ground": Plane(0.1, 1.0)}, rounds=1
    )
    assert drive.poses_world.shape == (drives, 8001, 6)
