"""A robot that is moved while its treads stand: pushed, dragged, carried, or it slides."""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.measurement import Gaussian
from odometry.estimation.noise_scale import NoiseScale
from odometry.geometry.angles import wrap_one

STILL_M_S = 0.01  # a slower tread is stationary
SETTLED_S = 1.0  # after that a robot that braked, and poses that are late, are stationary too
REFERENCE = 3  # poses for its place
IN_A_ROW = 3  # poses that must show another one
MOVED_M, MOVED_RAD, SIGMAS = 0.15, 0.15, 4.0  # by the larger of these and of SIGMAS
# resting robots of data/motion wander by at most 0.05 m in the poses


class RestWatch(NamedTuple):
    """What is remembered while the treads stand.

    Attributes
    ----------
    since_s : float
        Stamp since when they do.
    before : (9,), (9, 9)
        State estimate then.
    scale : NoiseScale
        Estimated then.
    poses : tuple of (x, y, yaw)
        The first ones that were measured since the robot has settled, or was moved last.
    away : tuple of (x, y, yaw)
        The latest in a row that show another place.
    stood_m : (2,) or None
        Where it stood before it was found moved; None where it was not.
    moved_since_s, moved_m : float
        Stamp at which it was found moved (NaN: it was not), and how far from where it stood.
    turned_rad : float
        By the gyroscope since `since_s`, less its bias then.
    """

    since_s: float
    before: Gaussian
    scale: NoiseScale
    poses: tuple[FloatArray, ...] = ()
    away: tuple[FloatArray, ...] = ()
    stood_m: FloatArray | None = None
    moved_since_s: float = math.nan
    moved_m: float = 0.0
    turned_rad: float = 0.0


def stand(speeds_m_s: FloatArray) -> bool:
    """Whether treads (2,) stand."""
    left, right = speeds_m_s.tolist()
    return bool(-STILL_M_S <= left <= STILL_M_S and -STILL_M_S <= right <= STILL_M_S)


def watched(
    watch: RestWatch, pose: FloatArray, stamp_s: float, pose_covariance: FloatArray
) -> tuple[RestWatch, bool]:
    """The watch after a measured pose (3,), and whether that shows that the robot was moved.

    Parameters
    ----------
    watch : RestWatch
    pose : (3,)
        Its yaw may be NaN; without a position it is not used.
    stamp_s : float
    pose_covariance : (3, 3)
        As the filter scales it.
    """
    if stamp_s - watch.since_s < SETTLED_S or math.isnan(pose[0] + pose[1]):
        return watch, False
    if len(watch.poses) < REFERENCE:
        return watch._replace(poses=(*watch.poses, pose)), False
    sigma_m, sigma_rad = math.sqrt(pose_covariance[0, 0]), math.sqrt(pose_covariance[2, 2])
    most = max(MOVED_M, SIGMAS * sigma_m), max(MOVED_RAD, SIGMAS * sigma_rad)
    place_m = np.mean([each[:2] for each in watch.poses], axis=0)
    moved_m = math.hypot(*(pose[:2] - place_m))
    yaws_rad = [each[2] for each in (*watch.poses, pose) if not math.isnan(each[2])]
    turn_rad = 0.0 if math.isnan(pose[2]) else abs(wrap_one(pose[2] - yaws_rad[-2:][0]))
    if moved_m <= most[0] and not turn_rad > most[1]:
        return watch._replace(away=()), False
    near_m = max(most[0], moved_m / 2)
    near = [each for each in watch.away if math.hypot(*(each[:2] - pose[:2])) <= near_m]
    away = (*near, pose)
    if len(away) < IN_A_ROW:
        return watch._replace(away=away), False
    stood_m, since_s = watch.stood_m, watch.moved_since_s
    if stood_m is None:
        stood_m, since_s = place_m, stamp_s
    after = watch._replace(
        poses=away,
        away=(),
        stood_m=stood_m,
        moved_since_s=since_s,
        moved_m=math.hypot(*(pose[:2] - stood_m)),
    )
    return after, True


def ended(watch: RestWatch, stamp_s: float) -> tuple[FilterEvent, ...]:
    """The event of a robot that was moved until a stamp."""
    if watch.stood_m is None:
        return ()
    text = (
        f"the treads were stationary, and the poses moved by {watch.moved_m:.2f} m or turned: the "
        "robot was pushed or slid, or the poses drift; the filter followed them and learned "
        "nothing of it"
    )
    return (FilterEvent("moved_at_rest", watch.moved_since_s, stamp_s, text, (watch.moved_m,)),)
