"""Geodetic places (WGS 84) as metres east, north and up of an origin; places that are none."""

import numpy as np

from odometry.arrays import BoolArray, FloatArray, IntArray
from odometry.installed import extra_module

# A receiver without a fix writes zeros, or nearly so; a robot that was ever a degree away from
# there did not drive to it
NEAR_ZERO_DEG, FAR_DEG = 1e-3, 1.0
Origin = tuple[float, float, float]  # latitude, longitude [degrees], altitude [m]


def zeros_within_deg(farthest_deg: float) -> float:
    """Size of latitude and longitude up to which they are zeros of a receiver without a fix.

    Below zero (no place is one) where the robot is near 0 N, 0 E all the time, as in some
    simulations: `farthest_deg` is its largest latitude or longitude.
    """
    return NEAR_ZERO_DEG if farthest_deg > FAR_DEG or farthest_deg == 0 else -1.0


def on_earth(degrees: FloatArray) -> BoolArray:
    """Whether latitude and longitude (N, 2) [degrees] are of a place on Earth."""
    return np.asarray((np.abs(degrees[:, 0]) <= 90) & (np.abs(degrees[:, 1]) <= 360))


class LocalMetres:
    """Turns geodetic places into metres east, north and up of an origin.

    Attributes
    ----------
    origin : Origin or None
        The first place, with the first altitude (0 without one), unless it is set before.
    """

    def __init__(self) -> None:
        self.origin: Origin | None = None

    def __call__(self, stamps_ns: IntArray, rows: FloatArray) -> tuple[IntArray, FloatArray]:
        """The stamps as they are, and `columns` of rows (N, 3)."""
        return stamps_ns, self.columns(rows)

    def columns(self, places: FloatArray) -> FloatArray:
        """Columns (N, 4): x (east), y (north), yaw (NaN), z (up; NaN without an altitude).

        Parameters
        ----------
        places : (N, 3)
            Latitude, longitude [degrees], altitude [m] or NaN.

        Raises
        ------
        ExtraError
            If pymap3d is not installed.
        """
        pymap3d = extra_module("pymap3d", "bags", "latitude and longitude in metres")
        if not len(places):
            return np.empty((0, 4))
        latitudes, longitudes, altitudes = places.T
        measured = np.isfinite(altitudes)
        if self.origin is None:
            altitude = altitudes[measured][0] if measured.any() else 0.0
            self.origin = float(latitudes[0]), float(longitudes[0]), float(altitude)
        altitudes = np.where(measured, altitudes, self.origin[2])
        east, north, up = pymap3d.geodetic2enu(latitudes, longitudes, altitudes, *self.origin)
        up = np.where(measured, up, np.nan)
        return np.column_stack([east, north, np.full(len(places), np.nan), up])
