"""What a recording says of itself: the same motion as treads, gyroscope and poses have it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.cleaned_recording import CleanedRecording
from odometry.checks.evidence.heading import (
    CONSISTENT,
    Heading,
    across_m,
    along_m,
    headings,
    turns_in_radians,
)
from odometry.checks.evidence.motion import Integrals, Motion, motion_between
from odometry.checks.evidence.scatter import scattered
from odometry.checks.statistics.relation import Relation, relation

ON_THE_SPOT = 0.3  # share of the difference of the treads: with less in common there is no course
FAR_SHARE = 0.3  # share of the usual longest distance from which the course of a window is known
APART = 1.6  # windows between the middles of two whose courses are compared, at most
MOST_RAD = 1.2  # turn of the course from one to the next: more is a change of direction
LEAST_TURNS = 20  # turns
CORRELATED = 0.85  # with gyroscope or treads: else noise, slip or a sensor far ahead prevails


def course_turns(motion: Motion, of: Integrals, width_m: float) -> tuple[Motion, FloatArray]:
    """Motion between the middles of neighbouring windows (K), and the turn (K,) of the course.

    Forwards and backwards are one direction, so that a sharp turn would count as one to the other
    side: NaN. All are NaN where they go with the turns of no other sensor: then noise prevails.
    """
    distance = motion.distance_m
    known = np.isfinite(distance)
    if not known.any():
        return motion.rows(np.empty(0, dtype=np.int64)), np.empty(0)
    far = known & (distance > FAR_SHARE * np.quantile(distance[known], 0.95))
    far &= np.abs(motion.mean_m) > ON_THE_SPOT * np.abs(motion.difference_m)
    middle_s = (motion.start_s + motion.end_s) / 2
    near = np.diff(middle_s) < APART * motion.lasts_s[1:]
    rows = np.flatnonzero(far[1:] & far[:-1] & near)
    begin_s, end_s = middle_s[rows], middle_s[rows + 1]
    turn = np.diff(motion.course_rad)[rows]
    turn = (turn + np.pi / 2) % np.pi - np.pi / 2
    nothing = np.full((len(rows), 2), np.nan)
    between = Motion(begin_s, end_s, *of.between(begin_s, end_s), nothing, nothing)
    is_sharp = between.least_turn_rad(width_m) > np.pi / 2
    turn = np.where(is_sharp | (np.abs(turn) > MOST_RAD), np.nan, turn)
    return between, np.where(_correlated(between, turn), turn, np.nan)


def _correlated(between: Motion, turn: FloatArray) -> bool:
    found = relation(turn, between.gyroscope_rad, between.lasts_s)
    found = found or relation(turn, between.left_m, between.right_m)
    return (
        found is not None and found.measured >= LEAST_TURNS and abs(found.correlation) > CORRELATED
    )


MOST_SHARP = 0.8  # share of the windows in sharp turns, from which these are used as well
COURSE_WINDOWS_S = (1.0, 2.0, 4.0)
MOST_TURN_RAD = 2.5  # between two poses, from which whole turns may be lost
DEGREES_RAD_S = 7.0  # no robot turns faster: the gyroscope is in degrees per second
UNRELATED = 0.3  # correlation below which turns have nothing in common
SOME_TURN = 0.2  # rad, or m of difference of the treads, in half a second
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
        """Windows of half a second or more, between poses where there are any; yaw in radians."""
        raw = self.raw_motion
        return raw.with_yaw(np.radians) if self.yaw_in_degrees else raw

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
            longer = motion_between(self.run, self.integrals, self.poses_used, window_s)
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
