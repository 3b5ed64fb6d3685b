"""What friction, gravity and inertia must do, whatever the equations."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

from odometry.errors import ParameterError
from odometry.models.contact import Contact
from odometry.models.inputs import Inputs
from odometry.recording.run import Robot

MODEL = Contact()
NAMES = [parameter.name for parameter in MODEL.parameters]
CREEP = 1e-5  # speeds are multiplied by this where centrifugal force shall not matter
ROBOT = {
    "mu": 0.6,
    "mass": 40.0,
    "x_cm": 0.0,
    "y_cm": 0.0,
    "height": 0.15,
    "half_length": 0.3,
    "half_width": 0.25,
    "contacts": 3.0,
    "slip_scale": 0.02,
}


def twist(speeds, roll=0.0, pitch=0.0, **changes):
    values = MODEL.pack(ROBOT | changes)
    return MODEL.twist(values, Inputs(np.array(speeds, float), np.asarray(roll), np.asarray(pitch)))


def creeping(speeds, roll=0.0, pitch=0.0, **changes):
    """Twist without centrifugal force, in the units of the speeds given."""
    p = ROBOT | changes
    slow = p | {"slip_scale": CREEP * p["slip_scale"]}
    return twist(CREEP * np.array(speeds, float), roll, pitch, **slow) / CREEP


def least_power(p, speeds, loads, roll=0.0, pitch=0.0):
    """Twist that minimises the power of friction less that of gravity, by Nelder and Mead."""
    n = int(p["contacts"])
    forward = np.tile(np.linspace(-1, 1, n), 2) * p["half_length"]
    side = np.repeat([1, -1], n) * p["half_width"]
    tread = np.repeat(speeds, n)
    pull = [math.sin(pitch), -math.cos(pitch) * math.sin(roll)]

    def power(at):
        v_x, v_y, omega = at
        slip = np.hypot(v_x - omega * side - tread, v_y + omega * forward)
        gained = pull[0] * (v_x - omega * p["y_cm"]) + pull[1] * (v_y + omega * p["x_cm"])
        return p["mu"] * loads @ np.hypot(slip, p["slip_scale"]) - gained

    at = np.array([np.mean(speeds), 0.0, (speeds[1] - speeds[0]) / p["half_width"] / 4])
    options = {"xatol": 1e-10, "fatol": 1e-16, "maxiter": 4000, "maxfev": 4000}
    for _ in range(3):  # a simplex may collapse early: begin again where it did
        at = minimize(power, at, method="Nelder-Mead", options=options).x
    return at


@pytest.mark.parametrize("v", [-0.7, 0.0, 1.3])
def test_equal_treads_drive_straight_on_level_ground(v):
    np.testing.assert_allclose(twist([v, v], x_cm=0.1, y_cm=-0.05), [v, 0, 0], atol=1e-14)


@pytest.mark.parametrize("slip_scale", [1e-3, 0.02, 0.3])
def test_four_wheels_on_the_spot(slip_scale):
    """By hand: (v - omega b)^2 + (omega a)^2 is least at omega = v b / (a^2 + b^2)."""
    a, b, v = ROBOT["half_length"], ROBOT["half_width"], 0.5
    expected = [0, 0, v * b / (a**2 + b**2)]
    seen = creeping([-v, v], contacts=2, slip_scale=slip_scale)
    np.testing.assert_allclose(seen, expected, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("contacts", [2, 3, 6])
def test_the_twist_takes_least_power(contacts, rng):
    """Loads that do not depend on the motion: the centre of mass lies on the ground."""
    for _ in range(4):
        p = ROBOT | {"contacts": float(contacts), "height": 0.0}
        p["x_cm"], p["y_cm"] = rng.uniform(-0.05, 0.05, 2)
        forward = np.tile(np.linspace(-1, 1, contacts), 2)
        side = np.repeat([1, -1], contacts)
        loads = 0.5 / contacts * (1 + side * p["y_cm"] / p["half_width"])
        loads += forward * p["x_cm"] / p["half_length"] / np.sum(forward**2)
        speeds, (roll, pitch) = rng.uniform(-1, 1, 2), rng.uniform(-0.2, 0.2, 2)
        normal = math.cos(roll) * math.cos(pitch)
        expected = least_power(p, speeds, normal * loads, roll, pitch)
        np.testing.assert_allclose(creeping(speeds, roll, pitch, **p), expected, atol=1e-6)


def test_friction_shows_on_a_slope_alone():
    """Creeping on level ground, mu and height change nothing; on a slope, and at speed, they do."""
    speeds = [-0.2, 0.6]
    level = creeping(speeds, x_cm=0.04)
    for change in ({"mu": 0.3}, {"mu": 1.2}, {"height": 0.5}):
        np.testing.assert_allclose(creeping(speeds, x_cm=0.04, **change), level, atol=1e-6)
        for roll, factor in ((0.15, 1), (0.0, 4)):
            fast = factor * np.array(speeds)
            moved = twist(fast, roll, x_cm=0.04, **change) - twist(fast, roll, x_cm=0.04)
            assert np.abs(moved).max() > 1e-3


@given(
    speeds=st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5)),
    angles=st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3)),
    centre=st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1)),
)
def test_symmetry_of_the_contacts(speeds, angles, centre):
    """Mirrored, and with front and rear exchanged."""
    (left, right), (roll, pitch), (x_cm, y_cm) = speeds, angles, centre
    v_x, v_y, omega = twist([left, right], roll, pitch, x_cm=x_cm, y_cm=y_cm)
    mirrored = twist([right, left], -roll, pitch, x_cm=x_cm, y_cm=-y_cm)
    np.testing.assert_allclose(mirrored, [v_x, -v_y, -omega], atol=1e-10)
    reversed_ = twist([-left, -right], roll, -pitch, x_cm=-x_cm, y_cm=y_cm)
    np.testing.assert_allclose(reversed_, [-v_x, v_y, -omega], atol=1e-10)


def drift(slope, **changes):
    """Downhill and level speed on a plane, at 24 headings of a turn on the spot."""
    heading = np.linspace(0, 2 * math.pi, 24, endpoint=False)
    pitch = np.arcsin(math.sin(slope) * np.cos(heading))  # at heading 0 the nose points downhill
    roll = np.arcsin(math.sin(slope) * np.sin(heading) / np.cos(pitch))
    v_x, v_y, _ = twist(np.tile([-0.4, 0.4], (24, 1)), roll, pitch, **changes).T
    down = v_x * np.cos(heading) - v_y * np.sin(heading)
    return down, v_x * np.sin(heading) + v_y * np.cos(heading)


def test_a_turning_robot_drifts_downhill():
    """At every heading, on average straight down the more the steeper and smoother the ground."""
    down, across = drift(0.1)
    assert np.all(down > 0)
    assert abs(across.mean()) < 0.2 * down.mean()
    assert down.mean() < drift(0.2)[0].mean() < drift(0.3)[0].mean()
    assert drift(0.1, mu=0.9)[0].mean() < down.mean() < drift(0.1, mu=0.3)[0].mean()


def test_cornering_drifts_outwards():
    """The centrifugal force of a left turn points to the right (Martinez 2017 eq. 10)."""
    assert twist([0.8, 1.6])[1] < creeping([0.8, 1.6])[1] - 1e-3


def test_slow_speeds_scale():
    """Coulomb friction is the same at any speed: slip_scale scales with all speeds, not gravity."""
    once = creeping([0.1, 0.5], 0.1, -0.1, slip_scale=0.02)
    thrice = creeping([0.3, 1.5], 0.1, -0.1, slip_scale=0.06)
    np.testing.assert_allclose(thrice, 3 * once, rtol=1e-8)


@pytest.mark.parametrize("factor", [0.5, 4.0])
def test_froude_similarity(factor):
    """Lengths by f and speeds by sqrt(f) leave every force: exact, inertia included."""
    lengths = ("x_cm", "y_cm", "height", "half_length", "half_width")
    p = ROBOT | {"x_cm": 0.03, "y_cm": 0.02}
    scaled = {name: value * factor for name, value in p.items() if name in lengths}
    root = math.sqrt(factor)
    seen = twist(root * np.array([0.4, 1.4]), 0.1, 0.05, **scaled, slip_scale=0.02 * root)
    expected = twist([0.4, 1.4], 0.1, 0.05, **p) * [root, root, 1 / root]
    np.testing.assert_allclose(seen, expected, rtol=1e-11)


@pytest.mark.parametrize("slope", [0.05, 0.3])
def test_a_robot_at_rest_creeps_as_documented(slope):
    """slip_scale tan / sqrt(mu^2 - tan^2), straight down."""
    speed = 0.02 * math.tan(slope) / math.sqrt(0.6**2 - math.tan(slope) ** 2)
    np.testing.assert_allclose(twist([0, 0], pitch=slope), [speed, 0, 0], atol=1e-12)
    np.testing.assert_allclose(twist([0, 0], roll=slope), [0, -speed, 0], atol=1e-12)


def test_beyond_friction_a_slope_is_taken_as_the_steepest_that_holds():
    """Forces along and into the ground then have one ratio: so has what they do to slow speeds."""
    limit = math.atan(0.95 * 0.6)
    steepest = creeping([0.2, 0.5], roll=limit, height=0.0)
    np.testing.assert_allclose(
        creeping([0.2, 0.5], roll=limit - 1e-9, height=0.0), steepest, atol=1e-6
    )
    for roll in (limit + 0.01, 0.7, 1.2):
        np.testing.assert_allclose(creeping([0.2, 0.5], roll=roll, height=0.0), steepest, atol=1e-9)


def test_the_mass_cancels():
    a, b = (twist([0.2, 1.1], 0.1, 0.2, mass=mass) for mass in (1.0, 5000.0))
    np.testing.assert_array_equal(a, b)
    jacobian = MODEL.parameter_jacobian(MODEL.pack(ROBOT), Inputs(np.array([0.2, 1.1])))
    assert not np.any(jacobian[:, [NAMES.index("mass"), NAMES.index("contacts")]])


@pytest.mark.parametrize(("name", "value"), [("x_cm", 0.28), ("y_cm", -0.23)])
def test_a_centre_of_mass_outside_the_contacts_is_refused(name, value):
    with pytest.raises(ParameterError, match=rf"{name} = {value}.*tip over"):
        MODEL.pack(ROBOT | {name: value})


def test_a_centre_of_mass_outside_the_contacts_is_held_at_their_edge():
    """For a search that strays: as at 0.9 of the base, with the derivatives of that."""
    inputs = Inputs(np.array([0.2, 0.9]), np.array(0.05), np.array(0.1))
    inside, outside = MODEL.pack(ROBOT | {"x_cm": 0.27}), MODEL.pack(ROBOT)
    outside[NAMES.index("x_cm")] = 0.4
    np.testing.assert_allclose(MODEL.twist(outside, inputs), MODEL.twist(inside, inputs))
    numeric = [
        (MODEL.twist(outside + e, inputs) - MODEL.twist(outside - e, inputs)) / 2e-6
        for e in 1e-6 * np.eye(9)
    ]
    exact = MODEL.parameter_jacobian(outside, inputs)
    np.testing.assert_allclose(exact, np.transpose(numeric), rtol=1e-6, atol=1e-7)
    np.testing.assert_array_equal(exact[:, NAMES.index("x_cm")], 0)


def test_guesses():
    bare = MODEL.guess(Robot(0.4))
    assert (bare["half_width"], bare["half_length"], bare["mass"]) == (0.2, 0.2, 1.0)
    measured = MODEL.guess(Robot(0.4, length=1.0, mass=35.0))
    assert (measured["half_length"], measured["mass"]) == (0.35, 35.0)
