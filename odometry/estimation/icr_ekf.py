"""Pose and ICR filter: an extended Kalman filter that is told the terrain (Chen 2023, 3.1-3.2)."""

import math
from collections.abc import Mapping

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation import sensor_watch
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.corrections import Correction
from odometry.estimation.course import UNKNOWN_YAW_VARIANCE, Course
from odometry.estimation.errors import EstimationError
from odometry.estimation.estimate import OF_TERRAIN, Estimate
from odometry.estimation.measurement import (
    Gaussian,
    Place,
    reference_point,
    tread_yaw_rate,
    velocity_measurement,
)
from odometry.estimation.pose_kalman import PoseKalman
from odometry.estimation.pose_update import PoseUpdate
from odometry.estimation.process_noise import ProcessNoise
from odometry.estimation.terrain_beliefs import TerrainBeliefs
from odometry.estimation.transition import GYRO_BIAS, STATES, YAW, transition
from odometry.estimation.tread_noise import huber_factor, tread_variance, velocity_variances
from odometry.footing import Footing
from odometry.frames import Frame
from odometry.parameters import ParameterSet

NO_SPEEDS, NO_TWIST = np.zeros(2), np.zeros(3)


class IcrEkf:
    """Estimates pose, ICRs, bias of the gyroscope and slip factors of a skid-steer robot.

    Parameters
    ----------
    track_width : float
        [m]; the broad prior of a terrain without a table is centred on it.
    parameters : ParameterSet
        ICRs by terrain.
    config : IcrEkfConfig
    corrections : Mapping of terrain to Correction
        What the effects of the parameter set change along the run that is replayed.
    lever_m : (x, y)
        Place in the robot frame of the point whose position pose.csv measures.

    Raises
    ------
    ParameterError
        If a terrain has effects and no correction.

    Notes
    -----
    A frame goes in with the name of the terrain that the robot is on; a new Estimate comes out,
    and the one that went in is not changed. Where there is a gyroscope, it turns the robot, and
    the yaw rate of the treads is compared with it, which teaches y_left - y_right and the bias;
    otherwise the treads turn it. On a new name ICRs and slip factors are those last learned there
    or those of the parameter set, whichever is the more certain, and their covariance is reset
    to `reset_sigma_widths`, or to what was known before where that is less certain. Astride an
    edge they move from one terrain to the other, share by share; on terrain that is `unknown` they
    stay, become less certain, and nothing is learned of any terrain. Any part of a pose may be
    NaN; where the first one has no yaw, the heading is found from the course of the positions.
    Over a gap of odometry the speed that was held goes on, but where the robot then is counts as
    not known, and nothing is learned of it.
    """

    def __init__(
        self,
        track_width: float,
        parameters: ParameterSet | None = None,
        config: IcrEkfConfig | None = None,
        corrections: Mapping[str, Correction] | None = None,
        lever_m: Place = (0.0, 0.0),
    ) -> None:
        self.track_width = track_width
        self.parameters = parameters or ParameterSet()
        self.config = config or IcrEkfConfig()
        self.corrections = corrections or {}
        self._require_corrections()
        self._terrains = TerrainBeliefs(track_width, self.parameters, self.config)
        self._noise = ProcessNoise(self.config, track_width)
        self._kalman = PoseKalman()
        self._pose_update = PoseUpdate(self.config, track_width, self._kalman, lever_m)
        self._lever_m = lever_m

    def start(self, frame: Frame, terrain: str, *, yaw_sigma_rad: float | None = None) -> Estimate:
        """Start at a frame: at its pose, or at the origin where it has none.

        Parameters
        ----------
        frame : Frame
        terrain : str
        yaw_sigma_rad : float, optional
            Standard deviation of the yaw where it is not that of a measured one.
        """
        belief = self._terrains.prior(terrain)
        pose = np.full(3, math.nan) if frame.pose is None else frame.pose
        pose = np.where(np.isfinite(pose), pose, math.nan)
        placed, headed = not np.isnan(pose[:2]).any(), not math.isnan(pose[YAW])
        mean, covariance = np.zeros(STATES), np.zeros((STATES, STATES))
        covariance[:3, :3] = self._pose_update.covariance
        if headed:
            mean[YAW] = pose[YAW]
        if placed:
            mean[:2] = pose[:2] - reference_point(mean, self._lever_m)
        course = None
        if placed and not headed:
            course = Course.begun(frame.stamp_s, pose[:2], pose[:2])
            covariance[YAW, YAW] = UNKNOWN_YAW_VARIANCE
        elif yaw_sigma_rad is not None:
            covariance[YAW, YAW] = yaw_sigma_rad**2
        mean[OF_TERRAIN] = *belief.icrs, *belief.alphas
        covariance[np.ix_(OF_TERRAIN, OF_TERRAIN)] = belief.covariance
        if self.config.use_gyroscope:
            covariance[GYRO_BIAS, GYRO_BIAS] = self.config.bias_sigma_rad_s**2
        added_speeds, added_twist = self._added(terrain, frame)
        watch = None
        if self.config.watch_sensors:
            watch = sensor_watch.begun(frame, (mean, covariance))
        return Estimate(
            stamp_s=frame.stamp_s,
            mean=mean,
            covariance=covariance,
            tread_speeds_m_s=frame.tread_speeds_m_s,
            terrain=terrain,
            added_speeds_m_s=added_speeds,
            added_twist=added_twist,
            course=course,
            watch=watch,
        )

    def step(self, estimate: Estimate, frame: Frame, terrain: str | Footing) -> Estimate:
        """Predict to the frame's stamp, switch if the terrain is another, update by what it says.

        On shares of several terrains the ICRs lie between those known there.

        Raises
        ------
        EstimationError
            If the frame is older than the estimate.
        """
        if frame.stamp_s < estimate.stamp_s:
            raise EstimationError(
                f"a frame of {frame.stamp_s} s came after the estimate of {estimate.stamp_s} s; "
                "expected frames in time order (odometry.estimation.in_order puts late ones in "
                "their place)"
            )
        yaw_rate = frame.yaw_rate_rad_s if self.config.use_gyroscope else math.nan
        watch, pose, speeds = estimate.watch, frame.pose, frame.tread_speeds_m_s
        events: sensor_watch.Events = ()
        if watch is None:
            belief = self._predicted(estimate, frame, yaw_rate)
        else:
            held = estimate.tread_speeds_m_s
            seen = sensor_watch.sensed(watch, frame, estimate.stamp_s, held, yaw_rate)
            yaw_rate, pose = seen.yaw_rate_rad_s, seen.pose
            belief = self._predicted(estimate, frame, yaw_rate)
            was_stuck, scale = watch.treads.stuck >= 0, estimate.scale.slip
            watch, speeds, events = sensor_watch.with_treads(seen, frame, held, belief, scale)
            if frame.in_gap or watch.is_doubtful:
                newly_stuck = watch.treads.stuck >= 0 and not was_stuck
                belief = sensor_watch.parted(belief, watch, newly_stuck=newly_stuck)
        footing, recent = Footing.of(terrain), estimate.recent
        learned, crossing = estimate.learned, estimate.crossing
        if crossing or not footing.is_whole or footing.terrain != estimate.terrain:
            belief, learned, crossing = self._terrains.moved(belief, estimate, footing)
            recent = ()
        if frame.velocity is not None:
            belief = self._with_velocity(belief, estimate, frame, yaw_rate)
        after = self._pose_update.seen(estimate, belief, pose, frame, recent)
        added_speeds, added_twist = self._added(footing.terrain, frame)
        return Estimate(
            stamp_s=frame.stamp_s,
            mean=after.mean,
            covariance=after.covariance,
            tread_speeds_m_s=speeds,
            terrain=footing.terrain,
            yaw_rate_rad_s=frame.yaw_rate_rad_s,
            believed_yaw_rate_rad_s=yaw_rate,
            added_speeds_m_s=added_speeds,
            added_twist=added_twist,
            innovation=after.innovation,
            refused=after.refused,
            recent=after.recent,
            jumped=after.jumped,
            learned=learned,
            crossing=crossing,
            scale=after.scale,
            course=after.course,
            watch=watch,
            events=events + after.events,
        )

    def _predicted(self, estimate: Estimate, frame: Frame, yaw_rate: float) -> Gaussian:
        """Eq. 7, and the yaw rate of the treads against the gyroscope over the same step."""
        step_s, speeds = frame.stamp_s - estimate.stamp_s, estimate.tread_speeds_m_s
        if math.isnan(speeds[0] + speeds[1]):
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
        noise = self._noise.over(
            speeds,
            step_s,
            slip_scale=estimate.scale.slip,
            by_gyroscope=by_gyroscope,
            in_gap=frame.in_gap,
        )
        covariance = self._kalman.predicted(mean, jacobian, estimate.covariance, noise)
        doubtful = frame.in_gap or (estimate.watch is not None and estimate.watch.is_doubtful)
        if by_gyroscope and step_s > 0 and not doubtful:
            return self._compared(mean, covariance, estimate, yaw_rate, step_s)
        return mean, covariance

    def _compared(
        self,
        mean: FloatArray,
        covariance: FloatArray,
        estimate: Estimate,
        yaw_rate: float,
        step_s: float,
    ) -> Gaussian:
        speeds = estimate.tread_speeds_m_s + estimate.added_speeds_m_s
        measured = tread_yaw_rate(mean, speeds, yaw_rate - float(estimate.added_twist[YAW]))
        # the turn that the treads say: that of the gyroscope has their noise in it, and a weight
        # that depends on the noise would bend the width
        turn = yaw_rate - float(measured.residual[0])
        variance = tread_variance(
            estimate.tread_speeds_m_s, turn, self.track_width, estimate.scale.slip, step_s
        )
        variance *= huber_factor(measured, covariance, variance)
        measured.covariance[0, 0] = variance
        return self._kalman.updated(mean, covariance, measured)[:2]

    def _with_velocity(
        self, belief: Gaussian, estimate: Estimate, frame: Frame, yaw_rate: float
    ) -> Gaussian:
        """Measured velocity against the tread speeds that led to it."""
        speeds, step_s = estimate.tread_speeds_m_s, frame.stamp_s - estimate.stamp_s
        if frame.velocity is None or step_s <= 0 or math.isnan(speeds[0] + speeds[1]):
            return belief
        variances = velocity_variances(
            self.config,
            speeds,
            track_width=self.track_width,
            slip_scale=estimate.scale.slip,
            step_s=step_s,
            yaw_rate=yaw_rate,
        )
        measured = velocity_measurement(
            belief[0],
            frame.velocity - estimate.added_twist,
            speeds + estimate.added_speeds_m_s,
            yaw_rate - float(estimate.added_twist[YAW]),
            np.diag(variances),
        )
        if not len(measured.residual) or frame.in_gap:
            return belief
        return self._kalman.updated(*belief, measured)[:2]

    def _added(self, terrain: str, frame: Frame) -> tuple[FloatArray, FloatArray]:
        """What effects change from this frame on."""
        correction, row = self.corrections.get(terrain), frame.odometry_row
        if correction is None or row < 0:
            return NO_SPEEDS, NO_TWIST
        return correction.speeds_m_s[row], correction.twists[row]

    def _require_corrections(self) -> None:
        for name, table in self.parameters.terrains.items():
            if table.effects and name not in self.corrections:
                raise ParameterError(
                    f"[terrain.{name}]: effects were given; the ICR filter needs what they change "
                    "along the run (odometry.estimation.corrections)"
                )
