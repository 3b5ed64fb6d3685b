"""What a filter predicts from step to step: the motion, and the treads against the gyroscope."""

import math
from dataclasses import replace
from typing import NamedTuple

from odometry.arrays import FloatArray
from odometry.estimation import sensor_watch
from odometry.estimation.bounds import bounded
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.estimate import Estimate
from odometry.estimation.kalman import predicted, updated_by_number
from odometry.estimation.measurement import Gaussian, tread_yaw_rate
from odometry.estimation.process_noise import ProcessNoise
from odometry.estimation.sensor_watch import Events, SensorWatch
from odometry.estimation.transition import ALPHA_LEFT, YAW, transition
from odometry.estimation.tread_noise import huber_factor, tread_variance
from odometry.frames import Frame


class Predicted(NamedTuple):
    """State estimate at a frame's stamp before its pose and velocity are used.

    Attributes
    ----------
    belief : (9,), (9, 9)
        Mean and covariance.
    yaw_rate_rad_s : float
        That turned the robot since the estimate before; NaN where the treads did.
    pose : (3,) or None
        Of the frame, where it is to be used.
    speeds_m_s : (2,)
        Tread speeds from the frame on.
    watch : SensorWatch or None
    events : tuple of FilterEvent
    """

    belief: Gaussian
    yaw_rate_rad_s: float
    pose: FloatArray | None
    speeds_m_s: FloatArray
    watch: SensorWatch | None
    events: Events


class Prediction:
    """Predicts the state estimate from one stamp to the next.

    Parameters
    ----------
    config : IcrEkfConfig
    track_width : float
        [m]
    """

    def __init__(self, config: IcrEkfConfig, track_width: float) -> None:
        self._use_gyroscope = config.use_gyroscope
        self._track_width = track_width
        self._noise = ProcessNoise(config, track_width)

    def at(self, frame: Frame, estimate: Estimate) -> Predicted:
        """Predict the state estimate at a frame's stamp from the one before it.

        Where a gyroscope turned the robot, the yaw rate of the treads over the same step is
        compared with it. Where the tread speeds are not known, nothing moves. Where the sensors
        are watched, what cannot be is kept out.
        """
        yaw_rate = frame.yaw_rate_rad_s if self._use_gyroscope else math.nan
        watch, held = estimate.watch, estimate.tread_speeds_m_s
        if watch is None:
            belief = self._moved(estimate, frame, yaw_rate)
            return Predicted(belief, yaw_rate, frame.pose, frame.tread_speeds_m_s, None, ())
        seen = sensor_watch.sensed(
            watch,
            frame,
            estimate.stamp_s,
            speeds_m_s=held,
            yaw_rate=yaw_rate,
            belief=(estimate.mean, estimate.covariance),
            terrain=estimate.terrain,
        )
        yaw_rate = seen.yaw_rate_rad_s
        if seen.belief[0] is not estimate.mean:
            estimate = replace(estimate, mean=seen.belief[0], covariance=seen.belief[1])
        belief = self._moved(estimate, frame, yaw_rate)
        was_stuck, scale = watch.treads.stuck >= 0, estimate.scale.slip
        watch, speeds, events = sensor_watch.with_treads(seen, frame, held, belief, scale)
        if frame.in_gap or watch.is_doubtful:
            newly_stuck = watch.treads.stuck >= 0 and not was_stuck
            belief = sensor_watch.parted(belief, watch, newly_stuck=newly_stuck)
        return Predicted(belief, yaw_rate, seen.pose, speeds, watch, events)

    def _moved(self, estimate: Estimate, frame: Frame, yaw_rate: float) -> Gaussian:
        """Chen 2023 eq. 7, and the treads against the gyroscope."""
        step_s, speeds = frame.stamp_s - estimate.stamp_s, estimate.tread_speeds_m_s
        if math.isnan(sum(speeds.tolist())):
            return estimate.mean, estimate.covariance
        by_gyroscope = not math.isnan(yaw_rate)
        mean, jacobian = transition(
            estimate.mean,
            speeds,
            step_s,
            yaw_rate_rad_s=yaw_rate,
            added_speeds=estimate.added_speeds_m_s,
            added_twist=estimate.added_twist,
        )
        half_noise = self._noise.over_half(
            speeds,
            step_s,
            slip_scale=estimate.scale.slip,
            by_gyroscope=by_gyroscope,
            in_gap=frame.in_gap,
            bias_walk=1.0 if estimate.watch is None else estimate.watch.bias.walk,
        )
        covariance = predicted(estimate.covariance, jacobian, half_noise)
        if not by_gyroscope or step_s == 0 or frame.in_gap:
            return mean, covariance
        if estimate.watch is not None and estimate.watch.is_doubtful:
            return mean, covariance
        return self._compared(mean, covariance, estimate, yaw_rate, step_s)

    def _compared(
        self,
        mean: FloatArray,
        covariance: FloatArray,
        estimate: Estimate,
        yaw_rate: float,
        step_s: float,
    ) -> Gaussian:
        speeds = estimate.tread_speeds_m_s + estimate.added_speeds_m_s
        residual, by_state = tread_yaw_rate(
            mean, speeds, yaw_rate - float(estimate.added_twist[YAW])
        )
        # the turn by the treads: that of the gyroscope has their noise in it, and a weight
        # that depends on the noise would bend the width
        variance = tread_variance(
            estimate.tread_speeds_m_s,
            yaw_rate - residual,
            self._track_width,
            estimate.scale.slip,
            step_s,
        )
        shared = covariance.dot(by_state)
        expected = float(by_state.dot(shared))
        variance *= huber_factor(residual, expected + variance)
        if estimate.scale.weighed is None:
            variance += _of_slip_factors(by_state, covariance)
            by_state[ALPHA_LEFT:] = 0.0
            shared = covariance.dot(by_state)
            expected = float(by_state.dot(shared))
        return bounded(
            *updated_by_number((mean, covariance), shared, residual, expected + variance),
            self._track_width,
        )


def _of_slip_factors(by_state: FloatArray, covariance: FloatArray) -> float:
    """Variance of the treads' yaw rate by what is not known of slip factors.

    A yaw rate determines slip factors and y_left - y_right only as one ratio: where no pose gave
    how far the robot moves, it teaches the difference alone.
    """
    by_slip = by_state[ALPHA_LEFT:]
    return float(by_slip.dot(covariance[ALPHA_LEFT:, ALPHA_LEFT:]).dot(by_slip))
