"""Moments at which measured positions turn back, and no turn of the robot explains it."""

import numpy as np

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.once import once

PARTS_OF_NOISE = 6.0  # standard deviations of the positions, that a window is longer than
FAR = 0.2  # of the way of the treads at their ordinary fastest speed, that it is longer than
BEYOND_RAD = 0.8  # of the change of course, that is beyond what any treads can turn a robot
BY_TREADS = 1.5  # times the way of the faster tread, that it is shorter than: else it is a jump
NEAR = 2.5  # windows from the middle of one to that of the next but one, at most


@once
def reversals(evidence: Evidence) -> int:
    """How often positions go back where they came from, faster than the robot could turn round.

    A robot turns by the travel of both treads over its width at most, whatever their signs are:
    slip makes it turn less. What is beyond was driven backwards. Between two windows one is left
    out, in which the robot stops and goes both ways.
    """
    m = evidence.motion
    if len(m) < 3:
        return 0
    least_m = np.maximum(
        PARTS_OF_NOISE * evidence.position_sigma_m, FAR * evidence.fastest_m_s * m.lasts_s
    )
    far = np.isfinite(m.distance_m) & (m.distance_m > least_m)
    far &= m.distance_m < BY_TREADS * np.maximum(np.abs(m.left_m), np.abs(m.right_m))
    middle_s = (m.start_s + m.end_s) / 2
    near = middle_s[2:] - middle_s[:-2] < NEAR * m.lasts_s[1:-1]
    apart_rad = np.abs(np.angle(np.exp(1j * (m.course_rad[2:] - m.course_rad[:-2]))))
    turned_rad = (np.abs(m.left_m) + np.abs(m.right_m)) / evidence.run.robot.track_width
    most_rad = turned_rad[:-2] / 2 + turned_rad[1:-1] + turned_rad[2:] / 2
    back = far[2:] & far[:-2] & near & (apart_rad > most_rad + BEYOND_RAD)
    return int(np.sum(np.diff(back.astype(np.int8), prepend=0) == 1))
