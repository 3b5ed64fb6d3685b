"""What Imu messages of a topic measure: turn rates, accelerations, or both."""

from odometry.bags.files.topic import VELOCITY, Topic, moved

RATE, FORCE = "angular_velocity", "linear_acceleration"
WHAT = {RATE: "angular velocities", FORCE: "accelerations"}


def measures(topic: Topic, what: str) -> bool:
    """Whether a topic measures RATE or FORCE: it is stated as measured, and other than zero.

    Cameras with an inertial sensor send each in a topic of its own, with zeros for the other.
    """
    return any(moved(topic.ranges, VELOCITY, f"{what}.{axis}") for axis in "xyz")


def not_measured(topic: Topic) -> list[str]:
    """What is to be said of what an Imu does not measure."""
    left = [words for what, words in WHAT.items() if not measures(topic, what)]
    if not left:
        return []
    return [
        f"imu: {topic.name}: {' and '.join(left)} are left out: zero all the time, or said not to "
        "be measured (a covariance that begins with -1)"
    ]
