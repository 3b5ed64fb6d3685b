"""What a recording says of itself: the same motion as treads, gyroscope and poses have it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.cleaned_recording import CleanedRecording
from odometry.checks.evidence.course_turns import course_turns
from odometry.checks.evidence.heading import (
    CONSISTENT,
    Heading,
    across_m,
    along_m,
    headings,
    turns_in_radians,
)
from odometry.checks.evidence.motion import Motion, motion_between
from odometry.checks.evidence.scatter import scattered
from odometry.checks.evidence.way_direction import way_direction_rad, yaw_by_gyroscope
from odometry.checks.statistics.relation import Relation, relation

MOST_SHARP = 0.8  # share of the windows in sharp turns, from which these are used as well
COURSE_WINDOWS_S = (1.0, 2.0, 4.0)
MOST_TURN_RAD = 2.5  # between two poses, from which whole turns may be lost
DEGREES_RAD_S = 7.0  # no robot turns faster: the gyroscope is in degrees per second
UNRELATED = 0.3  # correlation below which turns have nothing in common
SOME_TURN = 0.2  # rad, or m of difference of the treads, in half a second
ELSEWHERE_RAD = np.pi / 4  # from the way to the yaw: no robot slides so much to one side
CLEARLY = 0.3  # difference of concentrations or squared correlations that decides


@dataclass(frozen=True)
class Evidence(CleanedRecording):
    """A run, and relations between its sensors. Each property is computed once, at first use."""

    @cached_property
    def yaw_in_degrees(self) -> bool:
        """Whether the column yaw holds degrees: its course, or its turns, fit only then."""
        if not self.yaw_measured:
            return False
        raw, read = self.raw_motion, self.raw_motion.with_yaw(np.radians)
        if turns_in_radians(raw, self.turn_rad(raw), self.run.robot.track_width):
            return False
        readings = headings(raw, self.turn_rad(read))
        plain, degrees = (
            max((readings[n].concentration for n in names if n in readings), default=0.0)
            for names in (("radians", "radians, reversed"), ("degrees", "degrees, reversed"))
        )
        turns = raw.gyroscope_rad if self.yaw_rate is not None else raw.difference_m
        as_radians, as_degrees = (relation(m.turn_rad, turns) for m in (raw, read))
        if max(plain, degrees) >= CONSISTENT and abs(plain - degrees) > CLEARLY:
            contrary = as_degrees is not None and as_degrees.correlation < UNRELATED
            return degrees > plain and not (contrary and np.nanmax(np.abs(turns)) > SOME_TURN)
        if as_radians is None or as_degrees is None:
            return False
        return as_degrees.correlation**2 > as_radians.correlation**2 + CLEARLY

    @cached_property
    def motion(self) -> Motion:
        """Windows of half a second or more, between poses where there are any; yaw in radians.

        The poses are those of the robot's origin, where `[sensors]` states their place.
        """
        return self.of_origin(self.raw_motion)

    def of_origin(self, raw: Motion) -> Motion:
        """Raw windows (K) with yaw in radians, and moved as the robot's origin was."""
        read = raw.with_yaw(np.radians) if self.yaw_in_degrees else raw
        if self.run.sensors.pose_m is None:
            return read
        yaw = self._turned_yaw(read) if self.yaw_measured else self.gyroscope_yaw(read)
        return read.of_point(yaw, np.array(self.run.sensors.pose_m[:2]))

    def _turned_yaw(self, read: Motion) -> FloatArray:
        """Measured yaw (K, 2) of windows; with the way where it points elsewhere, as backwards.

        Not where the treads turn the other way than the yaw: their signs turn the way round, too.
        """
        axis_rad = way_direction_rad(read, read.yaw_rad, self.turn_rad(read))
        by_treads = relation(read.turn_rad, read.difference_m)
        agrees = by_treads is not None and by_treads.slope > 0
        elsewhere = agrees and abs(axis_rad) > ELSEWHERE_RAD
        return read.yaw_rad + axis_rad if elsewhere else read.yaw_rad

    def gyroscope_yaw(self, motion: Motion) -> FloatArray:
        """Heading (K, 2) of windows of positions by the gyroscope, NaN where it is not known."""
        fastest = self._fastest_yaw_rate
        if fastest is None or fastest > DEGREES_RAD_S:
            return np.full((len(motion), 2), np.nan)
        return yaw_by_gyroscope(motion, self.integrals)

    @cached_property
    def heading(self) -> Heading | None:
        """Relation of yaw and course; None where they do not agree, or it cannot be determined."""
        found = headings(self.motion, self.turn_rad(self.motion))
        if not found:
            return None
        plain, reversed_ = found["radians"], found["radians, reversed"]
        best = plain  # also where the robot drove to and fro along one line, and both readings fit
        if reversed_.concentration > plain.concentration + CLEARLY:
            best = reversed_
        return best if best.concentration >= CONSISTENT else None

    @cached_property
    def best_concentration(self) -> float | None:
        """Agreement of course and yaw by the best reading of yaw; None with too few windows."""
        found = headings(self.motion, self.turn_rad(self.motion)).values()
        return max((heading.concentration for heading in found), default=None)

    @cached_property
    def forward_m(self) -> FloatArray:
        """Measured displacement (K,) along the robot's axis, NaN where heading is not known.

        The axis is that of the course, so that a yaw off by 90 degrees does not matter; its sign
        is that of the yaw.
        """
        if self.heading is None:
            return np.full(len(self.motion), np.nan)
        return along_m(self.motion, self.heading)

    def turn_rad(self, motion: Motion) -> FloatArray:
        """Turn (K,) in rad, by the gyroscope where there is one in rad/s or degrees per second."""
        fastest = self._fastest_yaw_rate
        if fastest is None or fastest > np.degrees(DEGREES_RAD_S):
            return motion.turn_rad  # no gyroscope, or neither: counts
        turn = motion.gyroscope_rad
        return np.asarray(np.radians(turn)) if fastest > DEGREES_RAD_S else turn

    @cached_property
    def _fastest_yaw_rate(self) -> float | None:
        """Ordinary fastest yaw rate in the unit of the gyroscope: 99 in 100 are slower."""
        if self.yaw_rate is None:
            return None
        return float(np.nanquantile(np.abs(self.yaw_rate[1]), 0.99))

    @cached_property
    def sideways_m(self) -> FloatArray:
        """Measured displacement (K,) to the left of the robot's axis, NaN where not known."""
        if self.heading is None:
            return np.full(len(self.motion), np.nan)
        return across_m(self.motion, self.heading)

    @cached_property
    def forward_by_treads(self) -> Relation | None:
        """Measured forward displacement from the travel of the left and of the right tread."""
        m = self.motion
        return relation(self.forward_m, m.left_m, m.right_m)

    @cached_property
    def forward_by_mean(self) -> Relation | None:
        """Measured forward displacement from the mean travel of the treads."""
        return relation(self.forward_m, self.motion.mean_m)

    @cached_property
    def distance_by_mean(self) -> Relation | None:
        """Distance between positions from the mean travel, both without sign, for lack of yaw."""
        m = self.motion
        if len(m) == 0 or scattered(m, self.run.robot.track_width):
            return None
        sharp = np.abs(m.difference_m) / np.maximum(np.abs(m.mean_m), 1e-12)
        some = np.mean(sharp > 1.0) < MOST_SHARP or np.mean(sharp > 2.0) > 1 - MOST_SHARP
        turning = sharp > (1.0 if some else 2.0)
        return relation(np.where(turning, np.nan, m.distance_m), np.abs(m.mean_m))

    @cached_property
    def metres_per_metre(self) -> float | None:
        """Measured distance per mean tread travel, without sign; None where it is not known."""
        for found in (self.forward_by_mean, self.distance_by_mean):
            if found is not None and found.certain():
                return abs(found.slope)
        return None

    @cached_property
    def arm_share(self) -> float:
        """By what share an antenna at the robot's edge is faster than its centre all the time.

        Where the robot turns to both sides it is nothing.
        """
        m = self.motion
        turned = np.nansum(self.turn_rad(m) * np.sign(m.mean_m))
        arm_m = max(self.run.robot.length or 0.0, self.run.robot.track_width) / 2
        travel_m = float(np.sum(np.abs(m.mean_m)))
        return min(arm_m * abs(float(turned)) / travel_m, 1.0) if travel_m > 0 else 0.0

    @cached_property
    def gyroscope_by_treads(self) -> Relation | None:
        """Turn by the gyroscope from the travel of the left and of the right tread."""
        m = self.uniform
        return relation(m.gyroscope_rad, m.left_m, m.right_m)

    @cached_property
    def gyroscope_by_difference(self) -> Relation | None:
        """Turn by the gyroscope from the difference of the treads' travel: one over a width."""
        m = self.uniform
        return relation(m.gyroscope_rad, m.difference_m, m.lasts_s)

    @cached_property
    def _course_turns(self) -> tuple[Motion, FloatArray]:
        """Over longer windows where noise prevails in shorter ones."""
        width_m = self.run.robot.track_width
        found = course_turns(self.motion, self.integrals, width_m)
        for window_s in COURSE_WINDOWS_S:
            if np.isfinite(found[1]).any():
                break
            longer = self.of_origin(
                motion_between(self.run, self.integrals, self.poses_used, window_s)
            )
            found = course_turns(self._without_left_out(longer), self.integrals, width_m)
        return found

    @cached_property
    def turn_motion(self) -> Motion:
        """Windows (K) of the measured turns: of yaw, else of the course of positions."""
        return self.motion if self.yaw_measured else self._course_turns[0]

    @cached_property
    def pose_turn_rad(self) -> FloatArray:
        """Measured turn (K,), NaN where the robot may have turned by more than half a turn."""
        if not self.yaw_measured:
            return self._course_turns[1]
        by_gyroscope = self.turn_rad(self.motion)
        sure = ~(np.abs(by_gyroscope) > MOST_TURN_RAD)
        return np.asarray(np.where(sure, self.motion.turn_rad, np.nan))

    @cached_property
    def pose_turn_by_treads(self) -> Relation | None:
        """Measured turn from the travel of the left and of the right tread."""
        m = self.turn_motion
        return relation(self.pose_turn_rad, m.left_m, m.right_m)

    @cached_property
    def pose_turn_by_difference(self) -> Relation | None:
        """Measured turn from the difference of the treads' travel."""
        return relation(self.pose_turn_rad, self.turn_motion.difference_m)

    @cached_property
    def pose_turn_by_gyroscope(self) -> Relation | None:
        """Measured turn from that of the gyroscope, and its bias."""
        m = self.turn_motion
        return relation(self.pose_turn_rad, m.gyroscope_rad, m.lasts_s)
