"""A sensor so far from the centre that it swings sideways more than the robot drives."""

from dataclasses import replace

from odometry.checks.evidence.evidence import Evidence
from odometry.checks.evidence.heading import Heading, across_m, along_m, headings
from odometry.checks.evidence.once import once
from odometry.checks.statistics.relation import relation

# Metres along the course, and along the yaw, for each one of the treads: 0.01 to 0.06, and 0.96 to
# 0.98, of a robot that pivots with a sensor two lengths ahead or behind. On ice robots have 0.24.
ACROSS, ALONG = 0.2, (0.55, 1.2)
TIMES = 8.0  # standard deviations of the swing
EXPLAINED = 0.9  # of the way along the yaw by the treads, and across it by the turns


@once
def swinging_sensor(evidence: Evidence) -> Heading | None:
    """The yaw as heading, where the course is that of the swing and the yaw that of the robot.

    None elsewhere: also of a yaw that is off by 90 degrees, along which the treads do not drive.
    """
    m, turn_rad = evidence.motion, evidence.turn_rad(evidence.motion)
    found = evidence.heading or headings(m, turn_rad).get("radians")
    if found is None or not evidence.yaw_measured:
        return None
    yaw = replace(found, offset_rad=0.0)
    along = relation(along_m(m, yaw), m.mean_m, turn_rad)
    across = relation(across_m(m, yaw), turn_rad)
    course = relation(evidence.forward_m, m.mean_m, turn_rad)
    if along is None or across is None or not across.certain(0, TIMES):
        return None
    if course is not None and abs(course.coefficients[0]) > ACROSS:
        return None
    is_robots = ALONG[0] < along.coefficients[0] < ALONG[1]
    return yaw if is_robots and min(along.explained, across.explained) > EXPLAINED else None
