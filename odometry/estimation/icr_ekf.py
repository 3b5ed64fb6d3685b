"""Pose and ICR filter: an extended Kalman filter that is told the terrain (Chen 2023, 3.1-3.2)."""

from collections.abc import Mapping
from dataclasses import replace
from typing import TypeGuard

import numpy as np

from odometry.arrays import FloatArray
from odometry.errors import ParameterError
from odometry.estimation.config import IcrEkfConfig
from odometry.estimation.corrections import Correction
from odometry.estimation.estimate import Estimate, IcrBelief, Innovation
from odometry.estimation.gaussian import gate_threshold, normalised_squared, project_into
from odometry.estimation.icr_prior import prior_belief
from odometry.estimation.pose_kalman import PoseKalman, pose_residual
from odometry.frames import Frame
from odometry.geometry.angles import wrap
from odometry.parameters import ParameterSet

SIDES = np.array([[0.0, 0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, -1.0, 0.0]])
GAP_DENSITY = np.array([25.0, 25.0, 9.0, 0.0, 0.0, 0.0])  # [m^2/s], [rad^2/s]: all may happen
LEAST_SIDE = 0.05  # of the track width; y_left and -y_right are kept above it


class IcrEkf:
    """Estimates x, y, yaw, y_left, y_right and x_icr from tread speeds and measured poses.

    Parameters
    ----------
    track_width : float
        [m]; the broad prior of a terrain without a table is centred on it.
    parameters : ParameterSet
        ICRs by terrain.
    config : IcrEkfConfig
    corrections : Mapping of terrain to Correction
        What the effects of the parameter set change along the run that is replayed.

    Raises
    ------
    ParameterError
        If a terrain has effects and no correction.

    Notes
    -----
    A frame goes in with the name of the terrain that the robot is on; a new Estimate comes out,
    and the one that went in is not changed. On a new name the ICRs are those last learned there
    or those of the parameter set, whichever is the more certain, and their covariance is reset
    to `reset_sigma_widths`, or to what was known before where that is less certain. A pose
    with NaN is as good as none. Over a gap of odometry the speed that was held goes on, but where
    the robot then is counts as not known, and the ICRs learn nothing of it.
    """

    def __init__(
        self,
        track_width: float,
        parameters: ParameterSet | None = None,
        config: IcrEkfConfig | None = None,
        corrections: Mapping[str, Correction] | None = None,
    ) -> None:
        self.track_width = track_width
        self.parameters = parameters or ParameterSet()
        self.config = config or IcrEkfConfig()
        self.corrections = corrections or {}
        self._require_corrections()
        c = self.config
        icr_noise = c.icr_noise_widths * track_width
        self._density = np.square([*[c.position_noise] * 2, c.yaw_noise, *[icr_noise] * 3])
        self._reset_sigma_m = c.reset_sigma_widths * track_width
        self._gate = gate_threshold(c.gate_probability, 3)
        self._jump = gate_threshold(c.jump_probability, 3 * c.jump_window)
        self._kalman = PoseKalman(
            np.diag(np.square([c.position_sigma_m, c.position_sigma_m, c.yaw_sigma_rad]))
        )

    def start(self, frame: Frame, terrain: str) -> Estimate:
        """Start at a frame: at its pose, or at the origin where it has none."""
        belief = self._prior(terrain)
        pose = frame.pose if _is_measured(frame.pose) else np.zeros(3)
        covariance = np.zeros((6, 6))
        covariance[:3, :3] = self._kalman.R
        covariance[3:, 3:] = belief.covariance
        estimate = Estimate(
            stamp_s=frame.stamp_s,
            mean=np.concatenate([pose, belief.icrs]),
            covariance=covariance,
            alphas=belief.alphas,
            tread_speeds_m_s=frame.tread_speeds_m_s,
            terrain=terrain,
        )
        return self._corrected(estimate, frame)

    def step(self, estimate: Estimate, frame: Frame, terrain: str) -> Estimate:
        """Predict to the frame's stamp, switch if the terrain is another, update by its pose."""
        estimate = self._predict(estimate, frame)
        if terrain != estimate.terrain:
            estimate = self._switch(estimate, terrain)
        estimate = self._corrected(estimate, frame)
        return self._update(estimate, frame.pose) if _is_measured(frame.pose) else estimate

    def _predict(self, estimate: Estimate, frame: Frame) -> Estimate:
        step_s = frame.stamp_s - estimate.stamp_s
        mean, covariance = estimate.mean, estimate.covariance
        if np.all(np.isfinite(estimate.tread_speeds_m_s)):
            mean, covariance = self._kalman.predicted(
                mean,
                covariance,
                estimate.effective_speeds_m_s,
                estimate.added_twist,
                step_s=step_s,
                density=self._density + GAP_DENSITY * frame.in_gap,
            )
        return replace(
            estimate,
            stamp_s=frame.stamp_s,
            mean=mean,
            covariance=covariance,
            tread_speeds_m_s=frame.tread_speeds_m_s,
            yaw_rate_rad_s=frame.yaw_rate_rad_s,
            innovation=None,
            jumped=False,
        )

    def _switch(self, estimate: Estimate, terrain: str) -> Estimate:
        learned = {**estimate.learned, estimate.terrain: estimate.belief}
        belief = self._prior(terrain)
        if terrain in learned and _is_more_certain(learned[terrain], belief):
            belief = learned[terrain]
        reset = self._reset_sigma_m**2 * np.eye(3)
        if np.trace(belief.covariance) > np.trace(reset):
            reset = belief.covariance
        return replace(
            estimate,
            mean=np.concatenate([estimate.mean[:3], belief.icrs]),
            covariance=_with_icr_block(estimate.covariance, reset),
            alphas=belief.alphas,
            terrain=terrain,
            learned=learned,
            recent=(),
        )

    def _update(self, estimate: Estimate, pose: FloatArray) -> Estimate:
        residual = pose_residual(pose, estimate.mean[:3])
        expected = estimate.covariance[:3, :3] + self._kalman.R
        squared = normalised_squared(residual, expected)
        estimate = self._check_jump(estimate, squared)
        accepted = squared <= self._gate
        innovation = Innovation(residual, squared, accepted)
        if not accepted:
            return self._refuse(estimate, pose, innovation)
        mean, covariance = self._kalman.updated(estimate.mean, estimate.covariance, pose)
        least = np.full(2, LEAST_SIDE * self.track_width)
        mean = project_into(mean, covariance, SIDES, least)
        mean[2] = wrap(mean[2])
        return replace(
            estimate, mean=mean, covariance=covariance, innovation=innovation, rejected_in_row=0
        )

    def _refuse(self, estimate: Estimate, pose: FloatArray, innovation: Innovation) -> Estimate:
        rejected_in_row = estimate.rejected_in_row + 1
        if rejected_in_row < self.config.gate_patience:
            return replace(estimate, innovation=innovation, rejected_in_row=rejected_in_row)
        covariance = np.zeros((6, 6))
        covariance[:3, :3] = self._kalman.R
        covariance[3:, 3:] = estimate.covariance[3:, 3:]
        return replace(
            estimate,
            mean=np.concatenate([pose, estimate.mean[3:]]),
            covariance=covariance,
            innovation=innovation,
            rejected_in_row=0,
        )

    def _check_jump(self, estimate: Estimate, squared: float) -> Estimate:
        """Chen 2023, 3.2: where the ICRs mutate, the error covariance is reset.

        A refused pose counts no more than the gate, so that one outlier alone is no jump.
        """
        if not self.config.detect_jumps:
            return estimate
        recent = (*estimate.recent, min(squared, self._gate))[-self.config.jump_window :]
        if len(recent) < self.config.jump_window or sum(recent) <= self._jump:
            return replace(estimate, recent=recent)
        reset = self._reset_sigma_m**2 * np.eye(3)
        covariance = _with_icr_block(estimate.covariance, reset)
        return replace(estimate, covariance=covariance, recent=(), jumped=True)

    def _corrected(self, estimate: Estimate, frame: Frame) -> Estimate:
        """The estimate with what effects change from this frame on."""
        correction, row = self.corrections.get(estimate.terrain), frame.odometry_row
        if correction is None or row < 0:
            return replace(estimate, added_speeds_m_s=np.zeros(2), added_twist=np.zeros(3))
        return replace(
            estimate,
            added_speeds_m_s=correction.speeds_m_s[row],
            added_twist=correction.twists[row],
        )

    def _require_corrections(self) -> None:
        for name, table in self.parameters.terrains.items():
            if table.effects and name not in self.corrections:
                raise ParameterError(
                    f"[terrain.{name}]: effects were given; the ICR filter needs what they change "
                    "along the run (odometry.estimation.corrections)"
                )

    def _prior(self, terrain: str) -> IcrBelief:
        return prior_belief(self.parameters, terrain, self.track_width, self._reset_sigma_m)


def _with_icr_block(covariance: FloatArray, block: FloatArray) -> FloatArray:
    changed = np.zeros((6, 6))
    changed[:3, :3] = covariance[:3, :3]
    changed[3:, 3:] = block
    return changed


def _is_measured(pose: FloatArray | None) -> TypeGuard[FloatArray]:
    return pose is not None and bool(np.all(np.isfinite(pose)))


def _is_more_certain(one: IcrBelief, other: IcrBelief) -> bool:
    return bool(np.trace(one.covariance) < np.trace(other.covariance))
