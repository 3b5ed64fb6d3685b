"""Tread speeds as a driver or a planner asks for them, in three styles."""

from dataclasses import dataclass

import numpy as np

RATE_HZ = 50
CALIBRATION_S, MEASURED_S = 120.0, 160.0
ACCELERATION_M_S2 = 1.0  # of each tread


@dataclass(frozen=True)
class Limits:
    """What a driver keeps to.

    Attributes
    ----------
    speed_m_s : float
        Of each tread.
    yaw_rate_rad_s : float
        As the width makes it of the speeds.
    lateral_m_s2 : float
        Speed times yaw rate.
    width_m : float
        Between the ICRs, roughly.
    """

    speed_m_s: float
    yaw_rate_rad_s: float
    lateral_m_s2: float
    width_m: float


def draw_commands(rng, duration_s, limits):
    """Left and right tread speed (N, 2) [m/s] at 50 Hz, from rest, in a style that is drawn."""
    style = STYLES[rng.integers(len(STYLES))]
    wanted = style(rng, round(duration_s * RATE_HZ) + 1, limits)
    speed, difference = _kept(wanted[:, 0], wanted[:, 1], limits)
    treads = np.column_stack([speed - difference / 2, speed + difference / 2])
    return _slewed(treads)


def holds(rng, count, limits):
    """Speed and difference (N, 2) in steps of 2 to 6 s: straights, arcs, spins, also backward."""
    widest = limits.yaw_rate_rad_s * limits.width_m
    rows = np.empty((count, 2))
    row = 0
    while row < count:
        speed = limits.speed_m_s * rng.uniform(0.3, 1.0)
        difference = widest * rng.uniform(-1.0, 1.0)
        kind = rng.choice(["arc", "straight", "spin", "back"], p=[0.55, 0.15, 0.15, 0.15])
        if kind == "straight":
            difference = 0.0
        elif kind == "spin":
            speed = limits.speed_m_s * rng.uniform(-0.1, 0.1)
        elif kind == "back":
            speed *= -0.7
        length = round(rng.uniform(2.0, 6.0) * RATE_HZ)
        rows[row : row + length] = speed, difference
        row += length
    return rows


def smooth(rng, count, limits):
    """Speed and difference (N, 2) that wander with a time constant of about a second or two."""
    wave = [_wander(rng, count, rng.uniform(0.6, 1.5)) for _ in range(2)]
    widest = limits.yaw_rate_rad_s * limits.width_m
    return np.column_stack([limits.speed_m_s * (0.45 + 0.45 * wave[0]), 0.6 * widest * wave[1]])


def laps(rng, count, limits):
    """Straights of 3 to 7 s joined by turns of 60 to 200 degrees, mostly to one side."""
    widest = limits.yaw_rate_rad_s * limits.width_m
    side = rng.choice([-1.0, 1.0])
    rows = np.empty((count, 2))
    row = 0
    while row < count:
        speed = limits.speed_m_s * rng.uniform(0.5, 1.0)
        length = round(rng.uniform(3.0, 7.0) * RATE_HZ)
        rows[row : row + length] = speed, 0.0
        row += length
        rate = limits.yaw_rate_rad_s * rng.uniform(0.5, 1.0)
        length = round(np.deg2rad(rng.uniform(60.0, 200.0)) / rate * RATE_HZ)
        turn = side * rng.choice([-1.0, 1.0], p=[0.3, 0.7])
        slower = rng.uniform(0.3, 0.9)
        rows[row : row + length] = speed * slower, turn * widest * rate / limits.yaw_rate_rad_s
        row += length
    return rows


STYLES = (holds, smooth, laps)


def _wander(rng, count, time_constant_s):
    """White noise under a Gaussian window, of unit variance."""
    reach = np.arange(-4 * time_constant_s, 4 * time_constant_s, 1 / RATE_HZ)
    window = np.exp(-0.5 * (reach / time_constant_s) ** 2)
    white = rng.standard_normal(count + len(window) - 1)
    return np.convolve(white, window, mode="valid") / np.sqrt((window**2).sum())


def _kept(speed, difference, limits):
    """Speed and difference within the limits; a tight turn is taken at less speed."""
    widest = min(limits.yaw_rate_rad_s * limits.width_m, 2 * limits.speed_m_s)
    difference = np.clip(difference, -widest, widest)
    by_tread = limits.speed_m_s - np.abs(difference) / 2
    by_lateral = limits.lateral_m_s2 * limits.width_m / np.maximum(np.abs(difference), 1e-9)
    fastest = np.minimum(by_tread, by_lateral)
    return np.clip(speed, -fastest, fastest), difference


def _slewed(treads):
    """The same, no tread faster in its change than the acceleration, from rest."""
    most = ACCELERATION_M_S2 / RATE_HZ
    changed = np.column_stack([followed(side, most, 0.0) for side in treads[1:].T])
    return np.vstack([np.zeros(2), changed])


def followed(wanted, most, start):
    """Values (N,) that go from a start towards those wanted (N,), by at most so much a row."""
    rows, at = [], float(start)
    for value in wanted.tolist():
        step = value - at
        at += most if step > most else -most if step < -most else step
        rows.append(at)
    return np.array(rows)
