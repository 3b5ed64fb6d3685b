"""Checks that the data of a run do not allow: a mode may then be named for another reason."""

from odometry.modes.followed import Followed
from odometry.modes.velocity import VelocityModes


def not_checked(followed: Followed) -> tuple[str, ...]:
    """Sentences without their full stop; of velocity modes alone, which use no poses.

    To a yaw rate a gyroscope whose scale is off is another terrain, and so is a load on both tyres.
    """
    modes, signals = followed.mode_set.modes, followed.signals
    if not isinstance(modes, VelocityModes):
        return ()
    found = []
    if signals.heading_check is None:
        found.append(
            "the scale of the gyroscope, without measured headings: one that is off turns as "
            "another terrain does, and yaw rate alone does not distinguish the two"
        )
    if signals.travel is None or modes.speed_power is None:
        missing = "measured positions" if signals.travel is None else "measured speeds in the set"
        found.append(
            f"the distance, without {missing}: a load on both tyres turns as another terrain does"
        )
    return tuple(found)
