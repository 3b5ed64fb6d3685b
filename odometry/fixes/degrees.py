"""Latitude and longitude in degrees: other units, exchanged columns, places that are none."""

from pathlib import Path

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.errors import TrajectoryError
from odometry.fixes.local_metres import on_earth

WHOLE_FROM = 1e5  # whole numbers above are of 1e-7 degrees: 0.01 degrees
# Angles in radians are below pi / 2 and pi. As degrees these would be on the sea at 0 N, 0 E, where
# no robot drives; simulations may lie there, but nearer to it than NEAR_ZERO_DEG
SEA_DEG = np.array([np.pi / 2, np.pi])
NEAR_ZERO_DEG = 0.1
ENOUGH = 7  # decimals of a degree: 0.01 m
DEG_M = 111_200.0
FARTHEST_M = 1e5  # from the place in the middle: no recording of a ground robot goes so far


def in_degrees(angles: FloatArray, said: str, file: Path) -> tuple[FloatArray, str]:
    """Angles (N, 2) of latitude and longitude in degrees, and a note on another unit.

    Parameters
    ----------
    angles : (N, 2)
        Finite; of rows with a fix.
    said : str
        The unit that the names of the columns state; empty without.

    Raises
    ------
    TrajectoryError
        If most rows are no degrees: exchanged columns, degrees and minutes, or something else.
    """
    if said.startswith("rad"):
        return np.degrees(angles), "radians, as its name says"
    places = angles[angles.any(axis=1)]  # zeros are of a receiver without a fix
    if not len(places):
        return angles, ""
    large = np.median(np.abs(places), axis=0).max() > WHOLE_FROM
    if said.endswith("e7") or (large and (angles == np.round(angles)).all()):
        return angles * 1e-7, "whole numbers of 1e-7 degrees"
    sizes = np.abs(places)
    if (sizes <= SEA_DEG).all() and sizes.max() > NEAR_ZERO_DEG:
        return np.degrees(angles), "radians (as degrees they would lie on the sea at 0 N, 0 E)"
    if np.mean(on_earth(places)) < 0.5:
        raise TrajectoryError(f"{file}: {_no_degrees(places)}")
    return angles, ""


def _no_degrees(angles: FloatArray) -> str:
    """What angles (N, 2) seem to be that are mostly no places in degrees."""
    latitude, longitude = np.median(angles, axis=0)
    seen = f"latitude is {latitude:.10g} and longitude {longitude:.10g} in the middle of its rows"
    if np.mean(on_earth(angles[:, ::-1])) > 0.5:
        return (
            f"{seen}: no place on Earth, but one when they are exchanged. Exchange the names of "
            "the two columns"
        )
    degrees, minutes = np.divmod(np.abs(angles), 100)
    if (degrees <= [90, 180]).all() and (minutes < 60).all():
        return (
            f"{seen}: degrees and minutes as NMEA writes them (4807.038 is 48 + 7.038 / 60 "
            "degrees). Convert both to degrees, south and west negative"
        )
    return f"{seen}: no place on Earth in degrees. Convert both to degrees"


def rounded(degrees: FloatArray) -> str:
    """A note on places (N, 2), one of whose angles was written with few decimals; else empty."""
    for decimals in range(ENOUGH):
        if (np.round(degrees, decimals) == degrees).all(axis=0).any():
            places = f"{decimals} decimal{'s' * (decimals != 1)}"
            step_m = DEG_M / 10**decimals
            return f"its degrees have {places}, steps of {step_m:.2g} m: write {ENOUGH} or more"
    return ""


def far_away(degrees: FloatArray) -> BoolArray:
    """Which places (N, 2) lie farther from the one in the middle than a recording goes."""
    middle = np.sort(degrees, axis=0)[len(degrees) // 2]
    apart = degrees - middle
    east = (apart[:, 1] + 180) % 360 - 180
    east *= np.cos(np.radians(middle[0]))
    return np.asarray(np.hypot(apart[:, 0], east) * DEG_M > FARTHEST_M)
