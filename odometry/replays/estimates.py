"""Estimates at every frame of a run, and the trajectories that follow from them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.blocks import blocks_of
from odometry.dead_reckoning import dead_reckon
from odometry.estimation.estimate import ALPHAS, ICRS, Estimate
from odometry.estimation.filter_event import FilterEvent
from odometry.estimation.kept_estimates import EVERY, KeptEstimates
from odometry.estimation.transition import GYRO_BIAS, STATES
from odometry.models.icr import icr_twist
from odometry.trajectory import Trajectory

MOST = 0.9  # of the time: where less was measured, a path by it would be that of the treads


@dataclass(frozen=True)
class Replay:
    """Estimates at every frame of a run, as they were when the frame came in.

    Attributes
    ----------
    estimates : sequence of Estimate
        Those of `replay` lie on disk, see `KeptEstimates`.

    Examples
    --------
    >>> import odometry
    >>> run = odometry.Run.read(odometry.shipped_data() / "runs" / "demo")
    >>> gravel = odometry.ConstantTerrain("gravel")
    >>> filtered = odometry.replay(run, odometry.IcrEkf(track_width=0.4), gravel)
    >>> filtered.means.shape, len(filtered.trajectory())
    ((1085, 9), 1085)
    """

    estimates: Sequence[Estimate]

    @cached_property
    def _kept(self) -> KeptEstimates:
        known = self.estimates
        return known if isinstance(known, KeptEstimates) else KeptEstimates(known)

    @property
    def stamps_s(self) -> FloatArray:
        """Stamps (N,)."""
        return self.numbers("stamp_s")

    @property
    def means(self) -> FloatArray:
        """States (N, 9)."""
        return self.numbers("mean")

    @property
    def sigmas(self) -> FloatArray:
        """Standard deviations (N, 9)."""
        return self.sigmas_of(slice(0, STATES))

    def numbers(self, name: str, rows: slice = EVERY, columns: slice = EVERY) -> FloatArray:
        """Numbers of all estimates or some rows of them, see `KeptEstimates`."""
        return self._kept.numbers(name, rows, columns)

    def sigmas_of(self, states: slice, rows: slice = EVERY) -> FloatArray:
        """Standard deviations (N, states) of some states and rows."""
        return np.sqrt(np.maximum(self.numbers("variances", rows, states), 0.0))

    @property
    def pose_covariances(self) -> FloatArray:
        """Covariances (N, 3, 3) of x, y and yaw."""
        return self.pose_covariances_of(EVERY)

    def pose_covariances_of(self, rows: slice) -> FloatArray:
        """The same of some rows."""
        found = self.numbers("covariance", rows, slice(0, 3 * STATES))
        return found.reshape(-1, 3, STATES)[:, :, :3]

    @property
    def terrains(self) -> tuple[str, ...]:
        """Terrain in force at each frame."""
        stretches = self._kept.lasting("terrain")
        return tuple(name for rows, name in stretches for _ in rows)

    @property
    def jumps(self) -> BoolArray:
        """Where a jump of the ICRs was detected (N,)."""
        return np.equal(self.numbers("jumped"), 1.0)

    @property
    def events(self) -> tuple[FilterEvent, ...]:
        """What the filter noticed, in order of time."""
        return tuple(event for _, events in self._kept.lasting("events") for event in events)

    @property
    def accepted(self) -> BoolArray:
        """Where a measured pose passed the gate (N,)."""
        return np.equal(self.numbers("accepted"), 1.0)

    @property
    def innovations_squared(self) -> FloatArray:
        """Normalised innovations squared (N,); NaN where no pose was measured."""
        return self.numbers("normalised_squared")

    @property
    def is_astride(self) -> BoolArray:
        """Where the robot was astride an edge of terrains (N,)."""
        return np.concatenate(
            [np.full(len(rows), of is not None) for rows, of in self._kept.lasting("crossing")]
        )

    def trajectory(self) -> Trajectory:
        """The filter's poses, corrected by measurements."""
        return Trajectory(self.stamps_s, self.numbers("mean", columns=slice(0, 3)))

    @property
    def tread_speeds_m_s(self) -> FloatArray:
        """Measured tread speeds (N, 2) in force from each stamp on; NaN where not known."""
        return self.numbers("tread_speeds_m_s")

    @property
    def added_speeds_m_s(self) -> FloatArray:
        """What effects add to these speeds (N, 2)."""
        return self.numbers("added_speeds_m_s")

    @property
    def yaw_rates_rad_s(self) -> FloatArray:
        """Yaw rates (N - 1,) of the gyroscope from each stamp to the next; NaN without samples."""
        return self.numbers("yaw_rate_rad_s")[1:]

    @property
    def believed_yaw_rates_rad_s(self) -> FloatArray:
        """Yaw rates (N - 1,) that turned the robot, bias included; NaN where the treads did."""
        return self.numbers("believed_yaw_rate_rad_s")[1:]

    @property
    def has_gyroscope(self) -> bool:
        """Whether a gyroscope measured a yaw rate anywhere."""
        return bool(np.isfinite(self.yaw_rates_rad_s).any())

    @property
    def gyroscope_share(self) -> float:
        """Share of the time in which a gyroscope measured a yaw rate; 0 of a single estimate."""
        lasts_s = np.diff(self.stamps_s)
        measured_s = np.sum(lasts_s[np.isfinite(self.yaw_rates_rad_s)])
        return float(measured_s / np.sum(lasts_s)) if len(lasts_s) else 0.0

    @property
    def used_gyroscope(self) -> bool:
        """Whether a gyroscope turned the robot anywhere: settings may turn it off in the filter."""
        return bool(np.isfinite(self.numbers("believed_yaw_rate_rad_s")).any())

    def open_loop(self, track_width: float) -> dict[str, Trajectory]:
        """All trajectories that no pose corrects, the simplest first.

        `differential_drive` and `odometer`; where a gyroscope measured for MOST of the time, also
        `gyroscope`, and where the filter used one, `odometer_without_gyroscope`.
        """
        return {name: reckon() for name, reckon in self.open_loop_by_name(track_width).items()}

    def open_loop_by_name(self, track_width: float) -> dict[str, Callable[[], Trajectory]]:
        """What computes each of them: all of a long run's do not fit in memory."""
        found: dict[str, Callable[[], Trajectory]]
        found = {"differential_drive": partial(self.differential_drive, track_width)}
        if self.gyroscope_share >= MOST:
            found["gyroscope"] = partial(self.gyroscope, track_width)
        if self.used_gyroscope:
            found["odometer_without_gyroscope"] = self.odometer_without_gyroscope
        return found | {"odometer": self.odometer}

    def odometer(self) -> Trajectory:
        """The model integrated open loop with what was held at each moment, never corrected.

        Where the gyroscope measures the yaw rate, the robot is turned by it, less the bias held.
        The effects of the parameter set are part of the model.
        """
        return self._reckon(self.odometer_twists())

    def odometer_twists(self) -> FloatArray:
        """Body twists (N, 3) of the odometer, each to the next stamp; the last by its treads."""
        return self._twists(self._turned_by_gyroscope)

    def odometer_without_gyroscope(self) -> Trajectory:
        """The same, the robot turned by its treads throughout."""
        return self._reckon(self._twists(self._turned_by_treads))

    def gyroscope(self, track_width: float) -> Trajectory:
        """Mean wheel speed along the heading of the gyroscope as recorded: nothing is fitted.

        Where the gyroscope has no samples, the ideal differential drive turns.
        """
        twists = self._twists(partial(self._ideal, track_width))
        measured = np.isfinite(self.yaw_rates_rad_s)
        twists[:-1, 2][measured] = self.yaw_rates_rad_s[measured]
        return self._reckon(twists)

    def differential_drive(self, track_width: float) -> Trajectory:
        """The same integration with an ideal differential drive."""
        return self._reckon(self._twists(partial(self._ideal, track_width)))

    def _twists(self, of: Callable[[slice], FloatArray]) -> FloatArray:
        """Twists (N, 3) by what gives those of some rows."""
        twists = np.empty((len(self.estimates), 3))
        for rows in blocks_of(len(twists)):
            twists[rows] = of(rows)
        return twists

    def _ideal(self, track_width: float, rows: slice) -> FloatArray:
        speeds = np.nan_to_num(self.numbers("tread_speeds_m_s", rows))
        return icr_twist(ideal_icrs(track_width), speeds)

    def _turned_by_treads(self, rows: slice) -> FloatArray:
        """`Estimate.twist` (k, 3) of some estimates."""
        means = self.numbers("mean", rows)
        speeds = self.numbers("tread_speeds_m_s", rows)
        added_speeds = self.numbers("added_speeds_m_s", rows)
        effective = means[:, ALPHAS] * (speeds + added_speeds)
        twists = icr_twist(means[:, ICRS], effective) + self.numbers("added_twist", rows)
        twists[~np.isfinite(speeds).all(axis=1)] = 0.0
        return np.asarray(twists)

    def _turned_by_gyroscope(self, rows: slice) -> FloatArray:
        """The same, omega as measured where it and the treads are known."""
        twists = self._turned_by_treads(rows)
        believed = self.numbers("believed_yaw_rate_rad_s", slice(rows.start + 1, rows.stop + 1))
        rows = slice(rows.start, rows.start + len(believed))  # nothing is estimated after the last
        means, added = self.numbers("mean", rows), self.numbers("added_twist", rows)
        speeds = self.numbers("tread_speeds_m_s", rows)
        effective = means[:, ALPHAS] * (speeds + self.numbers("added_speeds_m_s", rows))
        y_left, y_right, x_icr = means[:, ICRS].T
        omega = believed - means[:, GYRO_BIAS] - added[:, 2]
        # v_x = alpha v + y omega of either tread (Baril 2020 eq. 4 to 6), the mean of both
        v_x = effective.mean(axis=1) + (y_left + y_right) / 2 * omega
        by_gyroscope = added + np.column_stack([v_x, -x_icr * omega, omega])
        measured = np.isfinite(by_gyroscope).all(axis=1)
        twists[: len(measured)][measured] = by_gyroscope[measured]
        return twists

    def _reckon(self, twists: FloatArray) -> Trajectory:
        return dead_reckon(self.stamps_s, twists, self.estimates[0].mean[:3])


def ideal_icrs(track_width: float) -> FloatArray:
    """ICRs (3,) of treads that do not slip."""
    return np.array([track_width / 2, -track_width / 2, 0.0])
