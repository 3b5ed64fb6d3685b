"""Runs whose positions were measured without yaw, with the yaw that the positions determine."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from odometry.positions.carrier import carrier_of
from odometry.positions.positions_yaw import yaw_at_positions
from odometry.positions.timing import Timing, timings_of
from odometry.recording.run import Run
from odometry.windows.recorded.measured_poses import YAW_FOUND, lacks_yaw

NOISE_LENGTHS = 28.0  # a window so many times longer than the noise is off by 0.05 m per m for it


@dataclass(frozen=True)
class FoundHeading:
    """A run with found yaws, and how good they are.

    Attributes
    ----------
    run : Run
        pose.csv with a yaw in each row that has x and y within the time of odometry.csv, where
        the positions determine it, and a column YAW_FOUND with its standard deviation [rad]. Its
        positions are as they were.
    position_sigma_m : float
        Of a measured position, as the shapes of stretches show it.
    yaw_sigma_rad : float
        Median of the column. Errors of neighbouring yaws are correlated.
    by_gyroscope : bool
        Whether a gyroscope carried the yaw between positions, and not the treads.
    estimated_share : float
        Share of the positions at which the yaw could be estimated.
    positions_late_s : float
        How late positions are beside treads and gyroscope, which is undone while the yaw is found;
        the stamps of `run` are as they were.
    """

    run: Run
    position_sigma_m: float
    yaw_sigma_rad: float
    by_gyroscope: bool
    estimated_share: float = 1.0
    positions_late_s: float = 0.0

    @property
    def least_horizon_m(self) -> float:
        """Wheel travel over which the noise of positions is a small error per metre."""
        return NOISE_LENGTHS * self.position_sigma_m

    @property
    def words(self) -> str:
        """A sentence for a reader."""
        by = "by the gyroscope" if self.by_gyroscope else "by the treads alone"
        unknown = 1 - self.estimated_share
        except_for = (
            f"; at {100 * unknown:.1f} % of the positions it cannot be estimated" if unknown else ""
        )
        late_s = self.positions_late_s
        when = f"{abs(late_s):.2f} s {'late' if late_s > 0 else 'early'}"
        timing = f"; positions are {when} beside the gyroscope" if late_s else ""
        return (
            f"{self.run.folder}: yaw was not measured; it is found from positions with a noise of "
            f"{self.position_sigma_m:.2g} m, to about {np.degrees(self.yaw_sigma_rad):.2g} "
            f"degrees, and carried from one to the next {by}{except_for}{timing}"
        )


class Headed(NamedTuple):
    """Runs with a yaw, and the headings that were found for those that lacked one."""

    runs: tuple[Run, ...]
    found: tuple[FoundHeading, ...]

    @property
    def notes(self) -> tuple[str, ...]:
        """A sentence for each found heading."""
        return tuple(each.words for each in self.found)

    @property
    def least_horizon_m(self) -> float:
        """The longest of those of the found headings; 0 where none was found."""
        return max((each.least_horizon_m for each in self.found), default=0.0)


def headed(runs: Sequence[Run]) -> Headed:
    """Runs with a yaw: `found_heading` of those that lack one, all of one recorder.

    Raises
    ------
    OdometryError
        See `found_heading`.
    """
    lacking = [i for i, run in enumerate(runs) if needs_heading(run)]
    timings = timings_of([runs[i] for i in lacking])
    found = {i: found_heading(runs[i], timing) for i, timing in zip(lacking, timings, strict=True)}
    with_yaw = tuple(found[i].run if i in found else run for i, run in enumerate(runs))
    return Headed(with_yaw, tuple(found.values()))


def needs_heading(run: Run) -> bool:
    """Whether yaw is lacking and was not found."""
    return lacks_yaw(run) and (run.pose is None or YAW_FOUND not in run.pose)


def found_heading(run: Run, timing: Timing | None = None) -> FoundHeading:
    """Find the yaw of a run from its positions, and their timing where it is not given.

    A model identified on the shapes of stretches (`identification.from_positions`) or the
    gyroscope carries the robot between positions; smoothers put its pose among all of them.

    Raises
    ------
    OdometryError
        If there are too few positions for a model, they contradict the treads, or do not determine
        the yaw (`yaw_at_positions`).
    """
    if timing is None:
        (timing,) = timings_of([run])
    late_s = timing.positions_late_s
    carrier = carrier_of(timing.undone(run))
    found = yaw_at_positions(carrier)
    if run.pose is None:
        return FoundHeading(run, np.nan, np.nan, carrier.by_gyroscope)
    rows = np.searchsorted(run.pose.stamps_s - late_s, carrier.record.pose_s)
    yaw, sigma = np.full((2, len(run.pose)), np.nan)
    yaw[rows], sigma[rows] = found.yaw_rad, found.sigma_rad
    columns = {**run.pose.columns, "yaw": yaw, YAW_FOUND: sigma}
    return FoundHeading(
        replace(run, pose=replace(run.pose, columns=columns)),
        float(np.sqrt(carrier.position_variance_m2)),
        float(np.nanmedian(found.sigma_rad)),
        carrier.by_gyroscope,
        found.share,
        late_s,
    )
