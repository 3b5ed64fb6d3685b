"""The true motion under what is hidden, integrated at 100 Hz."""

import math
from dataclasses import dataclass

import numpy as np

from tests.blind.formula import icr_twist
from tests.blind.ground import attitude_on
from tests.blind.hidden.kind import Hidden
from tests.blind.hidden.scene import STEP_S, Drive

PARAMETERS = ("y_left", "y_right", "x_icr", "alpha_left", "alpha_right")


@dataclass(frozen=True, eq=False)
class Motion:
    """What truly happened in one run.

    Attributes
    ----------
    drive : Drive
    hidden : Hidden
    treads_m_s : (N, 2) array
        Speeds that the treads really had; row n holds from step n to step n + 1.
    poses : (N, 5) array
        x, y [m], roll, pitch, yaw [rad]; yaw is not wrapped.
    yaw_rates_rad_s : (N,) array
        About the body's z.
    """

    drive: Drive
    hidden: Hidden
    treads_m_s: np.ndarray
    poses: np.ndarray
    yaw_rates_rad_s: np.ndarray

    @property
    def reported_m_s(self):
        """Tread speeds (N, 2) as they are recorded but for noise."""
        return self.hidden.reported(self.drive.asked_m_s, self.treads_m_s)

    def at(self, times_s):
        """Poses (K, 5) at any times."""
        stamps = self.drive.clock.times_s
        return np.column_stack([np.interp(times_s, stamps, column) for column in self.poses.T])


def move(scene, drive, hidden):
    """Motion of the scene's robot on a drive."""
    treads = hidden.treads(drive.asked_m_s)
    values = hidden.icrs(base_values(scene, drive), treads)
    left, right = values["alpha_left"] * treads[:, 0], values["alpha_right"] * treads[:, 1]
    places = [values[key] for key in PARAMETERS[:3]]
    twist = hidden.twist(np.column_stack(icr_twist(left, right, *places)), treads)
    follow = _on_the_level if drive.ground.level and hidden.at_place is None else _by_place
    poses, yaw_rates = follow(twist, drive, hidden.at_place)
    return Motion(drive, hidden, treads, poses, yaw_rates)


def base_values(scene, drive):
    """Calibrated ICR parameters of every step, (N,) each."""
    count = len(drive.asked_m_s)
    if drive.labels is None:
        return {key: np.full(count, value) for key, value in scene.base.values().items()}
    by_row = [scene.icrs[name] for name in drive.labels]
    return {key: np.array([getattr(icrs, key) for icrs in by_row]) for key in PARAMETERS}


def _on_the_level(twist, drive, _):
    """Poses by exact arcs."""
    v_x, v_y, omega = twist[:-1].T
    turns = omega * STEP_S
    yaw = drive.start[2] + np.concatenate([[0.0], np.cumsum(turns)])
    chord = np.sinc(turns / (2 * np.pi)) * np.exp(1j * (yaw[:-1] + turns / 2))
    moves = np.concatenate([[0.0], np.cumsum((v_x + 1j * v_y) * chord * STEP_S)])
    flat = np.zeros_like(yaw)
    x, y = drive.start[0] + moves.real, drive.start[1] + moves.imag
    return np.column_stack([x, y, flat, flat, yaw]), twist[:, 2]


def _by_place(twist, drive, at_place):
    """Poses by the midpoint rule; the twist and the attitude follow the place."""
    rows, half_s = [], STEP_S / 2
    x, y, yaw = drive.start
    for row, base in enumerate(twist.tolist()):
        rates, roll, pitch, omega = _rates((x, y, yaw), row, base, drive.ground, at_place)
        rows.append((x, y, roll, pitch, yaw, omega))
        middle = x + half_s * rates[0], y + half_s * rates[1], yaw + half_s * rates[2]
        rates = _rates(middle, row, base, drive.ground, at_place)[0]
        x, y, yaw = x + STEP_S * rates[0], y + STEP_S * rates[1], yaw + STEP_S * rates[2]
    table = np.array(rows)
    return table[:, :5], table[:, 5]


def _rates(pose, row, twist, ground, at_place):
    """Rates of x, y and yaw, roll, pitch, and the rate about the body's z."""
    x, y, yaw = pose
    g_x, g_y, g_xx, g_xy, g_yy = ground.slopes(x, y)
    roll, pitch = attitude_on(g_x, g_y, yaw)
    if at_place is not None:
        twist = at_place(row, (x, y, yaw, roll, pitch), twist)
    v_x, v_y, omega = twist
    cos_p, sin_p, cos_r, sin_r = math.cos(pitch), math.sin(pitch), math.cos(roll), math.sin(roll)
    along, across = cos_p * v_x + sin_p * sin_r * v_y, cos_r * v_y
    cos, sin = math.cos(yaw), math.sin(yaw)
    x_rate, y_rate = cos * along - sin * across, sin * along + cos * across
    # The slope ahead changes by the bend of the ground; the body pitches with it about its y.
    bend = (g_xx * x_rate + g_xy * y_rate) * cos + (g_xy * x_rate + g_yy * y_rate) * sin
    nose_down = -bend * cos_p**2 * cos_r
    return (x_rate, y_rate, (sin_r * nose_down + cos_r * omega) / cos_p), roll, pitch, omega
