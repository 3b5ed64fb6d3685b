"""Clean recordings in legal variants: none of them may raise a warning.

Other real recordings stand apart (`is_clean`): their references are poor, a warning there may be
true, and is shown with what was found, not counted as a false alarm.
"""

from dataclasses import dataclass

import numpy as np

from tests.blind.faults import legal, velocities
from tests.blind.faults.recordings import read_recording, write_recording

CLEAN = ("warthog_grass", "husky_tile", "marmotte_boreal", "simulated_")
POSE = frozenset({"good pose"})


@dataclass(frozen=True)
class Variant:
    """A legal change of a recording: its key, what it is, and what the recording must have."""

    key: str
    truth: str
    change: object
    needs: frozenset = frozenset()


VARIANTS = (
    Variant("as_it_is", "as recorded", legal.as_it_is),
    Variant("epoch", "stamps count from 1970 in all files", legal.epoch),
    Variant("common_offset", "stamps start anywhere, the same in all files", legal.common_offset),
    Variant("on_change", "odometry logged on change only", legal.on_change, POSE),
    Variant("other_rate", "odometry at 8 to 60 Hz", legal.other_rate, POSE),
    Variant("more_columns", "columns of unknown names", legal.more_columns),
    Variant("long_start", "at rest for minutes first", legal.long_start, POSE),
    Variant("slow_poses", "poses at 1 Hz, a fifth lost", legal.slow_poses, POSE),
    Variant("other_world", "the world turned and moved by 100 m", legal.other_world, POSE),
    Variant("utm", "positions in UTM with the yaw of UTM", legal.utm, POSE),
    Variant("wrapped", "yaw wrapped at pi or 2 pi", legal.wrapped, POSE),
    Variant("more_turns", "yaw counts turns from another number", legal.more_turns, POSE),
    Variant("no_gyro", "poses without a gyroscope", legal.no_gyro, POSE),
    Variant("no_pose", "a gyroscope without poses", legal.no_pose, POSE | {"gyro"}),
    Variant("no_yaw", "positions without yaw", legal.no_yaw, POSE),
    Variant("yaw_at_times", "yaw in some rows only", legal.yaw_at_times, POSE),
    Variant("gnss_alone", "noisy positions without yaw", legal.gnss_alone, POSE),
    Variant("pose_dropouts", "no poses for a while", legal.pose_dropouts, POSE),
    Variant("many_windows", "poses chained in many windows", legal.many_windows, POSE),
    Variant("one_repeated_row", "one row twice", legal.one_repeated_row, POSE),
    Variant("backwards", "the drive in reverse", legal.backwards, POSE),
    Variant("png", "images as PNG, some in grey", legal.png, frozenset({"images"})),
    Variant("velocities", "velocities of a sensor", velocities.right, POSE),
    Variant("carriage_returns", "lines end as on Windows", legal.carriage_returns),
)


def make_clean(variant, base, seed, folder):
    """Write a legal variant of a recording."""
    rng = np.random.default_rng([seed, *variant.key.encode()])
    return write_recording(variant.change(read_recording(base.folder), rng), folder)


def is_clean(base):
    """Whether nothing is known to be odd: a warning here is a false alarm."""
    return base.name.startswith((*CLEAN, "synthesised_"))
