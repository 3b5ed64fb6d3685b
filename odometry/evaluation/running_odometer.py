"""The odometer of a filter as it drives, and how far off it may be."""

import math

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.estimate import ICRS, Estimate
from odometry.estimation.transition import GYRO_BIAS, STATES, Y_LEFT, YAW, transition
from odometry.evaluation.odometer_noise import NOISE_WITHOUT_POSES
from odometry.evaluation.open_loop_errors import AMOUNTS, COMPONENTS
from odometry.geometry import se2
from odometry.geometry.angles import wrap, wrap_one

RANDOM, _OF_CONSTANT = NOISE_WITHOUT_POSES.variances.reshape(2, len(COMPONENTS), len(AMOUNTS))
CONSTANT = np.sqrt(_OF_CONSTANT)


class RunningOdometer:
    """Integrates the twists that a filter held, never corrected by a pose.

    Parameters
    ----------
    estimate : Estimate
        The first; the odometer starts at its pose.

    Attributes
    ----------
    pose : (3,)
        x, y [m], yaw [rad] at the latest estimate.
    twist : (3,)
        v_x, v_y [m/s], omega [rad/s] in the robot frame over the step that led to it.

    Notes
    -----
    The covariance is the one that `odometer_uncertainty` gives a whole run without poses, which
    adds up sums along the path; here the derivative of `transition` carries it from step to step.
    With poses it is the same: how far they are from the odometer is not measured live.
    """

    def __init__(self, estimate: Estimate) -> None:
        self._held = estimate
        self._start = estimate.mean[:3]
        self._moved = np.zeros(3)  # x, y [m], yaw [rad] since the start, yaw not wrapped
        self.pose, self.twist = self._at(), np.zeros(3)
        self._random = estimate.covariance[:3, :3].copy()
        self._lasting = np.zeros((3, CONSTANT.size + STATES - Y_LEFT))  # by constants, parameters

    @property
    def covariance(self) -> FloatArray:
        """Covariance (3, 3) of x, y [m], yaw [rad] at the latest estimate, to first order."""
        return np.asarray(self._random + self._lasting @ self._lasting.T)

    def step(self, estimate: Estimate) -> None:
        """Go on to the next estimate."""
        duration_s = estimate.stamp_s - self._held.stamp_s
        self._carry_errors(estimate, duration_s)
        self.twist = self._twist_until(estimate)
        step = se2.exp(self.twist * duration_s)
        yaw = self._start[2] + self._moved[2]
        cosine, sine = np.cos(yaw), np.sin(yaw)
        along_x = cosine * step[0] - sine * step[1]
        along_y = sine * step[0] + cosine * step[1]
        self._moved = self._moved + np.array([along_x, along_y, step[2]])
        self._held = estimate
        self.pose = self._at()

    def _at(self) -> FloatArray:
        x, y, yaw = self._start + self._moved
        return np.array([x, y, wrap(yaw)])

    def _twist_until(self, estimate: Estimate) -> FloatArray:
        """Body twist (3,) up to an estimate, as `Replay.odometer_twists` has it."""
        held = self._held
        y_left, y_right, x_icr = held.mean[ICRS]
        omega = estimate.believed_yaw_rate_rad_s - held.mean[GYRO_BIAS] - held.added_twist[YAW]
        # v_x = alpha v + y omega of either tread (Baril 2020 eq. 4 to 6), the mean of both
        v_x = held.effective_speeds_m_s.mean() + (y_left + y_right) / 2 * omega
        by_gyroscope = held.added_twist + np.array([v_x, -x_icr * omega, omega])
        return np.asarray(by_gyroscope if np.isfinite(by_gyroscope).all() else held.twist)

    def _carry_errors(self, estimate: Estimate, duration_s: float) -> None:
        """Carry the covariance over the step to an estimate.

        Errors are made in the robot frame at the middle of the step: one of yaw there turns the
        second half of it.
        """
        held = self._held
        left, right = (held.tread_speeds_m_s * duration_s).tolist()
        if math.isnan(left + right):
            return
        ends, derivative = transition(
            np.concatenate([self.pose, held.mean[Y_LEFT:]]),
            held.tread_speeds_m_s,
            duration_s,
            yaw_rate_rad_s=estimate.believed_yaw_rate_rad_s,
            added_speeds=held.added_speeds_m_s,
            added_twist=held.added_twist,
        )
        x, y, turn = ends[:Y_LEFT] - self.pose
        turn = wrap_one(turn)
        cosine, sine = math.cos(self.pose[YAW] + turn / 2), math.sin(self.pose[YAW] + turn / 2)
        by_error = np.array([[cosine, -sine, -y / 2], [sine, cosine, x / 2], [0.0, 0.0, 1.0]])
        carry = derivative[:Y_LEFT, :Y_LEFT]
        travel_m, signed_m = (abs(left) + abs(right)) / 2, (left + right) / 2
        random = by_error * RANDOM.dot([travel_m, abs(turn)])
        self._random = carry.dot(self._random).dot(carry.T) + random.dot(by_error.T)
        constant = by_error[:, :, None] * (CONSTANT * [signed_m, turn])
        sigmas = np.sqrt(held.covariance.diagonal()[Y_LEFT:])
        made = np.hstack([constant.reshape(Y_LEFT, -1), derivative[:Y_LEFT, Y_LEFT:] * sigmas])
        self._lasting = carry.dot(self._lasting) + made
