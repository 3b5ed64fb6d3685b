"""How steep the plane under a robot is, and which way up is (Martinez 2024 eq. 1 to 3)."""

import numpy as np

from odometry.arrays import FloatArray


def paper_attitude(roll_rad: FloatArray, pitch_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Roll alpha and pitch phi of Martinez 2024: about Y forward, then X right; phi > 0 nose up.

    Exact: both rotations give the body axes the same heights. Roll and pitch (...) are REP-103's.
    """
    sine = np.cos(pitch_rad) * np.sin(roll_rad)
    cosine = np.cos(pitch_rad) * np.cos(roll_rad)
    return np.arcsin(sine), np.arctan2(-np.sin(pitch_rad), cosine)


def steepest_slope(roll_rad: FloatArray, pitch_rad: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The largest slope under a robot, and where its nose points on it.

    Parameters
    ----------
    roll_rad, pitch_rad : (...)
        REP-103: roll > 0 has the right side down, pitch > 0 the nose.

    Returns
    -------
    beta_rad : (...)
        Largest slope as the paper has it: the angle from the vertical to second order (0.3 % too
        large at 10 degrees of roll and pitch).
    gamma_rad : (...)
        From straight uphill counter-clockwise to the robot's x axis, -pi to pi; NaN on level
        terrain, where no direction is uphill.

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> roll_rad, pitch_rad = np.array([0.0]), np.array([-0.1])  # nose up
    >>> slope_rad, heading_rad = odometry.steepest_slope(roll_rad, pitch_rad)
    >>> print(slope_rad, abs(heading_rad))
    [0.1] [0.]
    """
    alpha, phi = paper_attitude(np.asarray(roll_rad), np.asarray(pitch_rad))
    beta = np.hypot(alpha, phi)  # eq. 3
    gamma = np.arctan2(-alpha, phi)  # eq. 1 and 2
    return beta, np.where(beta > 0, gamma, np.nan)
