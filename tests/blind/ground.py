"""Ground that a robot stands on: level, sloped, or rolling; z up, x and y in the world."""

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Ground:
    """A plane with waves on it.

    Attributes
    ----------
    gradient : (float, float)
        Rise per metre of the plane.
    waves : tuple of (amplitude_m, k_x, k_y, phase)
        Heights amplitude sin(k . r + phase), k in rad/m.
    """

    gradient: tuple[float, float] = (0.0, 0.0)
    waves: tuple[tuple[float, float, float, float], ...] = ()

    @property
    def level(self):
        return self.gradient == (0.0, 0.0) and not self.waves

    def slopes(self, x, y):
        """Gradient (g_x, g_y) and its derivatives (g_xx, g_xy, g_yy) at a point."""
        g_x, g_y = self.gradient
        g_xx = g_xy = g_yy = 0.0
        for amplitude, k_x, k_y, phase in self.waves:
            angle = k_x * x + k_y * y + phase
            steep, bent = amplitude * math.cos(angle), -amplitude * math.sin(angle)
            g_x, g_y = g_x + steep * k_x, g_y + steep * k_y
            g_xx, g_xy, g_yy = g_xx + bent * k_x**2, g_xy + bent * k_x * k_y, g_yy + bent * k_y**2
        return g_x, g_y, g_xx, g_xy, g_yy


def attitude_on(g_x, g_y, yaw):
    """Roll and pitch of a body flat on ground of this gradient (REP-103, nose down positive)."""
    cos, sin = math.cos(yaw), math.sin(yaw)
    ahead, left = g_x * cos + g_y * sin, g_y * cos - g_x * sin
    return math.asin(left / math.sqrt(1 + ahead**2 + left**2)), -math.atan(ahead)


def draw_ground(rng):
    """A plane of 4 to 12 degrees, or rolling ground of about 4 to 10 at its steepest."""
    if rng.uniform() < 0.6:
        slope, uphill = np.deg2rad(rng.uniform(4.0, 12.0)), rng.uniform(-np.pi, np.pi)
        rise = math.tan(slope)
        return Ground((rise * math.cos(uphill), rise * math.sin(uphill)))
    steepest = np.tan(np.deg2rad(rng.uniform(5.0, 10.0)))
    waves = []
    for _ in range(3):
        number, direction = 2 * np.pi / rng.uniform(12.0, 30.0), rng.uniform(-np.pi, np.pi)
        k = number * np.array([np.cos(direction), np.sin(direction)])
        amplitude = 0.6 * steepest / number
        waves.append((float(amplitude), *map(float, k), float(rng.uniform(-np.pi, np.pi))))
    return Ground(waves=tuple(waves))
