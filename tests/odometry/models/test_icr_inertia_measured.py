import numpy as np
import pytest

from odometry.errors import ParameterError
from odometry.installed import shipped_data
from odometry.models.icr import Icr
from odometry.models.icr_inertia import IcrInertia, IcrInertiaMeasured
from odometry.models.inputs import Inputs
from odometry.parameters import read_parameters

MODEL = IcrInertiaMeasured()
PRINTED = read_parameters(shipped_data() / "parameters" / "auriga_alpha.toml")  # Martinez 2017
AURIGA = PRINTED.terrains["hard_ground"].values
G = 9.80665


def at_rest(roll, pitch):
    """data/README.md: accel_x = -g sin(pitch), accel_y = g cos(pitch) sin(roll)."""
    return G * np.stack([-np.sin(pitch), np.cos(pitch) * np.sin(roll)], axis=-1)


def test_a_steady_motion_measured_is_a_steady_motion_predicted(rng):
    """Its origin accelerates by omega x v; the centre of mass by omega^2 r less (eq. 4 and 9)."""
    values = MODEL.pack(AURIGA)
    speeds, roll, pitch = rng.uniform(-1, 1, (200, 2)), *rng.uniform(-0.3, 0.3, (2, 200))
    predicted = IcrInertia().twist(values, Inputs(speeds))
    v_x, v_y, omega = predicted.T
    measured = np.stack([-omega * v_y, omega * v_x], axis=-1) + at_rest(roll, pitch)
    inputs = Inputs(speeds, roll, pitch, measured)
    np.testing.assert_allclose(MODEL.twist(values, inputs), predicted, atol=1e-11)


def test_gravity_is_no_inertia(rng):
    """A centre of mass in the middle and an accelerometer at rest: constant ICRs."""
    values = MODEL.pack({**AURIGA, "x_cm": 0.0, "y_cm": 0.0})
    roll, pitch = rng.uniform(-0.5, 0.5, (2, 50))
    inputs = Inputs(rng.uniform(-2, 2, (50, 2)), roll, pitch, at_rest(roll, pitch))
    icr = np.array([0.5502 - 0.106, -0.5502 - 0.106, 0.048, 1, 1])
    np.testing.assert_allclose(MODEL.twist(values, inputs), Icr().twist(icr, inputs), atol=1e-10)


def test_the_force_is_mass_times_acceleration():
    """Straight on: 258 * |(3, 4)| N, and no turn rate that carries it anywhere."""
    inputs = Inputs(np.array([1.0, 1.0]), accelerations_m_s2=np.array([3.0, 4.0]))
    force = MODEL.turn(MODEL.pack(AURIGA), inputs).indices.force_n
    np.testing.assert_allclose(force, 258.0 * 5)


def test_accelerations_are_needed():
    with pytest.raises(ParameterError, match=r"accel_x and accel_y.*none were recorded"):
        MODEL.twist(MODEL.pack(AURIGA), Inputs(np.array([0.1, 0.2])))
