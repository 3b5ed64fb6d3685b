"""A robot, its model, and inputs that hold new commands at uneven stamps on tilted ground."""

from types import SimpleNamespace

import numpy as np
import pytest

from odometry.effects.interface.base_model import Base
from odometry.models.catalogue import MODELS
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

ROBOT = Robot(0.6, length=0.8)
VALUES = np.array([0.45, -0.38, 0.07, 0.95, 0.9])


def drive(rng, count=200, *, highest_m_s=1.2, tilt_rad=0.15):
    """Samples of about 50 Hz: commands held for a while, roll and pitch, labels, headings."""
    time_s = np.cumsum(rng.uniform(0.005, 0.035, count))
    time_s -= time_s[0]
    commands = rng.uniform(-highest_m_s, highest_m_s, (-(-count // 15), 2))
    return Inputs(
        np.repeat(commands, 15, axis=0)[:count],
        *rng.uniform(-tilt_rad, tilt_rad, (2, count)),
        rng.uniform(-1, 1, (count, 2)),
        time_s,
        np.where(np.arange(count) < count // 2, "sand", "ice").astype(object),
        rng.uniform(-4, 4, count),
        rng.uniform(-9, 9, (count, 2)),
    )


@pytest.fixture
def bench():
    """The robot, its base, and the function above."""
    return SimpleNamespace(
        robot=ROBOT, values=VALUES, base=Base(MODELS["icr"], VALUES, ROBOT), drive=drive
    )
