"""A gyroscope that was computed from the treads, or treads from a gyroscope."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.copies.repetition import Repetition, repetition
from odometry.checks.copies.weighted_rows import explained_by_rows, left_by_own_rows
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.recording.run import Run
from odometry.tables.table import Table

# Shares of the squares explained, of the second differences and of the values: 0.01 of the former
# at most in 74 real recordings, 0.02 in simulated ones with ordinary noise. Copies reach 1, through
# a low pass or with digits 0.98.
CHANGES, VALUES = 0.95, 0.999
# Of the second differences, by a weighted sum of rows: at most 0.07 in the same recordings; of
# copies that are averaged or rounded coarsely 0.9 to 1.
BY_ROWS = 0.9
QUIET_RAD_S = 0.0005  # noise of a gyroscope on a stationary robot: none that moves has less
SMOOTH_RAD_S = 0.1 * QUIET_RAD_S  # left by own rows: a simulation without noise
LEAST_TURN_RAD = 2.0  # in all
ONE_MEASURED = 0.95  # share of the measured turns explained by the gyroscope, from which it counts
AS_MEASURED = 0.1  # of the turns: a gyroscope has no larger scale error
EXACT_POSES = 0.9999  # share of the measured turns explained: then nothing here has any noise
ONE_SIDE = 0.01  # of the difference of the treads, that the mean adds: sides of different scale
OWN_WIDTH = 0.01  # of a width, less one: it is the track_width of run.toml
LEAST_DELAY_S = 0.01
SIMULATED = "; or the drive was simulated without noise"
CAUSES = {  # and remedies
    "gyroscope_is_treads": (
        "gyro_z was computed from the treads (the twist of an odometry topic saved as a "
        "gyroscope): it is no sensor and adds nothing",
        "Save the yaw rate of the IMU itself (sensor_msgs/Imu), or remove the column; until then "
        "the commands leave it out",
    ),
    "treads_are_gyroscope": (
        "v_left and v_right were computed from a speed and the turn rate of the gyroscope (v -+ "
        "w b/2: the twist of a filter or a driver, not wheels): their difference adds nothing",
        "Save the speeds of the wheels themselves (sensor_msgs/JointState): how this robot turns "
        "by its treads (ICRs, slip in turns) cannot be learned from these",
    ),
    "turns_recorded_once": (
        "Either gyro_z was computed from the treads (the twist of an odometry topic saved as a "
        "gyroscope), or v_left and v_right from a speed and the turn rate of the gyroscope (v -+ "
        "w b/2): these cannot be distinguished",
        "Save what the wheels (sensor_msgs/JointState) and the IMU (sensor_msgs/Imu) measure; "
        "until then one of both columns adds nothing, and neither confirms the other",
    ),
}


def copied_turns(evidence: Evidence) -> Iterator[Finding]:
    """Turns that are recorded twice: gyro_z and v_right - v_left go together in each row.

    Which of the two was computed is said where only one of them can be: it is smoother, comes in
    fewer rows, mixes sides of different scale, or turns otherwise than measured poses.
    """
    if evidence.yaw_rate is None:
        return
    turns = CopiedTurns(evidence)
    copied = turns.gyroscope or turns.treads or turns.by_rows > BY_ROWS
    if not copied or turns.without_noise:
        return
    name = "turns_recorded_once"
    if turns.is_no_gyroscope:
        name = "gyroscope_is_treads"
    elif turns.are_no_treads:
        name = "treads_are_gyroscope"
    cause, remedy = CAUSES[name]
    yield Finding(name, Level.WARNING, _seen(evidence, turns), cause + SIMULATED, remedy)


@dataclass(frozen=True)
class CopiedTurns:
    """Whether gyroscope and treads repeat each other.

    Attributes
    ----------
    evidence : Evidence
        With a gyroscope.
    """

    evidence: Evidence

    @cached_property
    def gyroscope(self) -> Repetition | None:
        """The yaw rate by difference and mean of the treads; None where it is not exact."""
        assert self.evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
        left, right = self.evidence.speeds_m_s.T
        sources = np.stack([right - left, (left + right) / 2], axis=-1)
        found = repetition(*self.evidence.yaw_rate, self.evidence.stamps_s, sources)
        return self._exact(found, self.evidence.yaw_rate[1])

    @cached_property
    def treads(self) -> Repetition | None:
        """The difference of the treads by the yaw rate; None where it is not exact."""
        assert self.evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
        stamps_s, rates = self.evidence.yaw_rate
        left, right = self.evidence.speeds_m_s.T
        found = repetition(self.evidence.stamps_s, right - left, stamps_s, rates[:, None])
        return self._exact(found, right - left, 1.0 if found is None else found.coefficients[0])

    @cached_property
    def by_rows(self) -> float:
        """Share of the changes of one that a weighted sum of rows of the other explains.

        0 where what is left is the noise of a gyroscope.
        """
        found = self.evidence.gyroscope_by_difference
        assert self.evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
        if found is None or not found.certain() or self._turned_rad < LEAST_TURN_RAD:
            return 0.0
        left, right = self.evidence.speeds_m_s.T
        treads = (self.evidence.stamps_s, right - left)
        gyroscope = self.evidence.yaw_rate
        ways = (
            (explained_by_rows(*gyroscope, *treads), 1.0),
            (explained_by_rows(*treads, *gyroscope), abs(found.slope)),  # from m/s to rad/s
        )
        return max((by.share for by, rad in ways if rad * by.noise < QUIET_RAD_S), default=0.0)

    @property
    def width_m(self) -> float:
        """Over which the difference of the treads is the turn; negative where it is reversed."""
        if self.gyroscope is not None:
            return float(1 / self.gyroscope.coefficients[0])
        if self.treads is not None:
            return float(self.treads.coefficients[0])
        found = self.evidence.gyroscope_by_difference
        assert found is not None  # noqa: S101 - else nothing is exact
        return 1 / found.slope

    @property
    def _turned_rad(self) -> float:
        return float(np.nansum(np.abs(self.evidence.uniform.gyroscope_rad)))

    @property
    def is_no_gyroscope(self) -> bool:
        """Whether the yaw rate is surely none: other turns, sides of different scale, smoother."""
        if self._measured_turn is not None and abs(self._measured_turn - 1) > AS_MEASURED:
            return True
        if self.gyroscope is None:
            return False
        difference, mean = self.gyroscope.coefficients
        return abs(mean) > ONE_SIDE * abs(difference) or self._alone(self.gyroscope, self.treads)

    @property
    def are_no_treads(self) -> bool:
        """Whether the treads are surely none: smoother than the yaw rate."""
        return self._alone(self.treads, self.gyroscope)

    def _alone(self, found: Repetition | None, other: Repetition | None) -> bool:
        """Whether one direction alone is exact; a held copy at stamps of its own may be inexact."""
        assert self.evidence.yaw_rate is not None  # noqa: S101 - checked by the caller
        if found is None or other is not None:
            return False
        same_rows = np.array_equal(self.evidence.yaw_rate[0], self.evidence.stamps_s)
        return same_rows or found.smoothed_s > LEAST_DELAY_S

    @property
    def without_noise(self) -> bool:
        """Whether the measured turns are as exact: a simulation, in which all is one motion."""
        found = self.evidence.pose_turn_by_gyroscope
        return found is not None and found.explained > EXACT_POSES

    @property
    def _measured_turn(self) -> float | None:
        """Measured turn for each rad by the gyroscope; None where poses do not say it."""
        found = self.evidence.pose_turn_by_gyroscope
        if found is None or not found.certain() or found.explained < ONE_MEASURED:
            return None
        return found.slope

    def _exact(
        self, found: Repetition | None, values: FloatArray, of_rad: float = 1.0
    ) -> Repetition | None:
        """What repeats in values (N,) of so much for each rad; None where they are no copy."""
        if found is None or self._turned_rad < LEAST_TURN_RAD:
            return None
        return found if is_copy(found, values, of_rad) else None


def is_copy(found: Repetition, values: FloatArray, of_rad: float = 1.0) -> bool:
    """Whether values (N,), of so much for each rad/s, are surely those that they repeat.

    What differs must be quieter than a gyroscope, and they must not be smooth.
    """
    if found.of_changes < CHANGES or found.of_values < VALUES:
        return False
    if found.noise > QUIET_RAD_S * abs(of_rad):
        return False
    return left_by_own_rows(values) > SMOOTH_RAD_S * abs(of_rad)


def _seen(evidence: Evidence, turns: CopiedTurns) -> str:
    found = turns.gyroscope or turns.treads
    explained = turns.by_rows if found is None else found.of_changes
    width_m, track_m = turns.width_m, evidence.run.robot.track_width
    own = " (the track_width)" if abs(abs(width_m) / track_m - 1) < OWN_WIDTH else ""
    sign = "-" if width_m < 0 else ""
    words = (
        f"gyro_z of {evidence.gyroscope_file} is {sign}(v_right - v_left) / {abs(width_m):.4g} m"
        f"{own} from row to row: {100 * explained:.2f} % of its changes are explained, and "
        "no gyroscope is so free of noise"
    )
    if found is None:
        return f"{words}; by neighbouring rows (averaged, filtered or republished)"
    if abs(found.delay_s) > LEAST_DELAY_S:
        later = "gyro_z" if (found.delay_s > 0) == (found is turns.gyroscope) else "the treads"
        words += f"; {later} {abs(found.delay_s):.2g} s later"
    if found.smoothed_s > LEAST_DELAY_S:
        words += f"; through a low pass of {found.smoothed_s:.2g} s"
    return words


def without_gyroscope(run: Run) -> Run:
    """The run without the yaw rate that is read."""
    found = run.yaw_rate
    if run.imu is not None and found is not None and found.file == "imu.csv":
        return replace(run, imu=_without(run.imu))
    return replace(run, odometry=_without(run.odometry))


def _without(table: Table) -> Table:
    return replace(table, columns={n: c for n, c in table.columns.items() if n != "gyro_z"})
