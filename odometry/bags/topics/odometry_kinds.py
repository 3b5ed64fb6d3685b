"""Which sensors an odometry is of: wheels, cameras, lidar, satellites, or a filter of several.

Only that of the wheels shows how the treads slip. Any other one, taken as wheel speeds, gives a
model of a robot that does not slip, and nothing later contradicts it.
"""

import math
import re
from typing import NamedTuple

from odometry.bags.files.topic import PLACE, VELOCITY, Topic, farthest
from odometry.bags.topics.message_fields import ODOMETRY, body_frame

WHEELS, VISUAL, LIDAR, SATELLITES, FUSED, TRUTH, UNKNOWN = (
    "wheel odometry",
    "visual odometry",
    "odometry or SLAM of a lidar, or of a map",
    "odometry of satellites",
    "odometry of a filter or of inertial sensors",
    "measured poses",
    "odometry",
)
# A sideways or upward speed [m/s] or way up [m] above these is no rounding. Odometry of
# skid-steer wheels has neither: it is integrated from a speed ahead and a turn rate.
SIDEWAYS_M_S, UPWARDS_M = 0.01, 0.05
BEGIN, END = r"(^|[/_.-])", r"(?=[/_.-]|\d|$)"


def _words(anywhere: str, whole: str = "", begins: str = "") -> re.Pattern[str]:
    parts = [anywhere]
    if whole:
        parts.append(f"{BEGIN}({whole}){END}")
    if begins:
        parts.append(f"{BEGIN}({begins})")
    return re.compile("|".join(parts), re.IGNORECASE)


# In this order: the first that a part of a name matches
NAMES: dict[str, re.Pattern[str]] = {
    TRUTH: _words("truth|mocap|vicon|optitrack|qualisys|vrpn|rtk|total_station|prism|leica|natnet"),
    FUSED: _words(
        "filter|fusion|fused|(?<!vins_)estimat|local_?iz|combined|inertial|mavros|mavlink|ardupilot|pixhawk",
        "ekf|ukf|eskf|imu|ahrs|local|local_position|px4|fuse",
    ),
    VISUAL: _words(
        r"visual|vio(?![ru])|vins|camera|t265|realsense|stereo|rgbd|msckf|okvis|rovio|kimera|"
        "basalt|optical_?flow",
        r"vo|svo|dso|cam|odomimu|d4\d5",
        "zed|oak|mono",
    ),
    LIDAR: _words(
        "slam|lio(?!n)|loam|icp|lidar|laser|rtabmap|amcl|cartographer|ouster|velodyne|hesai|livox|"
        "robosense|aft_mapped|to_init|rf2o",
        "kiss|genz|ndt|dlo|map|mapping|scan|points?|orb|glim",
        "orb_|map_|mapping_|scan_",
    ),
    SATELLITES: _words(
        "gps|gnss|global|novatel|septentrio|ublox|navsat|xsens|vectornav|oxts|applanix|microstrain",
        r"utm|ins|sbg|oem\d?",
    ),
    WHEELS: _words(
        "wheel|encoder|controller|diff_?drive|skid|mobile_?base|velocity_ctrl|rosaria|chassis|"
        "motor|tread",
        "base|drive|platform|tracks?|odom_raw",
    ),
}
SENSOR_FRAMES = {
    VISUAL: _words("camera|optical|t265|realsense|stereo", "cam", "zed|oak"),
    LIDAR: _words("lidar|laser|velodyne|ouster|livox|hesai|rslidar|to_init|aft_mapped", "os"),
    SATELLITES: _words("gps|gnss|antenna"),
    FUSED: _words("imu|inertial"),
}
LOAM_WORLD = "camera_init"  # the world frame of the LOAM family, FAST-LIO among them
FAST_LIO = "Odometry"  # its topic, which it writes with a capital letter


class Kind(NamedTuple):
    """What odometry a topic holds: one of the kinds above, and by which sign."""

    name: str
    sign: str

    @property
    def of_wheels(self) -> bool:
        """Whether it may be of the wheels."""
        return self.name in (WHEELS, UNKNOWN)


def kind_of(topic: Topic) -> Kind:
    """What odometry, or twist, a topic holds by its frames, its name and its motion."""
    odometry = topic.message_type == ODOMETRY
    named = kind_of_name(topic.name)
    if named in (TRUTH, FUSED, VISUAL, LIDAR, SATELLITES):
        return Kind(named, "its name")
    if odometry:
        frame = body_frame(topic.sample)
        for name, words in SENSOR_FRAMES.items():
            if words.search(frame):
                return Kind(name, f"its frame {frame}")
        if topic.sample.header.frame_id.lstrip("/") == LOAM_WORLD:
            return Kind(LIDAR, f"its world {LOAM_WORLD}")
    if named == WHEELS:
        return Kind(WHEELS, "its name")
    if odometry and topic.name.rsplit("/", 1)[-1] == FAST_LIO:
        return Kind(LIDAR, "its name, which is FAST-LIO's")
    moves = no_wheels_move(topic)
    return Kind(FUSED, moves) if moves else Kind(UNKNOWN, "")


def kind_of_name(name: str) -> str:
    """Kind by the last part of a name that says one; a part that says two is of a filter."""
    for part in reversed(name.strip("/").split("/")):
        found = [kind for kind, words in NAMES.items() if words.search(part)]
        if WHEELS in found and len(found) > 1:
            return found[0] if found[0] == TRUTH else FUSED
        if found:
            return found[0]
    return UNKNOWN


def no_wheels_move(topic: Topic) -> str:
    """A motion that no odometry of skid-steer wheels has; empty where it has none."""
    side = farthest(topic.ranges, VELOCITY, ["side"])
    if side > SIDEWAYS_M_S:
        return f"its sideways speed, up to {side:.2g} m/s"
    least, most = topic.ranges.get((PLACE, "z"), (0.0, 0.0))
    if math.isfinite(most - least) and most - least > UPWARDS_M:
        return f"its height, which changes by {most - least:.2g} m"
    return ""
