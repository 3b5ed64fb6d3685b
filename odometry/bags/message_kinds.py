"""Types of messages that an import knows, and where poses stand in them."""

from collections.abc import Callable
from typing import Any

JOINTS = "sensor_msgs/msg/JointState"
ODOMETRY = "nav_msgs/msg/Odometry"
IMU = "sensor_msgs/msg/Imu"
FIX = "sensor_msgs/msg/NavSatFix"
IMAGE = "sensor_msgs/msg/Image"
COMPRESSED_IMAGE = "sensor_msgs/msg/CompressedImage"
CAMERA_INFO = "sensor_msgs/msg/CameraInfo"
TRANSFORM = "geometry_msgs/msg/TransformStamped"
POINT = "geometry_msgs/msg/PointStamped"
TRANSFORM_LISTS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")

# Types with a twist (linear ahead, angular about z), and the fields that hold it
TWISTS: dict[str, Callable[[Any], Any]] = {
    ODOMETRY: lambda message: message.twist.twist,
    "geometry_msgs/msg/TwistStamped": lambda message: message.twist,
    "geometry_msgs/msg/TwistWithCovarianceStamped": lambda message: message.twist.twist,
}
# Types with a pose (position and orientation, or translation and rotation), and its fields
POSES: dict[str, Callable[[Any], Any]] = {
    ODOMETRY: lambda message: message.pose.pose,
    "geometry_msgs/msg/PoseStamped": lambda message: message.pose,
    "geometry_msgs/msg/PoseWithCovarianceStamped": lambda message: message.pose.pose,
    TRANSFORM: lambda message: message.transform,
}
IMAGES = (IMAGE, COMPRESSED_IMAGE)
# Types whose numbers are no speeds of wheels, whatever a user says
NO_WHEELS = (
    *(kind for kind in POSES if kind not in TWISTS),
    *(*TRANSFORM_LISTS, *IMAGES, IMU, FIX, POINT, CAMERA_INFO),
)


def body_frame(message: Any) -> str:
    """The frame whose pose or readings a message holds; empty where it does not say.

    Odometry and transforms name it as the child. A PoseStamped names the frame of the world
    alone.
    """
    child = getattr(message, "child_frame_id", "")
    if child or hasattr(message, "pose"):
        return str(child).lstrip("/")
    return str(getattr(getattr(message, "header", None), "frame_id", "")).lstrip("/")
