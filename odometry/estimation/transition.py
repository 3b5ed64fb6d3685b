"""Motion of the state (x, y, yaw, y_left, y_right, x_icr) over one time step."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.geometry import se2
from odometry.models.icr import icr_twist, icr_twist_jacobian

STILL = np.zeros(3)


def transition(
    state: FloatArray, tread_speeds: FloatArray, step_s: float, added_twist: FloatArray = STILL
) -> tuple[FloatArray, FloatArray]:
    """Carry a state along at constant tread speeds.

    Parameters
    ----------
    state : (6,)
        x, y [m], yaw [rad], y_left, y_right, x_icr [m].
    tread_speeds : (2,)
        Effective tread speeds, left and right [m/s].
    step_s : float
    added_twist : (3,)
        What effects add to the body twist of the ICRs.

    Returns
    -------
    next_state : (6,)
        Chen 2023 eq. 4, integrated exactly along the arc instead of by eq. 5's Euler step, so
        that splitting a step changes nothing. ICRs stay.
    jacobian : (6, 6)
        Its derivative by `state`: I + dT df/dX of eq. 8 in the limit of small steps.
    """
    pose, icrs = state[:3], state[3:]
    displacement = (icr_twist(icrs, tread_speeds) + added_twist) * step_s
    next_pose = se2.compose(pose, se2.exp(displacement))
    cosine, sine = np.cos(pose[2]), np.sin(pose[2])
    to_world = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    by_icr = icr_twist_jacobian(icrs, tread_speeds) * step_s
    jacobian = np.eye(6)
    jacobian[0, 2] = pose[1] - next_pose[1]  # eq. 9: d(Xdot)/d(theta) = -Ydot
    jacobian[1, 2] = next_pose[0] - pose[0]  # eq. 9: d(Ydot)/d(theta) = +Xdot
    jacobian[:3, 3:] = to_world @ se2.exp_jacobian(displacement) @ by_icr  # eq. 10
    return np.concatenate([next_pose, icrs]), jacobian


def process_noise(jacobian: FloatArray, density: FloatArray, step_s: float) -> FloatArray:
    """Covariance (6, 6) that white noise adds over a step.

    Parameters
    ----------
    jacobian : (6, 6)
        Of the step.
    density : (6,)
        Variance per second of each state.
    step_s : float

    Notes
    -----
    The trapezium rule for the integral of F(s) Q F(s)^T: the first step of Chen 2023 eq. 7 would
    make the answer depend on how finely time is cut.
    """
    return np.asarray((np.diag(density) + (jacobian * density) @ jacobian.T) * (step_s / 2))
