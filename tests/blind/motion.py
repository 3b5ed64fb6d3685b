"""The true motion: tread speeds through the formulae, integrated at 100 Hz."""

import math
from dataclasses import dataclass

import numpy as np

from tests.blind import formula
from tests.blind.commands import RATE_HZ
from tests.blind.ground import attitude_on

SUBSTEPS = 2
STEP_S = 1 / (RATE_HZ * SUBSTEPS)


@dataclass(frozen=True, eq=False)
class Motion:
    """What truly happened.

    Attributes
    ----------
    step_s : float
        Between the poses.
    commands_m_s : (N, 2) array
        Tread speeds at 50 Hz, as they are recorded but for noise.
    poses : (M, 5) array
        x, y [m], roll, pitch, yaw [rad]; yaw is not wrapped.
    yaw_rates_rad_s : (M,) array
        About the body's z.
    labels : (N,) array of str or None
        Name of the ground under each row of commands.
    """

    step_s: float
    commands_m_s: np.ndarray
    poses: np.ndarray
    yaw_rates_rad_s: np.ndarray
    labels: np.ndarray | None = None

    def at(self, times_s):
        """Poses (K, 5) at any times."""
        stamps = np.arange(len(self.poses)) * self.step_s
        return np.column_stack([np.interp(times_s, stamps, column) for column in self.poses.T])


@dataclass(frozen=True, eq=False)
class Steps:
    """What drives each of M - 1 steps: treads, ICRs, factors of the twist, what is added to it."""

    left: np.ndarray
    right: np.ndarray
    icrs: tuple[np.ndarray, np.ndarray, np.ndarray]
    k: np.ndarray
    m: np.ndarray
    extra_yaw_rate: np.ndarray
    pull: np.ndarray
    slope: dict | None


def drive(commands, body, icrs, effects, *, ground, start, labels=None):
    """Motion of a robot by its commands (N, 2) under effects, by name with their parameters."""
    steps = _steps(commands, body, icrs, effects, labels)
    if ground.level:
        poses, yaw_rates = _on_the_level(steps, start)
    else:
        poses, yaw_rates = _on_slopes(steps, ground, start)
    return Motion(STEP_S, commands, poses, yaw_rates, labels)


def _steps(commands, body, icrs, effects, labels):
    held = np.repeat(commands[:-1], SUBSTEPS, axis=0)
    names = None if labels is None else np.repeat(labels[:-1], SUBSTEPS)
    treads = _lagged(held, effects["actuator_lag"]) if "actuator_lag" in effects else held
    rolled = treads.mean(axis=1) * STEP_S / body.wheel_radius
    turned = np.cumsum(rolled) - rolled / 2
    if "wheel_scale" in effects:
        treads = treads * [effects["wheel_scale"]["c_l"], effects["wheel_scale"]["c_r"]]
    values = _columns(names, icrs, effects.get("terrain"))
    left, right = (values["alpha_left"], values["alpha_right"]) * treads.T
    places = (values["y_left"], values["y_right"], values["x_icr"])
    if "curvature" in effects:
        places = formula.icrs_by_curvature(left, right, places, effects["curvature"])
    if "inertia" in effects:
        places = formula.icrs_under_inertia(left, right, places, effects["inertia"])
    if "lateral_skid" in effects:
        places = (*places[:2], places[2] + effects["lateral_skid"]["x_icr"])
    k, m = _traction(len(held), effects.get("traction_loss"))
    ripple = _ripple(treads, turned, effects.get("unknown_ripple"))
    pull = _pull(treads, effects.get("unknown_pull"))
    return Steps(left, right, places, k, m, ripple, pull, effects.get("slope_sliding"))


def _lagged(held, p):
    """Mean over each step of speeds that follow the commands with a first-order lag, exactly."""
    constant = p["time_constant_s"]
    kept = math.exp(-STEP_S / constant)
    mean = constant / STEP_S * (1 - kept)
    state, result = np.zeros(2), np.empty_like(held)
    for row, command in enumerate(held):
        result[row] = command + (state - command) * mean
        state = command + (state - command) * kept
    return result


def _columns(names, icrs, grounds):
    """ICR parameters of every step."""
    if grounds is None:
        return {key: np.full(1, value) for key, value in icrs.values().items()}
    return {key: np.array([grounds[name][key] for name in names]) for key in icrs.values()}


def _traction(count, p):
    if p is None:
        return np.ones(count), np.ones(count)
    lost = np.arange(count) * STEP_S >= p["moment_s"] - 1e-9
    return np.where(lost, p["k"], 1.0), np.where(lost, p["m"], 1.0)


def _ripple(treads, turned, p):
    if p is None:
        return np.zeros(len(treads))
    return p["amplitude_rad_m"] * treads.mean(axis=1) * np.sin(turned + p["phase_rad"])


def _pull(treads, p):
    if p is None:
        return np.zeros((len(treads), 2))
    moving = (np.abs(treads).max(axis=1) > 0.05) | (p["while_moving"] == 0)
    return moving[:, None] * np.array([p["v_x_world"], p["v_y_world"]])


def _on_the_level(steps, start):
    """Poses by exact arcs."""
    v_x, v_y, omega = formula.icr_twist(steps.left, steps.right, *steps.icrs)
    v_x, v_y = v_x * steps.k, v_y * steps.m
    omega = omega * steps.m + steps.extra_yaw_rate
    turns = omega * STEP_S
    yaw = start[2] + np.concatenate([[0.0], np.cumsum(turns)])
    chord = np.sinc(turns / (2 * np.pi)) * np.exp(1j * (yaw[:-1] + turns / 2))
    moves = (v_x + 1j * v_y) * chord + steps.pull @ [1, 1j]
    place = start[0] + 1j * start[1] + np.concatenate([[0.0], np.cumsum(moves * STEP_S)])
    flat = np.zeros_like(yaw)
    poses = np.column_stack([place.real, place.imag, flat, flat, yaw])
    return poses, np.append(omega, omega[-1])


def _on_slopes(steps, ground, start):
    """Poses by the midpoint rule, the attitude from the ground at each point."""
    count = len(steps.left)
    icrs = np.column_stack([np.broadcast_to(place, count) for place in steps.icrs])
    table = np.column_stack(
        [steps.left, steps.right, icrs, steps.k, steps.m, steps.extra_yaw_rate, steps.pull]
    ).tolist()
    poses, yaw_rates = np.empty((count + 1, 5)), np.empty(count + 1)
    x, y, yaw = map(float, start)
    for row, step in enumerate(table):
        rate, roll, pitch, omega = _rates((x, y, yaw), step, ground, steps.slope)
        poses[row], yaw_rates[row] = (x, y, roll, pitch, yaw), omega
        middle = [at + STEP_S / 2 * r for at, r in zip((x, y, yaw), rate, strict=True)]
        rate = _rates(middle, step, ground, steps.slope)[0]
        x, y, yaw = (at + STEP_S * r for at, r in zip((x, y, yaw), rate, strict=True))
    _, roll, pitch, omega = _rates((x, y, yaw), table[-1], ground, steps.slope)
    poses[-1], yaw_rates[-1] = (x, y, roll, pitch, yaw), omega
    return poses, yaw_rates


def _rates(pose, step, ground, slope):
    """Rates of x, y and yaw on a slope, and roll, pitch and the rate about the body's z."""
    x, y, yaw = pose
    left, right, y_left, y_right, x_icr, k, m, extra, pull_x, pull_y = step
    g_x, g_y, g_xx, g_xy, g_yy = ground.slopes(x, y)
    roll, pitch = attitude_on(g_x, g_y, yaw)
    icrs = (y_left, y_right, x_icr)
    if slope is not None:
        attitude = formula.martinez_attitude(roll, pitch)
        icrs = formula.icrs_on_slope(left, right, icrs, attitude, slope)
    v_x, v_y, omega = formula.icr_twist(left, right, *icrs)
    v_x, v_y, omega = k * v_x, m * v_y, m * omega + extra
    cos_p, sin_p, cos_r, sin_r = math.cos(pitch), math.sin(pitch), math.cos(roll), math.sin(roll)
    along, across = cos_p * v_x + sin_p * sin_r * v_y, cos_r * v_y
    cos, sin = math.cos(yaw), math.sin(yaw)
    x_rate, y_rate = cos * along - sin * across + pull_x, sin * along + cos * across + pull_y
    # The slope ahead changes by the bend of the ground; the body pitches with it about its y.
    bend = (g_xx * x_rate + g_xy * y_rate) * cos + (g_xy * x_rate + g_yy * y_rate) * sin
    nose_down = -bend * cos_p**2 * cos_r
    return (x_rate, y_rate, (sin_r * nose_down + cos_r * omega) / cos_p), roll, pitch, omega
