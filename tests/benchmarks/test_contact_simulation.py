"""Time of the contact simulator: 20 s at 50 Hz, one drive and fifty at once.

Its figure is the time of the processor, which bears a busy machine better.
"""

import time
from pathlib import Path

import numpy as np
import pytest

from odometry.simulation.commands import excitation
from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.slope import Plane
from odometry.simulation.contact.vehicle import read_contact_vehicle

J8 = Path(__file__).parents[2] / "data" / "vehicles" / "j8.toml"
LASTS_S, STEP_S = 20.0, 0.02


@pytest.mark.parametrize("drives", [1, 50])
@pytest.mark.parametrize("law", ["coulomb", "shear"])
def test_simulate_contact(benchmark, drives, law):
    vehicle = read_contact_vehicle(J8, {"law": law})
    seeds = [np.random.default_rng(seed) for seed in range(drives)]
    speeds = np.stack([excitation(LASTS_S, STEP_S, max_speed_m_s=1.0, rng=rng) for rng in seeds])
    spent_s = []

    def drives_once():
        started = time.process_time()
        found = simulate_contact(vehicle, speeds, STEP_S, ground=Plane(0.1, 1.0))
        spent_s.append(time.process_time() - started)
        return found

    drive = benchmark.pedantic(drives_once, rounds=3)
    assert drive.poses_world.shape == (drives, round(LASTS_S / STEP_S) + 1, 6)
    benchmark.extra_info["figure"] = drives * LASTS_S / sorted(spent_s)[1]
