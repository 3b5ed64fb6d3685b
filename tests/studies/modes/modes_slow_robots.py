"""Modes of robots slower than 0.15 m/s that are calibrated on one drive of each terrain.

    python -m tests.studies.modes.modes_slow_robots [--first-seed 0] [--seeds 90] [--out FOLDER]

Robots of `tests/blind/modes/any_robot.py`, whose gyroscope has a bias of its own on each drive,
0.005 rad/s in the standard deviation: as large as what distinguishes terrains of a slow robot. Each
makes five drives: a clean one, two whose motion no mode describes from a moment on (one onto a
terrain that was not calibrated), and two whose record is at fault. Seeds of faster robots have no
rows.
"""

from dataclasses import replace

from tests.blind.modes import any_robot
from tests.studies.modes.modes_any_robot import run, studied

SLOW_M_S = 0.15
BIAS_RAD_S = 0.005


def study(seed):
    """The rows of a slow robot, none of others."""
    world = replace(any_robot.world_of(seed), gyro_bias_rad_s=BIAS_RAD_S)
    if world.robot.fastest_m_s >= SLOW_M_S:
        return []
    kinds = ("clean", "unseen_terrain", any_robot.OUTSIDE[1 + seed % 2])
    records = (any_robot.RECORD[(seed + later) % len(any_robot.RECORD)] for later in (0, 3))
    return studied(world, seed, (*kinds, *records), drives=1)


if __name__ == "__main__":
    run(study, __doc__, "modes_slow_robots")
