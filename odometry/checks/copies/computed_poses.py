"""Poses that were computed from the treads which they are to judge, and so are no reference."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import minimize_scalar

from odometry.arrays import FloatArray
from odometry.checks.copies.carried_poses import carried_poses
from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.motion import Motion
from odometry.checks.evidence.once import once
from odometry.checks.findings.finding import Finding, Level
from odometry.checks.statistics.relation import Relation, relation

# Shares of the squares explained, at the best delay. Measured poses of 26 real recordings: 0.992
# of the way and 0.995 of the turns at most; of a simulated robot with noise of 1 cm 0.999 of the
# way. Computed ones: 0.9999 and 0.9994, also through a filter of 0.1 s; four digits leave 0.999999.
COPIED_WAY, COPIED_TURN = 0.9998, 0.9993
SAME = 0.003  # factor of the way, less one: no wheel rolls so exactly as its radius says
EXACT_WAY, EXACTLY_SAME = 0.99995, 0.001  # where turns are those of another sensor, a compass
MEASURED_M = 0.001  # median of what is left over half a second: no sensor measures to less
EXACT_TURN = 0.9999  # by the treads alone
LEAST_TURN_RAD = 2.0  # in all
OWN_WIDTH = 0.02  # of a width, less one: it is the track_width of run.toml
NO_WAY = 0.999  # with less, yaw alone is computed: positions are measured
NEARLY = 0.95  # of the way at the stamps as they are; below, no delay is searched for
MOST_DELAY_S = 0.3  # of what a program takes, or of the moment that it integrates from
DELAY_TO_S = 0.0005


def computed_poses(evidence: Evidence) -> Iterator[Finding]:
    """Wheel odometry, or a filter that mixes treads and gyroscope, in place of a reference.

    No robot rolls exactly as far as its treads say. Where poses do, over each half second, and
    turn as these sensors say, they are computed from them. Turns by the track_width of run.toml
    alone are enough. Simulated runs (truth.csv) may move so exactly without noise: of them only
    the latter is said.
    """
    if evidence.run.pose is None:
        return
    at = Copy(evidence, _on_time(evidence))
    track_m, width_m = evidence.run.robot.track_width, at.width_m
    of_track = width_m is not None and abs(track_m / width_m - 1) < OWN_WIDTH
    of_track &= at.way is None or at.way.explained > NO_WAY
    rolls = at.rolls and evidence.run.truth is None
    if not of_track and not rolls:
        yield from carried_poses(evidence)
        return
    seen, source = [], "wheel odometry itself, computed from these treads"
    if rolls and at.way is not None:
        seen.append(
            f"the poses move {at.way.slope:.4f} m for each m of tread travel "
            f"({100 * at.way.explained:.3f} % explained)"
        )
    if width_m is not None:
        seen.append(f"turns of pose.csv are those of the treads over a width of {width_m:.4g} m")
    elif at.turns_copied:
        seen.append("they turn as treads and gyroscope do")
        source = "computed from these treads and the gyroscope (a filter that mixes them)"
    else:
        source = "computed from these treads (wheel odometry, or a filter that mixes them in)"
    yield Finding(
        "poses_are_wheel_odometry",
        Level.WARNING,
        ", and ".join(seen),
        f"pose.csv is {source}: no reference",
        "Use a measured reference (GNSS, SLAM, motion capture): what is identified or compared "
        "with these poses is what their program assumed",
    )


@dataclass(frozen=True)
class Copy:
    """How exactly poses repeat treads and gyroscope over the windows of a motion."""

    evidence: Evidence
    motion: Motion

    @cached_property
    def way(self) -> Relation | None:
        """Of the mean travel of the treads."""
        return _way(self.evidence, self.motion)

    @cached_property
    def width_m(self) -> float | None:
        """The width over which the treads' difference is the turn; None where it is not exact."""
        if not self.evidence.yaw_measured:
            return None
        turn = relation(self.motion.turn_rad, self.motion.difference_m)
        if turn is None or turn.explained < EXACT_TURN or not turn.certain():
            return None
        return 1 / abs(turn.slope)

    @cached_property
    def turns_copied(self) -> bool:
        """Whether turns are those of the gyroscope, of the treads, or any mixture of both."""
        m = self.motion
        if not self.evidence.yaw_measured:
            return False
        columns = [m.left_m, m.right_m, m.lasts_s]
        if np.isfinite(m.gyroscope_rad).any():
            columns.append(m.gyroscope_rad)
        turn = relation(m.turn_rad, *columns)
        return turn is not None and turn.explained > COPIED_TURN

    @cached_property
    def rolls(self) -> bool:
        """Whether the way is that of the treads, through turns: on a straight all is alike."""
        if self.way is None or self._turned_rad < LEAST_TURN_RAD:
            return False
        if np.nanmedian(np.abs(self.way.residuals)) > MEASURED_M:
            return False
        off, explained = abs(self.way.slope - 1), self.way.explained
        if off < EXACTLY_SAME and explained > EXACT_WAY:
            return True
        return off < SAME and explained > COPIED_WAY and self.turns_copied

    @property
    def _turned_rad(self) -> float:
        turns = self.motion.turn_rad
        if not self.evidence.yaw_measured:
            turns = self.evidence.uniform.gyroscope_rad
        return float(np.nansum(np.abs(turns)))


@once
def _on_time(evidence: Evidence) -> Motion:
    """The motion with the treads as much earlier as makes their way most exactly that of the poses.

    A computed pose belongs to the row before or after, or comes later by what its program takes.
    """
    m, of = evidence.motion, evidence.integrals
    way = _way(evidence, m)
    if way is None or way.explained < NEARLY:
        return m

    def earlier(delay_s: float) -> Motion:
        left, right, gyroscope = (
            integral(m.end_s - delay_s) - integral(m.start_s - delay_s)
            for integral in (of.left_m, of.right_m, of.gyroscope_rad)
        )
        return replace(m, left_m=left, right_m=right, gyroscope_rad=gyroscope)

    def not_explained(delay_s: float) -> float:
        found = _way(evidence, earlier(delay_s))
        return 1.0 if found is None else 1 - found.explained

    best = minimize_scalar(
        not_explained,
        bounds=(-MOST_DELAY_S, MOST_DELAY_S),
        method="bounded",
        options={"xatol": DELAY_TO_S},
    )
    return earlier(float(best.x)) if best.fun < 1 - way.explained else m


def _way(evidence: Evidence, m: Motion) -> Relation | None:
    """Measured way along the robot's axis, round its turn, from the mean travel of the treads.

    Half of the turn is between the chord of a circle and its tangent. A base ahead of or behind
    the middle moves sideways of it alone.
    """
    if not evidence.yaw_measured:
        half_rad = np.clip(np.nan_to_num(evidence.turn_rad(m)) / 2, -np.pi / 2, np.pi / 2)
        return relation(_arc_m(m.distance_m, half_rad), np.abs(m.mean_m))
    half_rad = m.turn_rad / 2
    middle_rad = m.yaw_rad[:, 0] + half_rad
    chord_m = m.moved_m[:, 0] * np.cos(middle_rad) + m.moved_m[:, 1] * np.sin(middle_rad)
    return relation(_arc_m(chord_m, half_rad), m.mean_m)


def _arc_m(chord_m: FloatArray, half_rad: FloatArray) -> FloatArray:
    """Arcs (K,) of chords (K,), by half of their turns (K,)."""
    return np.asarray(chord_m / np.sinc(half_rad / np.pi))
