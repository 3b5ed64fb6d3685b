"""Motion of a rigid body whose treads prescribe velocities at chosen points.

Nothing here is taken from `odometry.models`: the twist is the solution of the constraints
themselves and the path comes from a Runge-Kutta method, so that an error in the closed forms
used by an estimator cannot be repeated here.
"""

from collections.abc import Callable

import numpy as np

from odometry.arrays import FloatArray


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
