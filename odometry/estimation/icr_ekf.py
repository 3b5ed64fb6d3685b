"""Pose and ICR filter: an extended Kalman filter that is given the terrain (Chen 2023, 3.1-3.2)."""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from odometry.errors import EstimationError
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.corrections import Correction, added_from, require_corrections
from odometry.estimation.estimate import Estimate
from odometry.estimation.filter_changes import bias_followed, followed_at_rest
from odometry.estimation.filter_start import agree, first_belief
from odometry.estimation.held_update import HeldUpdate
from odometry.estimation.measured_updates import PoseUpdate, VelocityUpdate
from odometry.estimation.measurement import Place
from odometry.estimation.other_places import AGREEING, Covered, doubted, with_lasting_errors
from odometry.estimation.prediction import Prediction
from odometry.estimation.stuck_update import StuckUpdate
from odometry.estimation.terrain_beliefs import TerrainBeliefs
from odometry.estimation.watches import sensor_watch, slip_watch
from odometry.estimation.watches.rest_watch import stand
from odometry.parameters import ParameterSet
from odometry.recording.frames import Frame
from odometry.recording.run_terrains import Footing


class IcrEkf:
    """Estimates pose, ICRs, bias of the gyroscope and slip factors of a skid-steer robot.

    Parameters
    ----------
    track_width : float
        [m]; the broad prior is centred on it where no terrain has a table.
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

    Examples
    --------
    >>> import numpy as np
    >>> import odometry
    >>> ekf = odometry.IcrEkf(track_width=0.4)
    >>> treads = np.array([0.4, 0.6])
    >>> estimate = ekf.start(odometry.Frame(0.0, treads, 0, np.zeros(3), None), "grass")
    >>> estimate = ekf.step(estimate, odometry.Frame(0.1, treads, 1, None, None), "grass")
    >>> print(estimate.mean[:3].round(3))  # x, y [m], yaw [rad]: 0.05 m on, 0.05 rad to the left
    [0.05  0.001 0.05 ]
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
        require_corrections(self.parameters, self.corrections)
        self._terrains = TerrainBeliefs(track_width, self.parameters, self.config)
        self._prediction = Prediction(self.config, track_width)
        self._velocity_update = VelocityUpdate(self.config, track_width)
        self._pose_update = PoseUpdate(self.config, track_width, lever_m)
        self._stuck = StuckUpdate(self._pose_update.covariance, lever_m)
        self._held = HeldUpdate(self._pose_update.covariance, lever_m, self.config.slip_noise)
        self._lever_m = lever_m

    def start(self, frame: Frame, terrain: str, *, yaw_sigma_rad: float | None = None) -> Estimate:
        """Start at a frame: at its pose, or at the origin where it has none.

        Parameters
        ----------
        frame : Frame
        terrain : str
        yaw_sigma_rad : float, optional
            Standard deviation of the yaw where it is not that of a measured one.

        Raises
        ------
        EstimationError
            If the frame's stamp is not finite.
        """
        _require_finite(frame.stamp_s)
        config = self.config
        belief, course = first_belief(
            frame,
            self._terrains.prior(terrain),
            self._pose_update.covariance,
            self._lever_m,
            bias_sigma_rad_s=config.bias_sigma_rad_s if config.use_gyroscope else 0.0,
            yaw_sigma_rad=yaw_sigma_rad,
        )
        added_speeds, added_twist = added_from(self.corrections, terrain, frame.odometry_row)
        covariance, doubt = with_lasting_errors(belief, (belief[1], None), config.lasting_sigma_m)
        return Estimate(
            stamp_s=frame.stamp_s,
            mean=belief[0],
            covariance=covariance,
            doubt=doubt,
            tread_speeds_m_s=frame.tread_speeds_m_s,
            terrain=terrain,
            added_speeds_m_s=added_speeds,
            added_twist=added_twist,
            course=course,
            watch=sensor_watch.begun(frame, belief, config),
        )

    def step(self, estimate: Estimate, frame: Frame, terrain: str | Footing) -> Estimate:
        """Predict to the frame's stamp, switch where the terrain changes, update by measurements.

        On shares of several terrains the ICRs lie between those known there.

        Raises
        ------
        EstimationError
            If the frame is older than the estimate, or its stamp is not finite.
        """
        if not frame.stamp_s >= estimate.stamp_s or math.isinf(frame.stamp_s):
            _require_finite(frame.stamp_s)
            raise EstimationError(
                f"a frame of {frame.stamp_s} s came after the estimate of {estimate.stamp_s} s; "
                "expected frames in time order (odometry.estimation.in_order puts late ones in "
                "their place)"
            )
        predicted = self._prediction.at(frame, estimate)
        belief, yaw_rate = predicted.belief, predicted.yaw_rate_rad_s
        recent, learned, crossing = estimate.recent, estimate.learned, estimate.crossing
        if crossing is not None or terrain != estimate.terrain:
            footing = Footing.of(terrain)
            terrain = footing.terrain
            if crossing is not None or not footing.is_whole or terrain != estimate.terrain:
                belief, learned, crossing = self._terrains.moved(belief, estimate, footing)
                recent = ()
        if frame.velocity is not None:
            belief = self._velocity_update.seen(belief, estimate, frame, yaw_rate)
        after = self._pose_update.seen(estimate, belief, predicted.pose, frame, recent)
        watch = predicted.watch
        if watch is not None and (watch.rest or stand(estimate.tread_speeds_m_s)):
            after, rest = followed_at_rest(
                estimate,
                predicted.pose,
                frame.stamp_s,
                after,
                yaw_rate_rad_s=yaw_rate,
                pose_covariance=self._pose_update.covariance,
                lever_m=self._lever_m,
            )
            predicted = predicted._replace(watch=watch._replace(rest=rest))
        if predicted.watch is not None:
            if predicted.watch.held is not None:
                after, predicted = self._held.followed(estimate, predicted, frame, terrain, after)
            after, predicted = self._stuck.followed(estimate, predicted, frame, terrain, after)
        belief, watch, of_bias = bias_followed(estimate, predicted, after, frame.stamp_s)
        if watch is not None and predicted.pose is not None and crossing is None:
            slip = slip_watch.watched(watch.slip, belief, frame.stamp_s, terrain)
            watch = watch if slip is watch.slip else watch._replace(slip=slip)
        covered: Covered = belief[1], None
        if self.config.watch_sensors and (after.others or after.refused):
            pose_covariance, refused = self._pose_update.covariance, after.refused
            is_apart = len(refused) >= AGREEING and agree(refused, pose_covariance)
            last = refused[-1] if is_apart else None
            covered = doubted(belief, after.others, last, pose_covariance, frame.stamp_s)
        covariance, doubt = with_lasting_errors(belief, covered, self.config.lasting_sigma_m)
        added_speeds, added_twist = added_from(self.corrections, terrain, frame.odometry_row)
        return Estimate(
            stamp_s=frame.stamp_s,
            mean=belief[0],
            covariance=covariance,
            tread_speeds_m_s=predicted.speeds_m_s,
            terrain=terrain,
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
            events=predicted.events + after.events + of_bias,
            doubt=doubt,
            compared_later=estimate.waiting(frame, yaw_rate, self.config.compare_s),
        )


def _require_finite(stamp_s: float) -> None:
    if not math.isfinite(stamp_s):
        raise EstimationError(f"a frame has the stamp {stamp_s}; expected a finite number of s")


class MeansKept:
    """A filter that keeps its estimated ICRs on another terrain, with a larger covariance.

    The covariance of the ICRs becomes the filter's P_B, `reset_sigma_widths`; what was learned
    on the terrain before is not taken up again.

    Parameters
    ----------
    ekf : IcrEkf
        Without a parameter set.
    """

    def __init__(self, ekf: IcrEkf) -> None:
        self._ekf = ekf

    def start(self, frame: Frame, terrain: str, *, yaw_sigma_rad: float | None = None) -> Estimate:
        """The first estimate, see `IcrEkf.start`."""
        return self._ekf.start(frame, terrain, yaw_sigma_rad=yaw_sigma_rad)

    def step(self, estimate: Estimate, frame: Frame, terrain: str | Footing) -> Estimate:
        """The next estimate, see `IcrEkf.step`; the terrain changes in one step."""
        name = Footing.of(terrain).terrain
        if name != estimate.terrain:
            belief = estimate.belief
            known = replace(belief, covariance=np.zeros_like(belief.covariance))
            estimate = replace(estimate, learned={**estimate.learned, name: known})
        return self._ekf.step(estimate, frame, name)
