"""ICRs moved by inertia against a scalar program in the paper's own frame."""

import numpy as np
import pytest
from scipy.optimize import brentq

from odometry.installed import shipped_data
from odometry.models.icr import Icr
from odometry.models.icr_inertia import IcrInertia
from odometry.models.inertia_forces import LEAST_ETA
from odometry.models.inputs import Inputs
from odometry.parameters import read_parameters

MODEL = IcrInertia()
PRINTED = read_parameters(shipped_data() / "parameters" / "auriga_alpha.toml")  # Martinez 2017
AURIGA = PRINTED.terrains["hard_ground"].values
G = 9.80665


def paper_motion(p, F, V_l, V_r):
    """Martinez 2017 eq. 14-15, 25-27 and 20-22 under |F|: v_x to the right, v_y ahead, omega."""
    x_1, x_2 = V_l - V_r, V_l + p["h"] * V_r
    zeta = p["zeta_0"] + p["zeta_1"] * F * np.sign(x_2)
    epsilon = p["epsilon_0"] + p["epsilon_1"] * F * np.sign(x_1) * np.sign(x_2)
    eta = p["eta_0"] + p["eta_1"] * F * np.sign(x_1) * np.sign(x_2) + p["eta_2"] * F**2
    omega = (V_r - V_l) / (p["track_width"] * eta)
    return omega * zeta, (V_l + V_r) / 2 - omega * epsilon, omega


def paper_force(p, motion):
    """Eq. 11; the centre of mass lies (-0.015, 0.04) from the origin, to the right and ahead."""
    v_x, v_y, omega = motion
    x_CM, y_CM = -p["y_cm"], p["x_cm"]
    lever = (v_y + x_CM * omega) ** 2 + (v_x - y_CM * omega) ** 2
    return p["mass"] * abs(omega) * lever**0.5


def smallest_force(p, V_l, V_r):
    """|F| of eq. 11 in the motion under |F|: the first change of sign on a fine grid, refined."""

    def excess(F):
        return paper_force(p, paper_motion(p, F, V_l, V_r)) - F

    grid = np.linspace(0, p["mass"] * G, 4001)
    signs = np.array([excess(F) > 0 for F in grid])
    if not signs[0]:
        return 0.0
    first = np.flatnonzero(~signs)[0]
    return brentq(excess, grid[first - 1], grid[first], xtol=1e-13, rtol=1e-14)


def test_twists_are_those_of_the_paper_with_a_consistent_force(rng):
    """At up to 2 m/s several forces may be consistent: the smallest is taken."""
    values = MODEL.pack(AURIGA)
    for top in (1.0, 2.0):
        for V_l, V_r in rng.uniform(-top, top, (60, 2)):
            force = smallest_force(AURIGA, V_l, V_r)
            right, ahead, omega = paper_motion(AURIGA, force, V_l, V_r)
            inputs = Inputs(np.array([V_l, V_r]))
            np.testing.assert_allclose(MODEL.turn(values, inputs).indices.force_n, force, rtol=1e-9)
            np.testing.assert_allclose(
                MODEL.twist(values, inputs), [ahead, -right, omega], rtol=1e-9, atol=1e-12
            )


def test_icrs_are_those_of_the_twist(rng):
    """y_left = (v_x - v_left) / omega and so on, data/README.md."""
    values, speeds = MODEL.pack(AURIGA), rng.uniform(-1, 1, (50, 2))
    v_x, v_y, omega = MODEL.twist(values, Inputs(speeds)).T
    expected = np.stack([v_x - speeds[:, 0], v_x - speeds[:, 1], -v_y], axis=-1) / omega[:, None]
    np.testing.assert_allclose(MODEL.icrs(values, Inputs(speeds)), expected, rtol=1e-9, atol=1e-11)


def test_without_coefficients_of_the_force_the_icrs_are_constant(rng):
    """y_left = 0.42 * 2.62 / 2 - 0.106, y_right = -0.42 * 2.62 / 2 - 0.106, x_icr = zeta_0."""
    named = {**AURIGA, "zeta_1": 0.0, "epsilon_1": 0.0, "eta_1": 0.0, "eta_2": 0.0}
    icr = np.array([0.5502 - 0.106, -0.5502 - 0.106, 0.048, 1, 1])
    inputs = Inputs(rng.uniform(-2, 2, (50, 2)))
    np.testing.assert_allclose(
        MODEL.twist(MODEL.pack(named), inputs), Icr().twist(icr, inputs), atol=1e-13
    )


def test_a_light_robot_has_constant_icrs(rng):
    """The other way to no force: no mass."""
    inputs = Inputs(rng.uniform(-1, 1, (50, 2)))
    icr = np.array([0.5502 - 0.106, -0.5502 - 0.106, 0.048, 1, 1])
    twists = MODEL.twist(MODEL.pack({**AURIGA, "mass": 1e-3}), inputs)
    np.testing.assert_allclose(twists, Icr().twist(icr, inputs), atol=1e-5)


def test_the_width_is_held_where_eta_would_fall_below_its_least():
    """x_1 < 0 < x_2 and a steep eta_1: the tread ICRs stop a tenth of the track width apart."""
    values = MODEL.pack({**AURIGA, "eta_1": 0.5, "eta_2": 0.0})
    inputs = Inputs(np.array([0.2, 1.0]))
    y_left, y_right, _ = MODEL.icrs(values, inputs)
    np.testing.assert_allclose(y_left - y_right, LEAST_ETA * 0.42, rtol=1e-12)
    by_eta_0, by_eta_1 = MODEL.parameter_jacobian(values, inputs)[2, [4, 5]]
    assert by_eta_0 == by_eta_1 == 0


def test_the_force_is_held_at_the_weight():
    """At 20 m/s on the printed coefficients; the derivative by mass is that of the weight."""
    values = MODEL.pack({**AURIGA, "eta_2": 0.0, "eta_1": 0.0})
    inputs = Inputs(np.array([-5.0, 20.0]))
    assert MODEL.turn(values, inputs).indices.force_n == 258.0 * G
    omega = 25 / (0.42 * 2.62)
    by_mass = MODEL.parameter_jacobian(values, inputs)[:, 8]
    by_force = np.array([0.0011, -0.0002424, 0]) * omega  # both signs are -1 and 1
    np.testing.assert_allclose(by_mass, by_force * G, rtol=1e-12)


def test_h_acts_through_a_sign_alone():
    """V_l + H V_r = -0.5 + H: nothing between 0.51 and 2, a jump at 0.5."""
    inputs = Inputs(np.array([-0.5, 1.0]))
    twists = [MODEL.twist(MODEL.pack({**AURIGA, "h": h}), inputs) for h in (0.49, 0.51, 2.0)]
    np.testing.assert_array_equal(twists[1], twists[2])
    assert abs(twists[0][0] - twists[1][0]) > 0.01
    assert np.all(MODEL.parameter_jacobian(MODEL.pack(AURIGA), inputs)[:, 7] == 0)


def test_every_attainable_motion_has_tread_speeds(rng):
    """And where the motion is reached once, they are the ones that made it."""
    values, speeds = MODEL.pack(AURIGA), rng.uniform(-1, 1, (2000, 2))
    wanted = MODEL.twist(values, Inputs(speeds))
    found = MODEL.tread_speeds(values, wanted[:, 0], wanted[:, 2])
    made = MODEL.twist(values, Inputs(found))
    np.testing.assert_allclose(made[:, [0, 2]], wanted[:, [0, 2]], atol=1e-9)
    twice = np.max(np.abs(found - speeds), axis=1) > 1e-9
    assert np.mean(twice) < 0.05
    near_the_spot = np.abs(speeds[:, 0] + 0.67134 * speeds[:, 1]) < 0.15
    assert np.all(near_the_spot[twice])


@pytest.mark.parametrize(("sign", "left_out"), [(1.0, True), (-1.0, False)])
def test_motions_left_out_are_nan_and_near_the_spot(sign, left_out):
    """As printed a narrow gap opens where x_2 changes sign; with the signs reversed none does."""
    values = MODEL.pack(AURIGA)
    values[[3, 5]] *= sign
    v_x, omega = np.meshgrid(np.linspace(-0.3, 0.3, 121), np.linspace(-0.8, 0.8, 41))
    speeds = MODEL.tread_speeds(values, v_x, omega)
    without = np.isnan(speeds[..., 0])
    np.testing.assert_array_equal(np.isnan(speeds[..., 1]), without)
    assert np.any(without) == left_out
    centre_of_mass_ahead = np.abs(v_x - 0.015 * omega)
    assert np.all(centre_of_mass_ahead[without] < 0.02)
