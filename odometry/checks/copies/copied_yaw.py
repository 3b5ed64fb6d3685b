"""Yaw that was computed from gyroscope or treads, and a gyroscope computed from yaw."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.copies.computed_poses import COPIED_WAY, Copy
from odometry.checks.copies.copied_turns import (
    LEAST_TURN_RAD,
    SIMULATED,
    is_copy,
    without_gyroscope,
)
from odometry.checks.copies.repetition import Repetition, repetition
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.findings.finding import Finding, Level
from odometry.recording.run import Run

LEAST_POSES = 100
MORE_ROWS = 1.5


def copied_yaw(evidence: Evidence) -> Iterator[Finding]:
    """A yaw that repeats the gyroscope or the treads from row to row, beside measured positions.

    Yaw that integrates a gyroscope may be meant so, where a receiver measures no heading: a note.
    """
    if not evidence.yaw_measured or evidence.run.pose is None:
        return
    yaw = CopiedYaw(evidence)
    if len(yaw.stamps_s) < LEAST_POSES or yaw.turned_rad < LEAST_TURN_RAD:
        return
    by_gyroscope, gyroscope = yaw.by_gyroscope, yaw.gyroscope
    if yaw.by_treads is not None:
        if by_gyroscope is None and gyroscope is None and yaw.positions_measured:
            yield _is_treads(yaw.by_treads)
    elif gyroscope is not None and (by_gyroscope is None or yaw.in_fewer_rows):
        yield _gyroscope_is_yaw(evidence, gyroscope)
    elif by_gyroscope is not None:
        yield _is_gyroscope(evidence, by_gyroscope, either=gyroscope is not None)


@dataclass(frozen=True)
class CopiedYaw:
    """How exactly turn rates of measured yaw, of the gyroscope and of the treads repeat another.

    Attributes
    ----------
    evidence : Evidence
        With yaw.
    """

    evidence: Evidence

    @cached_property
    def _known(self) -> tuple[FloatArray, FloatArray]:
        """Stamps (M,) and headings (M,) of rows with a yaw."""
        pose = self.evidence.run.pose
        assert pose is not None  # noqa: S101 - checked by the caller
        yaw = np.radians(pose["yaw"]) if self.evidence.yaw_in_degrees else pose["yaw"]
        known = np.isfinite(yaw)
        return pose.stamps_s[known], np.unwrap(yaw[known])

    @property
    def stamps_s(self) -> FloatArray:
        """Stamps (M,) of rows with a yaw."""
        return self._known[0]

    @cached_property
    def rates(self) -> FloatArray:
        """Turn rate (M - 1,) from each row to the next."""
        stamps_s, yaw = self._known
        return np.asarray(np.diff(yaw) / np.diff(stamps_s))

    @property
    def turned_rad(self) -> float:
        """Sum of the measured turns."""
        return float(np.nansum(np.abs(self.evidence.motion.turn_rad)))

    @cached_property
    def by_gyroscope(self) -> Repetition | None:
        """Turns of yaw by the yaw rate; None where they are not exact."""
        if self.evidence.yaw_rate is None:
            return None
        stamps_s, rates = self.evidence.yaw_rate
        found = repetition(self.stamps_s[:-1], self.rates, stamps_s, rates[:, None])
        return _exact(found, self.rates)

    @cached_property
    def gyroscope(self) -> Repetition | None:
        """The yaw rate by that of yaw, forwards or about each row; None where it is not exact."""
        measured = self.evidence.yaw_rate
        if measured is None:
            return None
        stamps_s, yaw = self._known
        ways = ((stamps_s[:-1], self.rates), (stamps_s, np.gradient(yaw, stamps_s)))
        found = [_exact(repetition(*measured, s, r[:, None]), measured[1]) for s, r in ways]
        exact = [one for one in found if one is not None]
        return max(exact, key=lambda one: one.of_changes, default=None)

    @cached_property
    def by_treads(self) -> Repetition | None:
        """Turns of yaw by the difference of the treads; None where they are not exact."""
        left, right = self.evidence.speeds_m_s.T
        difference = (right - left)[:, None]
        found = repetition(self.stamps_s[:-1], self.rates, self.evidence.stamps_s, difference)
        return _exact(found, self.rates)

    @property
    def in_fewer_rows(self) -> bool:
        """Whether yaw has so few rows that a gyroscope would hold more than they say."""
        rate = self.evidence.yaw_rate
        return rate is not None and len(rate[0]) > MORE_ROWS * len(self.stamps_s)

    @property
    def positions_measured(self) -> bool:
        """Whether positions are less exact than computed or simulated ones."""
        way = Copy(self.evidence, self.evidence.motion).way
        return way is None or way.explained < COPIED_WAY


def _exact(found: Repetition | None, rates: FloatArray) -> Repetition | None:
    return found if found is not None and is_copy(found, rates) else None


def _share(found: Repetition) -> str:
    later = f", {found.delay_s:+.2g} s later" if abs(found.delay_s) > 0.01 else ""
    return f"{100 * found.of_changes:.2f} % of the changes from row to row are explained{later}"


def _is_treads(found: Repetition) -> Finding:
    return Finding(
        "yaw_is_treads",
        Level.WARNING,
        f"yaw of pose.csv turns by (v_right - v_left) / {1 / found.coefficients[0]:.4g} m "
        f"({_share(found)}); its positions do not come from the treads",
        f"Yaw was computed from these treads (wheel odometry): no measured heading{SIMULATED}",
        "Leave yaw empty, or record a measured one: positions and a gyroscope suffice",
        mend=without_yaw,
    )


def _is_gyroscope(evidence: Evidence, found: Repetition, *, either: bool) -> Finding:
    cause = (
        "Yaw integrates the gyroscope (an own heading of the IMU, or of a receiver without one): "
        "its drift is the gyroscope's, and neither confirms the other"
    )
    if either:
        cause += (
            "; or gyro_z is the derivative of measured yaw, and no sensor: these cannot be "
            "distinguished"
        )
    return Finding(
        "yaw_is_gyroscope",
        Level.NOTE,
        f"yaw of pose.csv turns by {found.coefficients[0]:.4g} times gyro_z of "
        f"{evidence.gyroscope_file} ({_share(found)})",
        cause + SIMULATED,
        "Where yaw was not measured, leave it empty: it is found from positions and gyroscope",
        mend=without_yaw,
    )


def _gyroscope_is_yaw(evidence: Evidence, found: Repetition) -> Finding:
    return Finding(
        "gyroscope_is_yaw",
        Level.WARNING,
        f"gyro_z of {evidence.gyroscope_file} is {found.coefficients[0]:.4g} times the turn rate "
        f"of yaw in pose.csv ({_share(found)})",
        f"gyro_z was computed from yaw (its derivative): it is no sensor and adds nothing"
        f"{SIMULATED}",
        "Save the yaw rate of the IMU itself (sensor_msgs/Imu), or remove the column; until then "
        "the commands leave it out",
        mend=without_gyroscope,
    )


def without_yaw(run: Run) -> Run:
    """The run with positions alone."""
    assert run.pose is not None  # noqa: S101 - the cause is one of poses
    empty = np.full(len(run.pose), np.nan)
    return replace(run, pose=replace(run.pose, columns={**run.pose.columns, "yaw": empty}))
