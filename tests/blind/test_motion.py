"""The generator against closed forms, finite differences and zero effects."""

import dataclasses

import numpy as np
import pytest

from odometry.simulation.contact.drive import simulate_contact
from odometry.simulation.contact.slope import Plane
from odometry.simulation.contact.vehicle import contact_vehicle
from tests.blind import contact_cases, formula
from tests.blind.commands import STYLES, Limits, draw_commands
from tests.blind.contact_cases import Planes, _draw_contacts, fitted_icrs
from tests.blind.ground import Ground
from tests.blind.motion import STEP_S, drive
from tests.blind.robot import SIZES, Body, Icrs
from tests.blind.sensors import pose_measured

BODY = Body("husky_like", *SIZES["husky"])
ICRS = Icrs(0.42, -0.39, -0.03, 0.98, 1.01)
ROLLING = Ground(waves=((0.25, 0.3, 0.1, 0.4), (0.2, -0.1, 0.35, 1.0)))
PLANE = Ground((0.09, -0.12))
START = (2.0, -3.0, 0.7)
NO_SLOPE = {"lambda_1": 0.0, "lambda_2": 0.0, "v_max": 2.0, "half_width": 0.2, "half_length": 0.3}
SLOPE = NO_SLOPE | {"lambda_1": 0.8, "lambda_2": 1.5}
NO_INERTIA = {"zeta_1": 0.0, "epsilon_1": 0.0, "eta_1": 0.0, "eta_2": 0.0, "h": 1.0} | {
    "mass": 50.0,
    "x_cm": 0.02,
    "y_cm": 0.01,
    "track_width": 0.55,
}


@pytest.fixture
def commands(rng):
    return draw_commands(rng, 20.0, Limits(1.2, 1.5, 1.5, ICRS.width))


def moved(commands, effects, ground=Ground(), labels=None):  # noqa: B008 - it is frozen
    return drive(commands, BODY, ICRS, effects, ground=ground, start=START, labels=labels)


NEUTRAL = {
    "slope_sliding": NO_SLOPE,
    "inertia": NO_INERTIA,
    "curvature": {"beta_1": ICRS.width / 0.55 - 1, "beta_2": 0.0, "track_width": 0.55},
    "wheel_scale": {"c_l": 1.0, "c_r": 1.0},
    "terrain": {"grass": ICRS.values(), "sand": ICRS.values()},
    "traction_loss": {"k": 1.0, "m": 1.0, "moment_s": 7.0},
    "lateral_skid": {"x_icr": 0.0},
    "actuator_lag": {"time_constant_s": 1e-9},
    "unknown_pull": {"v_x_world": 0.0, "v_y_world": 0.0, "while_moving": 1.0},
    "unknown_ripple": {"amplitude_rad_m": 0.0, "phase_rad": 0.3},
}


@pytest.mark.parametrize("ground", [Ground(), PLANE, ROLLING], ids=["level", "plane", "rolling"])
@pytest.mark.parametrize("name", NEUTRAL)
def test_an_effect_of_size_zero_is_none(commands, name, ground):
    labels = np.where(np.arange(len(commands)) < 400, "grass", "sand")
    base = moved(commands, {}, ground)
    same = moved(commands, {name: NEUTRAL[name]}, ground, labels)
    np.testing.assert_allclose(same.poses, base.poses, rtol=1e-6, atol=1e-6)


def test_a_level_plane_by_steps_is_the_level_by_arcs(commands):
    level = moved(commands, {})
    stepped = moved(commands, {}, Ground((1e-12, 0.0)))
    assert stepped.poses == pytest.approx(level.poses, abs=2e-5)


@pytest.mark.parametrize("ground", [PLANE, ROLLING], ids=["plane", "rolling"])
def test_body_rates_on_slopes_are_those_of_the_rotation(ground):
    """Velocity and yaw rate in body axes, from differences of position and rotation matrix."""
    skid = {"lateral_skid": {"x_icr": 0.43}}
    motion = moved(np.tile([0.5, 0.9], (500, 1)), skid, ground)
    x, y, roll, pitch, yaw = motion.poses.T
    world = np.column_stack([x, y, heights(ground, x, y)])
    rotation = rotations(roll, pitch, yaw)
    spin = (np.swapaxes(rotation, 1, 2) @ np.gradient(rotation, STEP_S, axis=0))[1:-1]
    body = np.einsum("nji,nj->ni", rotation, np.gradient(world, STEP_S, axis=0))[1:-1]
    v_x, v_y, omega = formula.icr_twist(0.5 * 0.98, 0.9 * 1.01, 0.42, -0.39, 0.4)
    assert np.ptp(pitch) > 0.1
    assert np.ptp(roll) > 0.1
    assert spin[:, 1, 0] == pytest.approx(np.full(len(spin), omega), abs=1e-3)
    assert body == pytest.approx(np.tile([v_x, v_y, 0.0], (len(body), 1)), abs=1e-3)


def rotations(roll, pitch, yaw):
    """Rz(yaw) Ry(pitch) Rx(roll), (N, 3, 3)."""
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (np.cos, np.sin))
    rows = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def heights(ground, x, y):
    plane = ground.gradient[0] * x + ground.gradient[1] * y
    return plane + sum(a * np.sin(k * x + n * y + phase) for a, k, n, phase in ground.waves)


def test_lag_is_the_step_response():
    commands = np.concatenate([np.zeros((1, 2)), np.ones((200, 2))])
    straight = dataclasses.replace(ICRS, alpha_left=1.0, alpha_right=1.0)
    motion = drive(
        commands,
        BODY,
        straight,
        {"actuator_lag": {"time_constant_s": 0.3}},
        ground=Ground(),
        start=(0.0, 0.0, 0.0),
    )
    t = np.maximum(np.arange(len(motion.poses)) * STEP_S - 0.02, 0.0)
    assert motion.poses[:, 0] == pytest.approx(t - 0.3 * (1 - np.exp(-t / 0.3)), abs=1e-12)


def test_traction_is_lost_from_the_moment_on(commands):
    base = moved(commands, {})
    lost = moved(commands, {"traction_loss": {"k": 0.8, "m": 0.6, "moment_s": 10.0}})
    assert (lost.poses[:1001] == base.poses[:1001]).all()
    assert np.diff(lost.poses[1000:, 4]) == pytest.approx(0.6 * np.diff(base.poses[1000:, 4]))


def test_a_pull_adds_its_way_and_a_ripple_its_angle(commands):
    base = moved(commands, {})
    pull = {"v_x_world": 0.03, "v_y_world": -0.05, "while_moving": 0.0}
    pulled = moved(commands, {"unknown_pull": pull}).poses - base.poses
    assert pulled[-1, :2] == pytest.approx([0.6, -1.0])
    ripple = {"amplitude_rad_m": 0.4, "phase_rad": 0.0}
    rippled = moved(commands, {"unknown_ripple": ripple}).poses - base.poses
    turned = np.cumsum(np.repeat(commands[:-1], 2, axis=0).mean(axis=1)) * STEP_S / 0.165
    expected = 0.4 * 0.165 * (1 - np.cos(turned))
    assert rippled[1:, 4] == pytest.approx(expected, abs=1e-3)


def test_the_sensor_is_late_off_centre_and_turned(commands):
    motion = moved(commands, {}, PLANE)
    times_s = np.array([3.0, 7.5])
    effects = {"lever_arm": {"x": 0.2, "y": -0.1}, "heading_offset": {"yaw": 0.05}}
    seen = pose_measured(motion, times_s, effects)
    for row, (x, y, roll, pitch, yaw) in zip(seen, motion.at(times_s), strict=True):
        arm = rotations(*np.array([[roll], [pitch], [yaw]]))[0] @ [0.2, -0.1, 0.0]
        assert row == pytest.approx([x + arm[0], y + arm[1], yaw + 0.05])


def test_icrs_on_a_slope_by_hand():
    """Martinez 2024, eq. 5-10: V_r - V_l > 0, mean 0.25 m/s, nose up 0.1, roll 0.05."""
    p = {"lambda_1": 1.0, "lambda_2": 2.0, "v_max": 1.0, "half_width": 0.3, "half_length": 0.5}
    # x_l = -0.6 + 0.75 * 0.1, x_r = 0.6 + 0.75 * 0.1 + 0.5 * 0.75 * 2 * 0.1, y = 0 + 0.75 * 0.05
    got = formula.icrs_on_slope(0.0, 0.5, (0.6, -0.6, 0.0), (0.05, 0.1), p)
    assert got == pytest.approx((0.525, -0.75, 0.0375))
    # nose down: x_l = -0.6 - 0.075 - 0.075, x_r = 0.6 - 0.075
    got = formula.icrs_on_slope(0.0, 0.5, (0.6, -0.6, 0.0), (0.05, -0.1), p)
    assert got == pytest.approx((0.75, -0.525, 0.0375))
    # the limits, and nothing above v_max
    got = formula.icrs_on_slope(0.0, 0.5, (0.31, -0.6, 0.49), (0.05, 0.1), p)
    assert got == pytest.approx((0.3, -0.75, 0.5))
    assert formula.icrs_on_slope(2.0, 2.1, (0.6, -0.6, 0.1), (0.05, 0.1), p) == (0.6, -0.6, 0.1)


def test_martinez_attitude_is_that_of_the_rotation():
    """Rz(psi) Ry(alpha) Rx(phi) about X right, Y forward has the axes of Rz Ry Rx (REP-103)."""
    roll, pitch = 0.17, -0.15
    x_axis, y_axis, _ = rotations(*np.array([[roll], [pitch], [0.0]]))[0].T
    alpha, phi = formula.martinez_attitude(roll, pitch)
    assert np.sin(phi) * np.cos(alpha) == pytest.approx(x_axis[2])  # his forward rises
    assert -np.sin(alpha) == pytest.approx(-y_axis[2])  # his X, to the right, falls


def test_icrs_under_inertia_are_consistent_with_their_own_force():
    p = NO_INERTIA | {"zeta_1": 5e-4, "epsilon_1": 4e-4, "eta_1": 2e-3, "eta_2": 1e-5}
    left, right = np.array([0.4, 1.2, -0.5, 0.7]), np.array([1.2, 0.4, -1.0, 0.7])
    icrs = tuple(np.full(4, value) for value in (0.42, -0.39, -0.03))
    y_left, y_right, x_icr = formula.icrs_under_inertia(left, right, icrs, p)
    width = y_left - y_right
    omega = (right - left) / width
    v_x = (right * y_left - left * y_right) / width
    v_y = -x_icr * omega
    force = 50.0 * np.abs(omega) * np.sqrt((v_y + 0.02 * omega) ** 2 + (v_x - 0.01 * omega) ** 2)
    assert x_icr == pytest.approx(-0.03 + 5e-4 * force * [1, 1, -1, 1])
    signs = np.array([-1, 1, -1, 0])  # of (V_l - V_r)(V_l + V_r)
    assert width / 0.55 == pytest.approx(0.81 / 0.55 + 2e-3 * force * signs + 1e-5 * force**2)
    assert -(y_left + y_right) / 2 == pytest.approx(-0.015 + 4e-4 * force * signs)


def test_width_by_curvature_by_hand():
    """Baril 2020, eq. 10-11: lambda = 3 / 0.75 = 4, so y_0 = b/2 (1 + 0.8 / (1 + 0.5 * 2))."""
    p = {"beta_1": 0.8, "beta_2": 0.5, "track_width": 1.0}
    half = formula.half_width_by_curvature(np.array([1.125, -0.5]), np.array([1.875, 0.5]), p)
    assert half == pytest.approx([0.7, 0.9])


def test_planes_of_a_stack_are_planes_each(rng):
    contact, _ = _draw_contacts(rng, BODY)
    vehicle = contact_vehicle(dataclasses.asdict(BODY), contact)
    commands = np.stack([draw_commands(rng, 3.0, Limits(0.5, 1.0, 1.0, 0.9)) for _ in range(2)])
    starts = np.array([[1.0, 2.0, 0.3], [-4.0, 1.0, 2.0]])
    both = simulate_contact(
        vehicle, commands, 0.02, ground=Planes((0j, 0.1 + 0.05j)), start_poses=starts
    )
    tilted = Plane(np.arctan(abs(0.1 + 0.05j)), np.angle(0.1 + 0.05j))
    for i, ground in enumerate((Plane(), tilted)):
        one = simulate_contact(
            vehicle, commands[i], 0.02, ground=ground, start_poses=tuple(starts[i])
        )
        assert both.poses_world[i] == pytest.approx(one.poses_world, abs=1e-9)


def test_icrs_are_fitted_exactly_where_they_are_constant(commands):
    fitted = fitted_icrs(coarse(moved(commands, {})))
    assert list(fitted.values().values()) == pytest.approx(list(ICRS.values().values()), abs=0.01)


def coarse(motion):
    """At the rate of the commands, as the contact simulator gives it."""
    return dataclasses.replace(
        motion,
        step_s=0.02,
        poses=motion.poses[::2],
        yaw_rates_rad_s=motion.yaw_rates_rad_s[::2],
    )


@pytest.mark.parametrize("style", STYLES, ids=lambda style: style.__name__)
def test_commands_keep_the_limits(rng, style):
    limits = Limits(1.0, 1.2, 0.8, 0.9)
    wanted = style(rng, 4001, limits)
    assert wanted.shape == (4001, 2)
    treads = draw_commands(rng, 80.0, limits)
    assert np.abs(treads).max() <= 1.0 + 1e-9
    assert np.abs(np.diff(treads, axis=0)).max() <= 0.02 + 1e-9
    assert (treads[0] == 0).all()


@pytest.mark.parametrize("kind", ["contact_slope", "contact_none"])
def test_a_contact_case_is_calibrated_on_the_level_and_judged_elsewhere(monkeypatch, kind):
    monkeypatch.setattr(contact_cases, "CALIBRATION_S", 10.0)
    monkeypatch.setattr(contact_cases, "MEASURED_S", 14.0)
    drawn = contact_cases.make_contact_case(kind, np.random.default_rng(5))
    motions = {name: motion for name, (motion, _) in drawn.motions.items()}
    assert [len(motion.poses) for motion in motions.values()] == [501, 701, 701]
    tilted = {name: np.abs(motion.poses[:, 2:4]).max() > 0.03 for name, motion in motions.items()}
    sloped = kind == "contact_slope"
    assert tilted == {"calibration": False, "measured": sloped, "holdout": sloped}
    assert drawn.effects == (("slope_sliding",) if sloped else ())
