"""Estimates at every frame of a run, and the trajectories that follow from them."""

import math
from dataclasses import dataclass

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.dead_reckoning import dead_reckon
from odometry.estimation.estimate import ALPHAS, ICRS, Estimate
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.transition import GYRO_BIAS
from odometry.models.icr import icr_twist
from odometry.trajectory import Trajectory


@dataclass(frozen=True)
class Replay:
    """Estimates at every frame of a run, as they were when the frame came in.

    Attributes
    ----------
    estimates : tuple of Estimate

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> gravel = odometry.ConstantTerrain("gravel")
    >>> filtered = odometry.replay(run, odometry.IcrEkf(track_width=0.4), gravel)
    >>> filtered.means.shape, len(filtered.trajectory())
    ((1085, 9), 1085)
    """

    estimates: tuple[Estimate, ...]

    @property
    def stamps_s(self) -> FloatArray:
        """Stamps (N,)."""
        return np.array([estimate.stamp_s for estimate in self.estimates])

    @property
    def means(self) -> FloatArray:
        """States (N, 9)."""
        return np.stack([estimate.mean for estimate in self.estimates])

    @property
    def sigmas(self) -> FloatArray:
        """Standard deviations (N, 9)."""
        variances = [np.diag(estimate.covariance) for estimate in self.estimates]
        return np.sqrt(np.maximum(variances, 0.0))

    @property
    def terrains(self) -> tuple[str, ...]:
        """Terrain in force at each frame."""
        return tuple(estimate.terrain for estimate in self.estimates)

    @property
    def jumps(self) -> BoolArray:
        """Where a jump of the ICRs was detected (N,)."""
        return np.array([estimate.jumped for estimate in self.estimates])

    @property
    def events(self) -> tuple[FilterEvent, ...]:
        """What the filter noticed, in order of time."""
        return tuple(event for estimate in self.estimates for event in estimate.events)

    def trajectory(self) -> Trajectory:
        """The filter's poses, corrected by measurements."""
        return Trajectory(self.stamps_s, self.means[:, :3])

    @property
    def tread_speeds_m_s(self) -> FloatArray:
        """Measured tread speeds (N, 2) in force from each stamp on; NaN where not known."""
        return np.stack([estimate.tread_speeds_m_s for estimate in self.estimates])

    @property
    def yaw_rates_rad_s(self) -> FloatArray:
        """Yaw rates (N - 1,) of the gyroscope from each stamp to the next; NaN without samples."""
        return np.array([estimate.yaw_rate_rad_s for estimate in self.estimates[1:]])

    @property
    def has_gyroscope(self) -> bool:
        """Whether a gyroscope measured a yaw rate anywhere."""
        return bool(np.isfinite(self.yaw_rates_rad_s).any())

    @property
    def used_gyroscope(self) -> bool:
        """Whether a gyroscope turned the robot anywhere: settings may turn it off in the filter."""
        return any(math.isfinite(each.believed_yaw_rate_rad_s) for each in self.estimates)

    def open_loop(self, track_width: float) -> dict[str, Trajectory]:
        """All trajectories that no pose corrects, the simplest first.

        `differential_drive` and `odometer`; where there is a gyroscope, also `gyroscope`, and
        where the filter used it, `odometer_without_gyroscope`.
        """
        found = {"differential_drive": self.differential_drive(track_width)}
        if self.has_gyroscope:
            found["gyroscope"] = self.gyroscope(track_width)
        if self.used_gyroscope:
            found["odometer_without_gyroscope"] = self.odometer_without_gyroscope()
        return found | {"odometer": self.odometer()}

    def odometer(self) -> Trajectory:
        """The model integrated open loop with what was held at each moment, never corrected.

        Where the gyroscope measures the yaw rate, the robot is turned by it, less the bias held.
        The effects of the parameter set are part of the model.
        """
        return self._reckon(self.odometer_twists())

    def odometer_twists(self) -> FloatArray:
        """Body twists (N, 3) of the odometer, each to the next stamp; the last by its treads."""
        twists = self._turned_by_treads()
        by_gyroscope = self._turned_by_gyroscope()
        told = np.isfinite(by_gyroscope).all(axis=1)
        twists[:-1][told] = by_gyroscope[told]
        return twists

    def odometer_without_gyroscope(self) -> Trajectory:
        """The same, the robot turned by its treads throughout."""
        return self._reckon(self._turned_by_treads())

    def gyroscope(self, track_width: float) -> Trajectory:
        """Mean wheel speed along the heading of the gyroscope as recorded: nothing is fitted.

        Where the gyroscope has no samples, the ideal differential drive turns.
        """
        twists = icr_twist(ideal_icrs(track_width), np.nan_to_num(self.tread_speeds_m_s))
        told = np.isfinite(self.yaw_rates_rad_s)
        twists[:-1, 2][told] = self.yaw_rates_rad_s[told]
        return self._reckon(twists)

    def differential_drive(self, track_width: float) -> Trajectory:
        """The same integration with an ideal differential drive."""
        return self._reckon(
            icr_twist(ideal_icrs(track_width), np.nan_to_num(self.tread_speeds_m_s))
        )

    def _turned_by_treads(self) -> FloatArray:
        """`Estimate.twist` (N, 3) of all estimates."""
        means = self.means
        speeds = self.tread_speeds_m_s
        added_speeds = np.stack([estimate.added_speeds_m_s for estimate in self.estimates])
        added_twists = np.stack([estimate.added_twist for estimate in self.estimates])
        effective = means[:, ALPHAS] * (speeds + added_speeds)
        twists = icr_twist(means[:, ICRS], effective) + added_twists
        twists[~np.isfinite(speeds).all(axis=1)] = 0.0
        return np.asarray(twists)

    def _turned_by_gyroscope(self) -> FloatArray:
        """Twists (N - 1, 3) whose omega is measured; NaN where it or the treads are not known."""
        held = self.estimates[:-1]
        added = np.stack([estimate.added_twist for estimate in held])
        effective = np.stack([estimate.effective_speeds_m_s for estimate in held])
        y_left, y_right, x_icr = self.means[:-1, 3:6].T
        bias = self.means[:-1, GYRO_BIAS]
        believed = np.array([estimate.believed_yaw_rate_rad_s for estimate in self.estimates[1:]])
        omega = believed - bias - added[:, 2]
        # v_x = alpha v + y omega of either tread (Baril 2020 eq. 4 to 6), the mean of both
        v_x = effective.mean(axis=1) + (y_left + y_right) / 2 * omega
        return np.asarray(added + np.column_stack([v_x, -x_icr * omega, omega]))

    def _reckon(self, twists: FloatArray) -> Trajectory:
        return dead_reckon(self.stamps_s, twists, self.means[0, :3])


def ideal_icrs(track_width: float) -> FloatArray:
    """ICRs (3,) of treads that do not slip."""
    return np.array([track_width / 2, -track_width / 2, 0.0])
