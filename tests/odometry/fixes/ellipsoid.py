"""WGS 84 from its definition: an oracle that shares nothing with the code."""

import numpy as np

AXIS_M, FLATTENING = 6378137.0, 1 / 298.257223563


def geocentric(latitude, longitude, height_m):
    """Earth-centred, Earth-fixed coordinates [m] of degrees and a height."""
    e2 = FLATTENING * (2 - FLATTENING)
    phi, lam = np.radians(latitude), np.radians(longitude)
    across_m = AXIS_M / np.sqrt(1 - e2 * np.sin(phi) ** 2)
    ring_m = (across_m + height_m) * np.cos(phi)
    return np.stack(
        [ring_m * np.cos(lam), ring_m * np.sin(lam), (across_m * (1 - e2) + height_m) * np.sin(phi)]
    )


def axes_at(latitude, longitude):
    """Rows: east, north and up there, in geocentric axes."""
    phi, lam = np.radians(latitude), np.radians(longitude)
    up = np.array([np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi)])
    east = np.array([-np.sin(lam), np.cos(lam), 0.0])
    return np.stack([east, np.cross(up, east), up])


def local_m(places, origin):
    """Metres east, north and up (N, 3) of an origin."""
    apart = geocentric(*np.asarray(places).T) - geocentric(*origin)[:, None]
    return (axes_at(*origin[:2]) @ apart).T


def place_of(east_m, north_m, up_m, origin):
    """Latitude, longitude and height of local metres, by Newton's method on `local_m`."""
    wanted = np.array([east_m, north_m, up_m])
    place = np.array(origin, dtype=float)
    scale = np.array([111_000.0, 111_000.0 * np.cos(np.radians(origin[0])), 1.0])
    for _ in range(20):
        left = wanted - local_m([place], origin)[0]
        place += left[[1, 0, 2]] / scale
    return place
