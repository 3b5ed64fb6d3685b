"""By how much the course of positions turns from one window to the next."""

import numpy as np

from odometry.arrays import FloatArray
from odometry.checks.evidence.motion import Integrals, Motion
from odometry.checks.statistics.relation import relation

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
