"""What a recording holds, cleaned: speeds, yaw rates and poses, and the motion between stamps."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from odometry.arrays import BoolArray, FloatArray
from odometry.checks.evidence.motion import Integrals, Motion, integrals, motion_between
from odometry.checks.evidence.scatter import scattered
from odometry.checks.statistics.measured_between import gaps_between
from odometry.checks.statistics.outliers import excursions, pose_outliers, without_spikes
from odometry.recording.run import Run
from odometry.windows.recorded.gaps import odometry_gaps
from odometry.windows.recorded.in_motion import moving_samples
from odometry.windows.recorded.spans import touched

LONGER_S = (1.0, 2.0)  # windows
EMPTY = 1.5  # usual periods, from which cells between two yaw rates are empty
MOST_OUTLIERS = 0.3  # share of the poses: where more are far from the others, none can be left out


@dataclass(frozen=True)
class CleanedRecording:
    """A run, cleaned. Each property is computed once, at first use.

    Attributes
    ----------
    run : Run
    left_out_s : tuple of (float, float)
        Run time [s]: windows that touch these are left out.
    answers : dict
        What `once` keeps, by the function that found it.
    """

    run: Run
    left_out_s: tuple[tuple[float, float], ...] = ()
    answers: dict[Callable[..., object], object] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @cached_property
    def stamps_s(self) -> FloatArray:
        """Stamps (N,) of odometry.csv."""
        return self.run.odometry.stamps_s

    @cached_property
    def period_s(self) -> float:
        """Usual period of odometry.csv."""
        return float(np.median(np.diff(self.stamps_s))) if len(self.stamps_s) > 1 else 0.0

    @cached_property
    def duration_s(self) -> float:
        """Time from the first to the last row of odometry.csv."""
        return float(self.stamps_s[-1] - self.stamps_s[0])

    @cached_property
    def speeds_m_s(self) -> FloatArray:
        """Tread speeds (N, 2) without spikes."""
        odometry = self.run.odometry
        return np.stack([without_spikes(odometry[n]) for n in ("v_left", "v_right")], axis=-1)

    @cached_property
    def fastest_m_s(self) -> float:
        """Ordinary fastest tread speed: 99 in 100 of those in motion are slower."""
        fastest_m_s = np.abs(self.speeds_m_s).max(axis=1)
        return float(np.quantile(fastest_m_s[moving_samples(fastest_m_s)], 0.99))

    @cached_property
    def yaw_rate(self) -> tuple[FloatArray, FloatArray] | None:
        """Stamps (G,) and yaw rates (G,) of the gyroscope, spikes left out."""
        found = self.run.yaw_rate
        if found is None or len(found.stamps_s) < 2:
            return None
        return found.stamps_s, without_spikes(found.yaw_rate_rad_s)

    @cached_property
    def silent_s(self) -> FloatArray:
        """Stamps (S, 2) between which the gyroscope was not measured while other rows go on.

        Where odometry.csv has no rows either, it may be a log of changes, whose values hold.
        """
        if self.yaw_rate is None:
            return np.empty((0, 2))
        spans_s = gaps_between(self.yaw_rate[0])
        return np.asarray(spans_s[self._rows_between(*spans_s.T)])

    def _rows_between(self, begin_s: FloatArray, end_s: FloatArray) -> BoolArray:
        """Whether rows of odometry.csv lie between two stamps (K,)."""
        before = np.searchsorted(self.stamps_s, begin_s, side="right")
        return np.asarray(np.searchsorted(self.stamps_s, end_s) > before)

    @cached_property
    def gyroscope_file(self) -> str:
        """The file that holds the yaw rate."""
        found = self.run.yaw_rate
        return "odometry.csv" if found is None else found.file

    @cached_property
    def positions_measured(self) -> BoolArray | None:
        """Rows (M,) of pose.csv with x and y; None where fewer than ten have them."""
        if self.run.pose is None:
            return None
        measured = np.isfinite(self.run.pose.stack("x", "y")).all(axis=1)
        return np.asarray(measured) if measured.sum() >= 10 else None

    @cached_property
    def pose_outliers(self) -> BoolArray:
        """Rows (M,) of pose.csv whose position leaves the way and comes back."""
        if self.positions_measured is None or self.run.pose is None:
            return np.zeros(0, dtype=np.bool_)
        found = np.zeros(len(self.positions_measured), dtype=np.bool_)
        rows = np.flatnonzero(self.positions_measured)
        positions = self.run.pose.stack("x", "y")[rows]
        away = excursions(self.run.pose.stamps_s[rows], positions)
        found[rows[pose_outliers(positions) | away]] = True
        return found

    @cached_property
    def position_sigma_m(self) -> float:
        """Noise of positions by second differences of neighbours, which smooth driving lacks."""
        if self.run.pose is None or self.poses_used is None or self.poses_used.sum() < 10:
            return 0.0
        positions = self.run.pose.stack("x", "y")[self.poses_used]
        second = positions[2:] - 2 * positions[1:-1] + positions[:-2]
        return 1.4826 * float(np.median(np.abs(second))) / float(np.sqrt(6.0))

    @cached_property
    def yaw_measured(self) -> bool:
        """Whether most measured positions have a yaw."""
        if self.positions_measured is None or self.run.pose is None:
            return False
        return bool(np.isfinite(self.run.pose["yaw"][self.positions_measured]).mean() > 0.5)

    @cached_property
    def integrals(self) -> Integrals:
        """Tread travel and gyroscope heading; across empty cells a rate does not hold."""
        rate = self.yaw_rate
        if rate is not None:
            stamps_s, rates = rate
            lasts_s = np.diff(stamps_s)
            lack = self._rows_between(stamps_s[:-1], stamps_s[1:])
            lack &= lasts_s > EMPTY * np.median(lasts_s)
            means = (rates[1:] + rates[:-1]) / 2
            rate = stamps_s, np.append(np.where(lack, means, rates[:-1]), rates[-1])
        return integrals(self.run, self.speeds_m_s, rate, self.silent_s)

    @cached_property
    def raw_motion(self) -> Motion:
        """Windows of half a second or more, between new poses where there are any; raw yaw.

        Longer where the noise of the positions is more than what was driven.
        """
        found = motion_between(self.run, self.integrals, self.poses_used)
        for window_s in LONGER_S:
            if not scattered(found, self.run.robot.track_width):
                break
            found = motion_between(self.run, self.integrals, self.poses_used, window_s)
        return self._without_left_out(found)

    @cached_property
    def uniform(self) -> Motion:
        """Windows of half a second over odometry.csv but for its gaps, without poses."""
        found = motion_between(self.run, self.integrals, None)
        lost = touched(odometry_gaps(self.run).spans_s, found.start_s, found.end_s)
        return self._without_left_out(found.rows(np.flatnonzero(~lost)))

    def _without_left_out(self, motion: Motion) -> Motion:
        return motion.rows(np.flatnonzero(~self.left_out(motion.start_s, motion.end_s)))

    def left_out(self, start_s: FloatArray, end_s: FloatArray) -> BoolArray:
        """Whether each time between two stamps (K,) touches what is left out."""
        touched = np.zeros(len(start_s), dtype=np.bool_)
        for begin_s, stop_s in np.array(self.left_out_s).reshape(-1, 2) + self.run.began_s:
            touched |= (end_s >= begin_s) & (start_s <= stop_s)
        return touched

    @cached_property
    def _new_poses(self) -> BoolArray:
        """Rows (M,) of pose.csv that differ from the row before: the others repeat it."""
        if self.run.pose is None:
            return np.zeros(0, dtype=np.bool_)
        values = self.run.pose.stack("x", "y", "yaw")
        same = (np.diff(values, axis=0) == 0) | np.isnan(values[1:])
        return np.concatenate([[True], ~same.all(axis=1)])

    @cached_property
    def poses_used(self) -> BoolArray | None:
        """Rows (M,) of pose.csv that are new and no outliers; None without poses."""
        used = self.positions_measured
        if used is None or self.run.pose is None:
            return None
        if self.pose_outliers.mean() < MOST_OUTLIERS:
            used = used & ~self.pose_outliers
        used = used & self._new_poses
        return used & np.isfinite(self.run.pose["yaw"]) if self.yaw_measured else used

    def travel_m(self, at_s: FloatArray) -> FloatArray:
        """Tread travel (K,) up to each stamp (K,): the faster tread counts."""
        speeds = np.abs(self.speeds_m_s).max(axis=1)
        summed = np.concatenate([[0.0], np.cumsum(speeds[:-1] * np.diff(self.stamps_s))])
        return np.asarray(np.interp(at_s, self.stamps_s, summed))

    def run_time_s(self, stamp_s: float) -> float:
        """Time from the first row of odometry.csv, before any span cut it."""
        return float(stamp_s - self.run.began_s)
