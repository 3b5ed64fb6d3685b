"""What a filter predicts from step to step, the variance that it adds, treads and gyroscope."""

import math
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.estimate import ALPHAS, ICRS, Estimate
from odometry.estimation.kalman import UNKNOWN_RAD, bounded, predicted, updated_by_number
from odometry.estimation.measurement import Gaussian, tread_yaw_rate, variance_of_slip_factors
from odometry.estimation.noise_scale import huber_factor, tread_variance
from odometry.estimation.transition import ALPHA_LEFT, GYRO_BIAS, STATES, YAW, X, Y, transition
from odometry.estimation.watches import contrary_treads, sensor_watch, tread_watch
from odometry.estimation.watches.frozen_treads import restored
from odometry.estimation.watches.sensor_watch import Events, SensorWatch
from odometry.recording.frames import Frame

GAP_DENSITY = 25.0, 9.0  # [m^2/s], [rad^2/s]: while speeds are not known, all may happen


class ProcessNoise:
    """Covariance that a step adds to the state, from the settings of the filter.

    Parameters
    ----------
    config : IcrEkfConfig
    track_width : float
        [m]
    """

    def __init__(self, config: IcrEkfConfig, track_width: float) -> None:
        self._position = config.position_noise**2
        self._yaw = config.yaw_noise**2
        self._slip = config.slip_noise**2
        self._yaw_by_slip = self._slip / track_width**2
        self._gyro = config.gyro_noise**2
        alpha_noise = config.alpha_noise if config.reset_sigma_alpha > 0 else 0.0
        density = np.zeros(STATES)
        density[ICRS] = (config.icr_noise_widths * track_width) ** 2
        density[ALPHAS] = alpha_noise**2
        if config.use_gyroscope:
            density[GYRO_BIAS] = config.bias_noise**2
        self._density = np.diag(density)

    def over_half(
        self,
        tread_speeds: FloatArray,
        step_s: float,
        *,
        slip_scale: float,
        by_gyroscope: bool,
        in_gap: bool,
        bias_walk: float = 1.0,
        alpha_walk: float = 1.0,
    ) -> FloatArray:
        """Covariance (9, 9) that half of a step adds: L Q L^T of Chen 2023 eq. 7 and 11.

        Parameters
        ----------
        tread_speeds : (2,)
            [m/s]; slip grows with the distance that they make.
        step_s : float
        slip_scale : float
            Factor on the variance of slip.
        by_gyroscope, in_gap : bool
            Whether the gyroscope turns the robot, and whether the tread speeds are not known.
        bias_walk, alpha_walk : float
            Factors on the noise of the random walk of the gyroscope's bias and of slip factors.
        """
        left, right = tread_speeds.tolist()
        travel_per_s = (abs(left) + abs(right)) / 2 * slip_scale
        position = self._position + self._slip * travel_per_s
        yaw = self._gyro if by_gyroscope else self._yaw + self._yaw_by_slip * travel_per_s
        if in_gap:
            position += GAP_DENSITY[0]
            yaw += 0.0 if by_gyroscope else GAP_DENSITY[1]
        half_s = step_s / 2
        covariance = self._density * half_s
        covariance[X, X] = covariance[Y, Y] = position * half_s
        covariance[YAW, YAW] = yaw * half_s
        if bias_walk != 1.0:
            covariance[GYRO_BIAS, GYRO_BIAS] *= bias_walk**2
        if alpha_walk != 1.0:
            covariance[ALPHAS, ALPHAS] *= alpha_walk**2
        return covariance


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
        self._compare_s = config.compare_s

    def at(self, frame: Frame, estimate: Estimate) -> Predicted:
        """Predict the state estimate at a frame's stamp from the one before it.

        Where a gyroscope turned the robot, the yaw rate of the treads over the same step is
        compared with it. Where the tread speeds are not known, nothing moves. Where the sensors
        are watched, what cannot be is kept out.
        """
        yaw_rate = frame.yaw_rate_rad_s if self._use_gyroscope else math.nan
        watch, held = estimate.watch, estimate.tread_speeds_m_s
        if watch is None:
            belief = self._moved(estimate, estimate.certain, frame, yaw_rate)
            return Predicted(belief, yaw_rate, frame.pose, frame.tread_speeds_m_s, None, ())
        seen = sensor_watch.sensed(
            watch,
            frame,
            estimate.stamp_s,
            speeds_m_s=held,
            yaw_rate=yaw_rate,
            belief=estimate.certain,
            terrain=estimate.terrain,
        )
        yaw_rate = seen.yaw_rate_rad_s
        belief = self._moved(estimate, seen.belief, frame, yaw_rate)
        was_stuck, scale = watch.treads.stuck >= 0, estimate.scale.slip
        watch, speeds, events = sensor_watch.with_treads(seen, frame, held, belief, scale)
        if frame.in_gap or watch.is_doubtful:
            newly_stuck = watch.treads.stuck >= 0 and not was_stuck
            if watch.frozen is not None and watch.is_frozen and not seen.watch.is_frozen:
                belief = restored(watch.frozen, frame.stamp_s, GAP_DENSITY[0])
            if watch.contrary is not None and watch.is_contrary:
                newly_found = not seen.watch.is_contrary
                belief = contrary_treads.parted(belief, watch.contrary, newly_found=newly_found)
                if newly_found:
                    watch = watch._replace(slip=None, held=None, stuck=None)
            else:
                belief = tread_watch.parted(belief, watch.treads, newly_stuck=newly_stuck)
        return Predicted(belief, yaw_rate, seen.pose, speeds, watch, events)

    def _moved(
        self, estimate: Estimate, before: Gaussian, frame: Frame, yaw_rate: float
    ) -> Gaussian:
        """Chen 2023 eq. 7, and the treads against the gyroscope."""
        step_s, speeds = frame.stamp_s - estimate.stamp_s, estimate.tread_speeds_m_s
        if math.isnan(sum(speeds.tolist())):
            return before
        by_gyroscope = not math.isnan(yaw_rate)
        mean, jacobian = transition(
            before[0],
            speeds,
            step_s,
            yaw_rate_rad_s=yaw_rate,
            added_speeds=estimate.added_speeds_m_s,
            added_twist=estimate.added_twist,
        )
        slip_scale = estimate.scale.slip
        if estimate.watch is not None and estimate.watch.is_contrary:
            slip_scale = max(slip_scale, contrary_treads.SLIP)
        half_noise = self._noise.over_half(
            speeds,
            step_s,
            slip_scale=slip_scale,
            by_gyroscope=by_gyroscope,
            in_gap=frame.in_gap or (estimate.watch is not None and estimate.watch.is_frozen),
            bias_walk=1.0 if estimate.watch is None else estimate.watch.bias.walk,
            alpha_walk=_alpha_walk(estimate),
        )
        covariance = predicted(before[1], jacobian, half_noise)
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
        recorded = estimate.tread_speeds_m_s
        speeds = recorded + estimate.added_speeds_m_s
        if self._compare_s > 0:
            motion = estimate.motion_until(step_s, yaw_rate)
            if motion.lasts_s < self._compare_s:
                return mean, covariance
            step_s, yaw_rate = motion.lasts_s, motion.turned_rad / motion.lasts_s
            recorded = speeds = motion.treads_m / step_s
        residual, by_state = tread_yaw_rate(
            mean, speeds, yaw_rate - float(estimate.added_twist[YAW])
        )
        # the turn by the treads: that of the gyroscope has their noise in it, and a weight
        # that depends on the noise would bend the width
        variance = tread_variance(
            recorded,
            yaw_rate - residual,
            self._track_width,
            estimate.scale.slip,
            step_s,
        )
        shared = covariance.dot(by_state)
        expected = float(by_state.dot(shared))
        variance *= huber_factor(residual, expected + variance)
        if estimate.scale.weighed is None or covariance[YAW, YAW] > UNKNOWN_RAD**2:
            variance += variance_of_slip_factors(by_state, covariance)
            by_state[ALPHA_LEFT:] = 0.0
            shared = covariance.dot(by_state)
            expected = float(by_state.dot(shared))
        return bounded(
            *updated_by_number((mean, covariance), shared, residual, expected + variance),
            self._track_width,
        )


def _alpha_walk(estimate: Estimate) -> float:
    watch = None if estimate.watch is None else estimate.watch.slip
    return 1.0 if watch is None else watch.walk(estimate.stamp_s)
