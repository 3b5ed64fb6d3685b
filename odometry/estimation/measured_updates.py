"""What a measured pose or velocity changes: it is weighed, refused, or the filter starts anew."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from odometry.arrays import FloatArray
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.course import Course
from odometry.estimation.estimate import OF_TERRAIN, Estimate, Innovation
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.filter_start import agree, new_start_event, searched, started_anew
from odometry.estimation.kalman import (
    UNKNOWN_RAD,
    Updated,
    bounded,
    gate_threshold,
    updated,
    updated_beside,
)
from odometry.estimation.measurement import (
    Gaussian,
    Measurement,
    Place,
    pose_measurement,
    velocity_measurement,
    weighed_down,
)
from odometry.estimation.noise_scale import NoiseScale, adapted, velocity_variances
from odometry.estimation.other_places import Others, left, return_event, returned, watched
from odometry.estimation.transition import YAW
from odometry.recording.frames import Frame


class Seen(NamedTuple):
    """The fields of an estimate that a pose changes, see `Estimate`."""

    mean: FloatArray
    covariance: FloatArray
    innovation: Innovation | None
    refused: tuple[FloatArray, ...]
    recent: tuple[float, ...]
    jumped: bool
    scale: NoiseScale
    course: Course | None
    events: tuple[FilterEvent, ...] = ()
    others: Others = ()


class PoseUpdate:
    """Takes measured poses in.

    Parameters
    ----------
    config : IcrEkfConfig
    track_width : float
        [m]
    lever_m : (x, y)
        Place of the measured point in the robot frame.
    """

    def __init__(self, config: IcrEkfConfig, track_width: float, lever_m: Place) -> None:
        self.config = config
        self.covariance = np.diag(  # R of Chen 2023 eq. 14
            np.square([config.position_sigma_m, config.position_sigma_m, config.yaw_sigma_rad])
        )
        self.lever_m = lever_m
        self._track_width = track_width
        self._reset_variances = np.square(
            [config.reset_sigma_widths * track_width] * 3 + [config.reset_sigma_alpha] * 2
        )
        self._gates, self._tails = (
            [0.0, *(gate_threshold(probability, size) for size in (1, 2, 3))]
            for probability in (config.gate_probability, config.tail_probability)
        )
        self._jump = gate_threshold(config.jump_probability, 3 * config.jump_window)

    def seen(
        self,
        estimate: Estimate,
        belief: Gaussian,
        pose: FloatArray | None,
        frame: Frame,
        recent: tuple[float, ...],
    ) -> Seen:
        """State estimate after a measured pose (3,), parts of which may be NaN.

        Parameters
        ----------
        estimate : Estimate
            The one before.
        belief : (9,), (9, 9)
            Mean and covariance at the stamp.
        pose : (3,) or None
        frame : Frame
            It came with.
        recent : tuple of float
            See `Estimate`; empty after a switch.
        """
        if pose is not None:
            scaled = self.covariance * estimate.scale.pose
            if estimate.course is not None:
                found = searched(estimate.course, belief, frame, scaled, self.lever_m)
                return self._nothing(estimate, found.belief, recent)._replace(
                    course=found.course, events=found.events
                )
            others, came_back = _others(estimate), None
            if others:
                others, came_back = watched(others, belief[0], pose, scaled, self.lever_m)
            there = belief if came_back is None else returned(belief, came_back)
            measured = pose_measurement(there[0], pose, scaled, self.lever_m)
            if came_back is not None:
                at_pose = started_anew(there, pose, scaled, self.lever_m, lost_yaw_rad=0.0)
                event = return_event(belief, came_back, frame.stamp_s)
                innovation = Innovation(measured.residual, 0.0, True)
                scale = estimate.scale
                return Seen(*at_pose, innovation, (), recent, False, scale, None, (event,), others)
            if len(measured.residual):
                after = self._taken(estimate, belief, measured, frame, recent)
                if after.events:
                    others = left(others, belief, (after.mean, after.covariance), frame.stamp_s)
                return after._replace(others=others) if others else after
        return self._nothing(estimate, belief, recent)

    def _nothing(self, estimate: Estimate, belief: Gaussian, recent: tuple[float, ...]) -> Seen:
        refused, scale, course = estimate.refused, estimate.scale, estimate.course
        others = _others(estimate)
        return Seen(*belief, None, refused, recent, False, scale, course, others=others)

    def _taken(
        self,
        estimate: Estimate,
        belief: Gaussian,
        measured: Measurement,
        frame: Frame,
        recent: tuple[float, ...],
    ) -> Seen:
        mean, covariance, squared, weighed = _updated(belief, measured)
        size, scale = len(measured.residual), estimate.scale
        jumped, gate = False, self._gates[size]
        accepted = squared <= gate
        refused = () if accepted else (*estimate.refused, measured.residual)
        # an outlier does not count for the noise; refused poses that agree show that it is larger
        rate = 0.0 if _are_contrary(estimate) else self.config.adapt_rate
        if rate > 0 and (accepted or agree(refused[-2:], self.covariance)):
            scale = adapted(scale, measured.residual, weighed, squared, rate)
        if self.config.detect_jumps and size == 3:
            recent = (*recent, min(squared, gate))[-self.config.jump_window :]
            jumped = len(recent) == self.config.jump_window and sum(recent) > self._jump
            if jumped:
                recent, belief = (), self._with_terrain_reset(belief)
        innovation = Innovation(measured.residual, squared, accepted)
        if not accepted:
            refused = refused[-self.config.gate_patience :]
            after = Seen(*belief, innovation, refused, recent, jumped, scale, None)
            if len(refused) < self.config.gate_patience or not agree(refused, self.covariance):
                return after
            pose = np.asarray(frame.pose)
            anew = started_anew(belief, pose, self.covariance * scale.pose, self.lever_m)
            event = new_start_event(refused, frame.stamp_s)
            return after._replace(mean=anew[0], covariance=anew[1], refused=(), events=(event,))
        if jumped or squared > self._tails[size]:
            factor = max(1.0, squared / self._tails[size])
            heavy = measured._replace(covariance=measured.covariance * factor)
            mean, covariance, _, _ = _updated(belief, heavy)
        mean, covariance = bounded(mean, covariance, self._track_width)
        return Seen(mean, covariance, innovation, (), recent, jumped, scale, None)

    def _with_terrain_reset(self, belief: Gaussian) -> Gaussian:
        """Chen 2023, 3.2: where the ICRs mutate, the error covariance is reset."""
        covariance = belief[1].copy()
        covariance[OF_TERRAIN], covariance[:, OF_TERRAIN] = 0.0, 0.0
        covariance[OF_TERRAIN, OF_TERRAIN] = self._reset_variances
        return belief[0], covariance


def _updated(belief: Gaussian, measured: Measurement) -> Updated:
    """As of `updated`; positions teach no ICRs and slip factors where the heading is not known.

    A way along a wrong heading is measured too short, whatever its sign: linearised, that is slip.
    """
    has_yaw = len(measured.residual) != 2
    if not has_yaw and belief[1][YAW, YAW] > UNKNOWN_RAD**2:
        return updated_beside(belief, measured, OF_TERRAIN)
    return updated(belief, measured)


def _are_contrary(estimate: Estimate) -> bool:
    return estimate.watch is not None and estimate.watch.is_contrary


def _others(estimate: Estimate) -> Others:
    return () if estimate.doubt is None else estimate.doubt.others


@dataclass(frozen=True)
class VelocityUpdate:
    """Takes measured velocities in.

    Attributes
    ----------
    config : IcrEkfConfig
    track_width : float
        [m]
    """

    config: IcrEkfConfig
    track_width: float

    def seen(self, belief: Gaussian, estimate: Estimate, frame: Frame, yaw_rate: float) -> Gaussian:
        """Mean (9,) and covariance (9, 9) after a frame's velocity, against the speeds before it.

        Parameters
        ----------
        belief : (9,), (9, 9)
            Predicted for the frame's stamp.
        estimate : Estimate
            The one before, whose tread speeds led to the frame.
        frame : Frame
        yaw_rate : float
            Of the gyroscope since then [rad/s]; NaN where the treads turn the robot.
        """
        speeds, step_s = estimate.tread_speeds_m_s, frame.stamp_s - estimate.stamp_s
        known = step_s > 0 and not frame.in_gap and not math.isnan(speeds[0] + speeds[1])
        known &= estimate.watch is None or not estimate.watch.is_frozen
        known &= not _are_contrary(estimate)
        if frame.velocity is None or not known:
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
        if not len(measured.residual):
            return belief
        after = updated(belief, weighed_down(measured, belief[1]))
        return bounded(after.mean, after.covariance, self.track_width)
