"""The contact model against statics in three dimensions, written out in plain loops."""

import itertools
import math

import numpy as np
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from odometry.models.contact import Contact
from odometry.models.contact_balance import balance_at
from odometry.models.contact_stance import stance_of
from odometry.models.inputs import Inputs

MODEL = Contact()
G = 9.80665

robots = st.fixed_dictionaries(
    {
        "mu": st.floats(0.3, 1.2),
        "mass": st.floats(5, 500),
        "x_cm": st.floats(-0.1, 0.1),
        "y_cm": st.floats(-0.1, 0.1),
        "height": st.floats(0, 0.5),
        "half_length": st.floats(0.2, 0.8),
        "half_width": st.floats(0.2, 0.8),
        "contacts": st.integers(2, 4).map(float),
        "slip_scale": st.floats(0.005, 0.1),
    }
)
speed = st.floats(-1.5, 1.5)
treads = st.one_of(
    st.tuples(speed, speed), speed.map(lambda v: (v, v)), speed.map(lambda v: (v, -v))
)
angle = st.floats(-0.25, 0.25)


def places(p):
    """Contacts (x, y, tread), left then right, rear to front."""
    n = int(p["contacts"])
    return [
        (p["half_length"] * (2 * k / (n - 1) - 1), sign * p["half_width"], tread)
        for tread, sign in ((0, 1), (1, -1))
        for k in range(n)
    ]


def body_forces(p, roll, pitch, twist):
    """Gravity and the force of inertia [N] on the centre of mass, in body axes."""
    v = np.array([twist[0], twist[1], 0.0])
    omega = np.array([0.0, 0.0, twist[2]])
    centre = np.array([p["x_cm"], p["y_cm"], p["height"]])
    down = Rotation.from_euler("ZYX", [0.4, pitch, roll]).inv().apply([0, 0, -G])
    acceleration = np.cross(omega, v + np.cross(omega, centre))
    return p["mass"] * down, -p["mass"] * acceleration, centre


def friction(p, place, speeds, twist, load):
    x, y, tread = place
    slip = (twist[0] - twist[2] * y - speeds[tread], twist[1] + twist[2] * x)
    size = math.sqrt(slip[0] ** 2 + slip[1] ** 2 + p["slip_scale"] ** 2)
    return [-p["mu"] * load * part / size for part in slip]


def unilateral_springs(p, force, centre):
    """Loads [N] under a force at the centre of mass: every set of bearing contacts is tried."""
    points = [(1.0, x, y) for x, y, _ in places(p)]
    pressure = centre[:2] - centre[2] / force[2] * force[:2]  # where its line meets the ground
    wanted = -force[2] * np.array([1.0, *pressure])
    everyone = range(len(points))
    for lifted in itertools.chain.from_iterable(
        itertools.combinations(everyone, k) for k in range(len(points) - 2)
    ):
        bearing = [points[i] for i in everyone if i not in lifted]
        matrix = np.transpose(bearing) @ bearing
        if np.linalg.matrix_rank(matrix) < 3:
            continue
        plane = np.linalg.solve(matrix, wanted)
        deflections = [float(np.dot(plane, point)) for point in points]
        if all((deflections[i] <= 1e-9) == (i in lifted) for i in everyone):
            return [max(0.0, deflection) for deflection in deflections]
    return None


def total(p, speeds, twist, loads, body):
    """Force and moment about the origin [N, N m] of all forces on the robot."""
    force, centre = body
    forces, moment = np.array(force), np.cross(centre, force)
    for place, load in zip(places(p), loads, strict=True):
        contact = np.array([*friction(p, place, speeds, twist, load), load])
        forces += contact
        moment += np.cross([place[0], place[1], 0.0], contact)
    return np.concatenate([forces, moment])


@given(p=robots, speeds=treads, roll=angle, pitch=angle)
def test_all_forces_and_moments_balance(p, speeds, roll, pitch):
    """With loads that statics alone gives for the model's twist, to 1e-9 of the weight."""
    assume(math.hypot(math.tan(pitch), math.tan(roll) / math.cos(pitch)) < 0.94 * p["mu"])
    twist = MODEL.twist(MODEL.pack(p), Inputs(np.array(speeds), np.array(roll), np.array(pitch)))
    gravity, inertia, centre = body_forces(p, roll, pitch, twist)
    force = gravity + inertia
    pressure = centre[:2] - centre[2] / force[2] * force[:2]
    assume(np.all(np.abs(pressure) < 0.94 * np.array([p["half_length"], p["half_width"]])))
    loads = unilateral_springs(p, force, centre)
    rest = total(p, speeds, twist, loads, (force, centre))
    assert np.max(np.abs(rest)) < 1e-9 * p["mass"] * G


@given(p=robots, speeds=treads, roll=angle, pitch=angle, moved=st.tuples(speed, speed, speed))
def test_what_is_left_over_at_any_twist(p, speeds, roll, pitch, moved):
    """The model's own loads carry the weight, and nothing tips; its residual is all the rest."""
    inputs = Inputs(np.array([speeds]), np.array([roll]), np.array([pitch]))
    stance = stance_of(MODEL.pack(p)[None], inputs)
    balance = balance_at(stance, np.array(moved)[:, None])
    assume(not stance.held[0])
    assume(balance.reach[0] == 1)
    gravity, inertia, centre = body_forces(p, roll, pitch, moved)
    loads = balance.load[:, 0] * p["mass"] * G
    rest = total(p, speeds, moved, loads, (gravity + inertia, centre)) / (p["mass"] * G)
    np.testing.assert_allclose(rest[[2, 3, 4]], 0, atol=1e-13)
    np.testing.assert_allclose(balance.residual[:, 0], rest[[0, 1, 5]], atol=1e-13)
    assert np.all(loads >= 0)
