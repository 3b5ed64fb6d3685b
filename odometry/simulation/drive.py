"""A drive over several terrains by the motion of a rigid body, with the truth of every moment."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import SimulationError
from odometry.simulation.ground import GroundMap, footprint_points, to_world

STEPS_PER_SAMPLE = 5


class Driver(Protocol):
    """Whoever chooses the tread speeds."""

    def tread_speeds_m_s(self, time_s: float, pose_world: FloatArray) -> FloatArray:
        """Tread speeds (left, right) [m/s] at a time and true pose (x, y, yaw)."""


@dataclass(frozen=True, eq=False)
class Drive:
    """What truly happened, sampled at N stamps.

    Attributes
    ----------
    stamps_s : (N,) array
        Time [s], from 0.
    poses_world : (N, 3) array
        x, y [m] and yaw [rad], not wrapped.
    tread_speeds_m_s : (N, 2) array
        Left and right, each held until the next stamp.
    twists_body : (N, 3) array
        v_x, v_y [m/s], omega [rad/s] at the stamp.
    icrs_m : (N, 3) array
        y_left, y_right, x_icr at the stamp: of the strips under the robot, by their share of its
        footprint, plus the disturbance.
    terrains : tuple of str
        Terrain under the robot's centre at the stamp.
    """

    stamps_s: FloatArray
    poses_world: FloatArray
    tread_speeds_m_s: FloatArray
    twists_body: FloatArray
    icrs_m: FloatArray
    terrains: tuple[str, ...]


def simulate(
    driver: Driver,
    ground: GroundMap,
    strip_icrs_m: FloatArray,
    *,
    footprint_m: tuple[float, float],
    step_s: float,
    disturbances_m: FloatArray,
    start_pose: tuple[float, float, float] = (0.0, 0.0, 0.0),
    end_x_m: float = np.inf,
) -> Drive:
    """Drive until the robot is past `end_x_m` or the disturbances end.

    Parameters
    ----------
    driver : Driver
        Chooses the tread speeds at every stamp.
    ground : GroundMap
        The strips of terrain.
    strip_icrs_m : (n, 3) array
        y_left, y_right, x_icr on each strip [m].
    footprint_m : (float, float)
        Length and width of the rectangle on which the robot stands [m].
    step_s : float
        Time between stamps [s]; the motion between them is integrated in finer steps.
    disturbances_m : (N, 3) array
        Added to the ICRs from each stamp to the next; its length is the longest drive.
    start_pose : (float, float, float)
        x, y [m], yaw [rad] at the start.
    end_x_m : float
        World x at which the drive is over [m].

    Returns
    -------
    Drive
        At most N stamps.

    Raises
    ------
    SimulationError
        If the ICRs do not keep y_left above y_right, or there is not one row for each strip.
    """
    strip_icrs = np.asarray(strip_icrs_m, dtype=np.float64)
    _check_icrs(strip_icrs, disturbances_m, len(ground.terrains))
    footprint = footprint_points(*footprint_m)

    def icr_at(pose: FloatArray, disturbance: FloatArray) -> FloatArray:
        shares = ground.strip_shares(to_world(pose, footprint))
        return np.asarray(shares @ strip_icrs + disturbance)

    pose = np.array(start_pose, dtype=np.float64)
    poses, speeds, twists, icrs = [], [], [], []
    for k, disturbance in enumerate(disturbances_m):
        tread_speeds = driver.tread_speeds_m_s(k * step_s, pose)

        def rate(
            at: FloatArray, held: FloatArray = tread_speeds, shift: FloatArray = disturbance
        ) -> FloatArray:
            return pose_rate(at, body_twist(held, icr_at(at, shift)))

        poses.append(pose)
        speeds.append(tread_speeds)
        icrs.append(icr_at(pose, disturbance))
        twists.append(body_twist(tread_speeds, icrs[-1]))
        if pose[0] > end_x_m:
            break
        pose = runge_kutta_4(rate, pose, step_s, STEPS_PER_SAMPLE)
    poses_world = np.array(poses)
    return Drive(
        stamps_s=np.asarray(np.arange(len(poses)) * step_s),
        poses_world=poses_world,
        tread_speeds_m_s=np.array(speeds),
        twists_body=np.array(twists),
        icrs_m=np.array(icrs),
        terrains=tuple(ground.terrains[i] for i in ground.strip_at(poses_world[:, :2])),
    )


def _check_icrs(strip_icrs: FloatArray, disturbances: FloatArray, strips: int) -> None:
    if strip_icrs.shape != (strips, 3):
        raise SimulationError(f"{strips} strips need ICRs ({strips}, 3), found {strip_icrs.shape}")
    widths = strip_icrs[:, 0] - strip_icrs[:, 1]
    narrowing = disturbances[:, 1] - disturbances[:, 0]
    if widths.min() <= max(0.0, narrowing.max()):
        raise SimulationError(
            f"y_left must stay above y_right; the strips' widths are {widths.tolist()} m and the "
            f"disturbance narrows them by up to {narrowing.max():.3f} m"
        )


def body_twist(tread_speeds_m_s: FloatArray, icr: FloatArray) -> FloatArray:
    """Twist that meets three velocity constraints on points of the body.

    A body point (p_x, p_y) moves with (v_x - omega p_y, v_y + omega p_x). The point
    (x_icr, y_left) moves forward with the left tread's speed, (x_icr, y_right) with the right
    one's, and neither moves sideways.

    Parameters
    ----------
    tread_speeds_m_s : (2,) array
        Left and right tread surface speed [m/s].
    icr : (3,) array
        y_left, y_right, x_icr [m].

    Returns
    -------
    (3,) array
        v_x, v_y [m/s] and omega [rad/s].

    Raises
    ------
    numpy.linalg.LinAlgError
        If y_left equals y_right: the constraints then contradict each other.
    """
    y_left, y_right, x_icr = icr
    constraints = np.array([[1.0, 0.0, -y_left], [1.0, 0.0, -y_right], [0.0, 1.0, x_icr]])
    velocities = np.array([tread_speeds_m_s[0], tread_speeds_m_s[1], 0.0])
    return np.asarray(np.linalg.solve(constraints, velocities))


def pose_rate(pose_world: FloatArray, twist_body: FloatArray) -> FloatArray:
    """Rate of (x, y, yaw) in the world for a twist (v_x, v_y, omega) of the body."""
    cosine, sine = np.cos(pose_world[2]), np.sin(pose_world[2])
    v_x, v_y, omega = twist_body
    return np.array([cosine * v_x - sine * v_y, sine * v_x + cosine * v_y, omega])


def runge_kutta_4(
    rate: Callable[[FloatArray], FloatArray], state: FloatArray, duration_s: float, steps: int
) -> FloatArray:
    """Integrate d(state)/dt = rate(state) by the classical Runge-Kutta method of order 4.

    Parameters
    ----------
    rate : callable
        From a state to its rate, both arrays of one shape.
    state : array
        The state at the start.
    duration_s : float
        Time to integrate over [s].
    steps : int
        Number of equal steps; the error falls with its fourth power.

    Returns
    -------
    array
        The state at the end.
    """
    h = duration_s / steps
    for _ in range(steps):
        k1 = rate(state)
        k2 = rate(state + h / 2 * k1)
        k3 = rate(state + h / 2 * k2)
        k4 = rate(state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return state
