"""Sizes of the effects, drawn as a sceptical user would choose them.

Each function takes a generator, the body and the base ICRs, and returns the true parameters.
"""
# ruff: noqa: ARG001 - all have one face, and few need all of it

import numpy as np


def slope_sliding(rng, body, icrs):
    """Shifts of the ICRs by the size of the robot, at a slope of 0.1 and 0.6 m/s below v_max."""
    v_max = rng.uniform(1.0, 1.5)
    scale = body.length / v_max
    return {
        "lambda_1": scale * rng.uniform(0.5, 3.0),
        "lambda_2": scale * rng.uniform(0.5, 5.0),
        "v_max": v_max,
        "half_width": body.half_width,
        "half_length": body.half_length,
    }


def inertia(rng, body, icrs):
    """Shifts at a lateral acceleration of 2 m/s2, as shares of the robot's size."""
    force = 2.0 * body.mass
    eta = icrs.width / body.track_width
    return {
        "zeta_1": body.length * rng.uniform(0.05, 0.3) / force,
        "epsilon_1": body.track_width * rng.uniform(0.05, 0.3) / force,
        "eta_1": eta * rng.uniform(0.05, 0.25) / force,
        "eta_2": eta * rng.uniform(0.05, 0.25) / force**2,
        "h": -icrs.y_left / icrs.y_right,
        "mass": body.mass,
        "x_cm": body.length * rng.uniform(-0.03, 0.03),
        "y_cm": body.track_width * rng.uniform(-0.03, 0.03),
        "track_width": body.track_width,
    }


def curvature(rng, body, icrs):
    """A width that shrinks towards the straight; on the spot wider than on the level ground."""
    return {
        "beta_1": icrs.width / body.track_width * rng.uniform(1.2, 2.2) - 1.0,
        "beta_2": rng.uniform(0.2, 2.0),
        "track_width": body.track_width,
    }


def wheel_scale(rng, body, icrs):
    one = 1.0 + rng.choice([-1.0, 1.0]) * rng.uniform(0.015, 0.08)
    other = rng.choice([1.0, rng.uniform(0.94, 1.06)])
    left, right = rng.permutation([one, other])
    return {"c_l": left, "c_r": right}


def terrain(rng, body, icrs):
    """ICRs of one or two more grounds; the first label is that of the calibration."""
    names = rng.permutation(["asphalt", "concrete", "grass", "gravel", "sand", "snow"])
    labels = {str(names[0]): icrs.values()}
    for name in names[1 : rng.integers(2, 4)]:
        wider = rng.choice([rng.uniform(0.75, 0.88), rng.uniform(1.15, 1.7)])
        labels[str(name)] = {
            "y_left": icrs.y_left * wider * rng.uniform(0.93, 1.07),
            "y_right": icrs.y_right * wider * rng.uniform(0.93, 1.07),
            "x_icr": icrs.x_icr + body.length * rng.uniform(-0.15, 0.15),
            "alpha_left": icrs.alpha_left * rng.uniform(0.9, 1.0),
            "alpha_right": icrs.alpha_right * rng.uniform(0.9, 1.0),
        }
    return labels


def traction_loss(rng, body, icrs):
    return {
        "k": rng.uniform(0.7, 0.97),
        "m": rng.uniform(0.55, 0.95),
        "moment_s": rng.uniform(35.0, 115.0),
    }


def lateral_skid(rng, body, icrs):
    return {"x_icr": rng.choice([-1.0, 1.0]) * body.length * rng.uniform(0.06, 0.3)}


def time_offset(rng, body, icrs):
    """A pose stamped t was true at t - delay."""
    return {"delay_s": rng.choice([-1.0, 1.0]) * rng.uniform(0.05, 0.3)}


def actuator_lag(rng, body, icrs):
    return {"time_constant_s": rng.uniform(0.1, 0.4)}


def lever_arm(rng, body, icrs):
    """Place of the pose sensor in the robot frame, off in both axes."""
    distance, angle = rng.uniform(0.05, 0.4), rng.uniform(0.3, 1.27)
    ahead, left = rng.choice([-1.0, 1.0], size=2)
    return {"x": ahead * distance * np.cos(angle), "y": left * distance * np.sin(angle)}


def heading_offset(rng, body, icrs):
    """The measured yaw is this much greater than the true one."""
    return {"yaw": rng.choice([-1.0, 1.0]) * np.deg2rad(rng.uniform(1.0, 5.0))}


def unknown_pull(rng, body, icrs):
    """A steady velocity over the world, always or only while the treads run."""
    speed, direction = rng.uniform(0.03, 0.10), rng.uniform(-np.pi, np.pi)
    return {
        "v_x_world": speed * np.cos(direction),
        "v_y_world": speed * np.sin(direction),
        "while_moving": float(rng.integers(2)),
    }


def unknown_ripple(rng, body, icrs):
    """Yaw rate per speed, once a turn of the wheels."""
    return {"amplitude_rad_m": rng.uniform(0.05, 0.6), "phase_rad": rng.uniform(-np.pi, np.pi)}


DRAWS = {
    draw.__name__: draw
    for draw in (
        slope_sliding,
        inertia,
        curvature,
        wheel_scale,
        terrain,
        traction_loss,
        lateral_skid,
        time_offset,
        actuator_lag,
        lever_arm,
        heading_offset,
        unknown_pull,
        unknown_ripple,
    )
}


def draw_effect(name, rng, body, icrs):
    """True parameters of an effect, as plain numbers."""
    return _plain(DRAWS[name](rng, body, icrs))


def _plain(values):
    return {
        key: _plain(value) if isinstance(value, dict) else float(value)
        for key, value in values.items()
    }
