"""Effects by their parameters, to be matched with one another: each makes hide(clock) -> Hidden."""
# ruff: noqa: ARG001, ARG005 - hidden effects have one face, and few need all of it

import math

import numpy as np

from tests.blind.formula import icrs_by_curvature, icrs_under_inertia
from tests.blind.hidden.courses import delayed, lagged
from tests.blind.hidden.kind import Hidden
from tests.blind.hidden.surroundings import carried


def wheels(left, right):
    """Factors of the wheel radii."""
    return lambda clock: Hidden(
        {"c_left": left, "c_right": right}, treads=lambda v: v * [left, right]
    )


def slip_by_speed(share_s_m):
    return lambda clock: Hidden(
        {"share_s_m": share_s_m}, treads=lambda v: v * (1 - share_s_m * np.abs(v))
    )


def slip_backward(kept):
    return lambda clock: Hidden({"kept": kept}, treads=lambda v: np.where(v < 0, kept * v, v))


def top_speed(most_m_s):
    return lambda clock: Hidden(
        {"most_m_s": most_m_s}, treads=lambda v: np.clip(v, -most_m_s, most_m_s)
    )


def pump(share_s_m):
    """Each side loses by the speed of the other."""
    return lambda clock: Hidden(
        {"share_s_m": share_s_m}, treads=lambda v: v * (1 - share_s_m * np.abs(v[:, ::-1]))
    )


def traction(k, m):
    return lambda clock: Hidden({"k": k, "m": m}, twist=lambda w, v: w * [k, m, m])


def left_turns(kept):
    """Only turns to the left lose yaw rate."""

    def twist(values, _):
        factor = np.where(values[:, 2] > 0, kept, 1.0)[:, None]
        return values * np.where([False, True, True], factor, 1.0)

    return lambda clock: Hidden({"kept": kept}, twist=twist)


def skid(ahead_m):
    """All of the ICRs further ahead."""
    return lambda clock: Hidden(
        {"x_icr": ahead_m}, icrs=lambda values, v: {**values, "x_icr": values["x_icr"] + ahead_m}
    )


def curvature(body, wider, beta_2):
    """A width that is wider on the spot than the calibrated one by a factor (Baril, eq. 10)."""

    def hide(clock):
        def icrs(values, treads):
            left, right = values["alpha_left"] * treads[:, 0], values["alpha_right"] * treads[:, 1]
            places = [values[key] for key in ("y_left", "y_right", "x_icr")]
            width = places[0] - places[1]
            p = {
                "beta_1": wider * width / body.track_width - 1.0,
                "beta_2": beta_2,
                "track_width": body.track_width,
            }
            y_left, y_right, _ = icrs_by_curvature(left, right, places, p)
            return {**values, "y_left": y_left, "y_right": y_right}

        return Hidden({"wider": wider, "beta_2": beta_2}, icrs=icrs)

    return hide


def inertia(body, zeta_1, eta_2):
    """ICRs that follow the force of inertia (Martinez 2017): x_icr by F, the width by F^2."""
    p = {
        "zeta_1": zeta_1,
        "epsilon_1": 0.0,
        "eta_1": 0.0,
        "eta_2": eta_2,
        "h": 1.0,
        "mass": body.mass,
        "x_cm": 0.0,
        "y_cm": 0.0,
        "track_width": body.track_width,
    }

    def hide(clock):
        def icrs(values, treads):
            left, right = values["alpha_left"] * treads[:, 0], values["alpha_right"] * treads[:, 1]
            places = [values[key] for key in ("y_left", "y_right", "x_icr")]
            moved = icrs_under_inertia(left, right, places, p)
            return {**values, **dict(zip(("y_left", "y_right", "x_icr"), moved, strict=True))}

        return Hidden({"zeta_1": zeta_1, "eta_2": eta_2}, icrs=icrs)

    return hide


def late_commands(delay_s):
    return lambda clock: Hidden(
        {"delay_s": delay_s}, treads=lambda v: delayed(v, delay_s, clock.step_s)
    )


def sluggish(constant_s):
    return lambda clock: Hidden(
        {"constant_s": constant_s}, treads=lambda v: lagged(v, constant_s, clock.step_s)
    )


def late_stamps(delay_s):
    return lambda clock: Hidden(
        {"delay_s": delay_s}, reference=lambda t, poses: (t + delay_s, poses)
    )


def arm(x_m, y_m):
    """The sensor is off the middle of the robot."""

    def reference(times_s, poses):
        place = poses[:, 0] + 1j * poses[:, 1] + np.exp(1j * poses[:, 2]) * (x_m + 1j * y_m)
        return times_s, np.column_stack([place.real, place.imag, poses[:, 2]])

    return lambda clock: Hidden({"x_m": x_m, "y_m": y_m}, reference=reference)


def turned_yaw(offset_rad):
    return lambda clock: Hidden(
        {"offset_rad": offset_rad},
        reference=lambda t, poses: (t, poses + np.array([0.0, 0.0, offset_rad])),
    )


def compass(most_rad, phase_rad):
    """An error of yaw that is a sinusoid of the heading."""

    def reference(times_s, poses):
        error = most_rad * np.sin(poses[:, 2] - phase_rad)
        return times_s, poses + np.column_stack([np.zeros((len(poses), 2)), error])

    return lambda clock: Hidden({"most_rad": most_rad, "phase_rad": phase_rad}, reference=reference)


def stretched(factor, heading_rad):
    """A map that is too long along a heading."""
    way = np.exp(1j * heading_rad)

    def reference(times_s, poses):
        place = (poses[:, 0] + 1j * poses[:, 1]) * way.conjugate()
        place = (factor * place.real + 1j * place.imag) * way
        return times_s, np.column_stack([place.real, place.imag, poses[:, 2]])

    return lambda clock: Hidden({"factor": factor}, reference=reference)


def current(speed_m_s, direction_rad):
    """All is carried over the world, while the treads run."""

    def hide(clock):
        def at_place(row, pose, twist):
            moving = min(1.0, (abs(twist[0]) + 0.3 * abs(twist[2])) / 0.05)
            return carried(pose[2], twist, moving * speed_m_s, direction_rad)

        truth = {"speed_m_s": speed_m_s, "direction_rad": direction_rad}
        return Hidden(truth, at_place=at_place)

    return hide


def creep(share):
    """Downhill by a share of the speed times the slope."""

    def hide(clock):
        def at_place(row, pose, twist):
            roll, pitch = pose[3:]
            moved = share * (abs(twist[0]) + 0.3 * abs(twist[2]))
            down = math.sin(pitch), -math.cos(pitch) * math.sin(roll)
            return twist[0] + moved * down[0], twist[1] + moved * down[1], twist[2]

        return Hidden({"share": share}, at_place=at_place)

    return hide


def uphill(share):
    """Slower uphill and faster downhill, by a share of the slope."""

    def hide(clock):
        def at_place(row, pose, twist):
            rise = -math.sin(pose[4]) * (1 if twist[0] > 0 else -1)
            return twist[0] * (1 - share * rise), twist[1], twist[2]

        return Hidden({"share": share}, at_place=at_place)

    return hide
