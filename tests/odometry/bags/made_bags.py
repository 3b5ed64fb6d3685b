"""Bags made by rosbags' own writers: a robot that drives a known course."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

BEGIN_NS = 1_700_000_000_000_000_000
RADIUS_M, TRACK_M = 0.15, 0.6
KINDS = ("ros1", "ros1_bz2", "ros1_lz4", "sqlite3", "sqlite3_messages", "mcap", "mcap_zstd")


@cache
def store(kind: str) -> Any:
    """Types of ROS 1 or ROS 2."""
    return get_typestore(Stores.ROS1_NOETIC if kind.startswith("ros1") else Stores.ROS2_JAZZY)


@dataclass
class Bag:
    """A bag being made: messages by topic, stamps in seconds from its begin."""

    kind: str
    types: Any = None
    written: list[tuple[str, str, float, Any]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.types = store(self.kind)

    def message(self, name: str, /, **fields: Any) -> Any:
        made = self.types.types[name]
        return made(**fields)

    def time(self, t_s: float) -> Any:
        stamp_ns = BEGIN_NS + round(t_s * 1e9)
        return self.message(
            "builtin_interfaces/msg/Time", sec=stamp_ns // 10**9, nanosec=stamp_ns % 10**9
        )

    def header(self, t_s: float, frame: str = "") -> Any:
        seq = {"seq": 0} if self.kind.startswith("ros1") else {}
        return self.message("std_msgs/msg/Header", stamp=self.time(t_s), frame_id=frame, **seq)

    def add(self, topic: str, kind: str, t_s: float, message: Any) -> None:
        self.written.append((topic, kind, t_s, message))

    def define(self, name: str, text: str) -> None:
        """A message type of the bag's own."""
        types = get_typestore(Stores.EMPTY)
        types.register(self.types.fielddefs)
        types.register(get_types_from_msg(text, name))
        self.types = types

    # parts of messages

    def vector(self, x: float, y: float, z: float, name: str = "Vector3") -> Any:
        return self.message(f"geometry_msgs/msg/{name}", x=float(x), y=float(y), z=float(z))

    def quaternion(self, wxyz: Any) -> Any:
        w, x, y, z = map(float, wxyz)
        return self.message("geometry_msgs/msg/Quaternion", x=x, y=y, z=z, w=w)

    def pose(self, place: Any, wxyz: Any) -> Any:
        return self.message(
            "geometry_msgs/msg/Pose",
            position=self.vector(*place, name="Point"),
            orientation=self.quaternion(wxyz),
        )

    def twist(self, ahead: float, turn: float) -> Any:
        return self.message(
            "geometry_msgs/msg/Twist",
            linear=self.vector(ahead, 0, 0),
            angular=self.vector(0, 0, turn),
        )

    # whole messages

    def joints(self, t_s: float, names: list[str], position: Any, velocity: Any, **at: Any) -> None:
        message = self.message(
            "sensor_msgs/msg/JointState",
            header=self.header(at.get("stamp_s", t_s)),
            name=names,
            position=np.array(position, dtype=float),
            velocity=np.array(velocity, dtype=float),
            effort=np.zeros(0),
        )
        self.add(at.get("topic", "/joint_states"), "sensor_msgs/msg/JointState", t_s, message)

    def imu(self, t_s: float, gyro: Any, accel: Any, frame: str = "imu_link", **turn: Any) -> None:
        message = self.message(
            "sensor_msgs/msg/Imu",
            header=self.header(t_s, frame),
            orientation=self.quaternion(turn.get("wxyz", (1, 0, 0, 0))),
            orientation_covariance=np.array([turn.get("covariance", 0.0), *np.zeros(8)]),
            angular_velocity=self.vector(*gyro),
            angular_velocity_covariance=np.zeros(9),
            linear_acceleration=self.vector(*accel),
            linear_acceleration_covariance=np.zeros(9),
        )
        self.add("/imu/data", "sensor_msgs/msg/Imu", t_s, message)

    def odometry(self, topic: str, t_s: float, pose: Any, twist: Any, **frames: str) -> None:
        message = self.message(
            "nav_msgs/msg/Odometry",
            header=self.header(t_s, frames.get("world", "odom")),
            child_frame_id=frames.get("child", "base_link"),
            pose=self.message(
                "geometry_msgs/msg/PoseWithCovariance", pose=pose, covariance=np.zeros(36)
            ),
            twist=self.message(
                "geometry_msgs/msg/TwistWithCovariance", twist=twist, covariance=np.zeros(36)
            ),
        )
        self.add(topic, "nav_msgs/msg/Odometry", t_s, message)

    def pose_stamped(self, topic: str, t_s: float, pose: Any, frame: str = "world") -> None:
        message = self.message(
            "geometry_msgs/msg/PoseStamped", header=self.header(t_s, frame), pose=pose
        )
        self.add(topic, "geometry_msgs/msg/PoseStamped", t_s, message)

    def transform(self, t_s: float, parent: str, child: str, place: Any, wxyz: Any) -> Any:
        return self.message(
            "geometry_msgs/msg/TransformStamped",
            header=self.header(t_s, parent),
            child_frame_id=child,
            transform=self.message(
                "geometry_msgs/msg/Transform",
                translation=self.vector(*place),
                rotation=self.quaternion(wxyz),
            ),
        )

    def transforms(self, topic: str, t_s: float, transforms: list[Any]) -> None:
        message = self.message("tf2_msgs/msg/TFMessage", transforms=transforms)
        self.add(topic, "tf2_msgs/msg/TFMessage", t_s, message)

    def fix(self, t_s: float, *place: float, status: int = 0, frame: str = "gps_link") -> None:
        latitude, longitude, altitude = place
        message = self.message(
            "sensor_msgs/msg/NavSatFix",
            header=self.header(t_s, frame),
            status=self.message("sensor_msgs/msg/NavSatStatus", status=status, service=1),
            latitude=latitude,
            longitude=longitude,
            altitude=altitude,
            position_covariance=np.zeros(9),
            position_covariance_type=0,
        )
        self.add("/gps/fix", "sensor_msgs/msg/NavSatFix", t_s, message)

    def text(self, topic: str, t_s: float, text: str) -> None:
        name = "std_msgs/msg/String"
        self.add(topic, name, t_s, self.message(name, data=text))

    def image(self, t_s: float, pixels: Any, encoding: str) -> None:
        height, width = pixels.shape[:2]
        message = self.message(
            "sensor_msgs/msg/Image",
            header=self.header(t_s, "camera_optical"),
            height=height,
            width=width,
            encoding=encoding,
            is_bigendian=0,
            step=pixels.nbytes // height,
            data=pixels.reshape(-1).view(np.uint8),
        )
        self.add("/camera/image_raw", "sensor_msgs/msg/Image", t_s, message)

    def compressed(self, t_s: float, content: bytes, form: str = "jpeg") -> None:
        message = self.message(
            "sensor_msgs/msg/CompressedImage",
            header=self.header(t_s, "camera_optical"),
            format=form,
            data=np.frombuffer(content, dtype=np.uint8),
        )
        topic = "/camera/image_raw/compressed"
        self.add(topic, "sensor_msgs/msg/CompressedImage", t_s, message)

    def camera_info(
        self, t_s: float, size: Any, matrix: Any, distortion: Any, **others: Any
    ) -> None:
        letters = str.upper if self.kind.startswith("ros1") else str.lower
        matrix = np.asarray(matrix, dtype=float)
        projection = np.column_stack([others.get("projection", matrix), np.zeros(3)])
        roi = dict.fromkeys(("x_offset", "y_offset", "height", "width"), 0) | others.get("roi", {})
        fields = {
            letters("d"): np.array(distortion, dtype=float),
            letters("k"): matrix.reshape(-1),
            letters("r"): np.eye(3).reshape(-1),
            letters("p"): projection.reshape(-1),
        }
        message = self.message(
            "sensor_msgs/msg/CameraInfo",
            header=self.header(t_s, "camera_optical"),
            width=size[0],
            height=size[1],
            distortion_model=others.get("model", "plumb_bob"),
            binning_x=others.get("binning", 0),
            binning_y=others.get("binning", 0),
            roi=self.message("sensor_msgs/msg/RegionOfInterest", do_rectify=False, **roi),
            **fields,
        )
        self.add("/camera/camera_info", "sensor_msgs/msg/CameraInfo", t_s, message)

    # to a file

    def write(self, path: Path, only: Callable[[float], bool] = lambda _: True) -> Path:
        """Write what was added; messages whose stamp `only` denies are left out."""
        ros1 = self.kind.startswith("ros1")
        serialize = self.types.serialize_ros1 if ros1 else self.types.serialize_cdr
        with writer_of(self.kind, path) as writer:
            connections: dict[str, Any] = {}
            for topic, kind, t_s, message in sorted(self.written, key=lambda one: one[2]):
                if not only(t_s):
                    continue
                if topic not in connections:
                    connections[topic] = writer.add_connection(topic, kind, typestore=self.types)
                stamp_ns = BEGIN_NS + round(t_s * 1e9)
                writer.write(connections[topic], stamp_ns, serialize(message, kind))
        return path


def writer_of(kind: str, path: Path) -> Any:
    """A writer of a kind of bag."""
    if kind.startswith("ros1"):
        writer = Writer1(path)
        if kind != "ros1":
            writer.set_compression(Writer1.CompressionFormat[kind[5:].upper()])
        return writer
    plugin = StoragePlugin.MCAP if kind.startswith("mcap") else StoragePlugin.SQLITE3
    writer = Writer2(path, version=9, storage_plugin=plugin)
    if kind == "sqlite3_messages":
        writer.set_compression(CompressionMode.MESSAGE, CompressionFormat.ZSTD)
    if kind == "mcap_zstd":
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    return writer


def name_of(kind: str) -> str:
    """A path that fits a kind: a file of ROS 1, a folder of ROS 2."""
    return "drive.bag" if kind.startswith("ros1") else "drive"


def half_turn(yaw: float) -> tuple[float, float, float, float]:
    """Quaternion (w, x, y, z) of a yaw."""
    return float(np.cos(yaw / 2)), 0.0, 0.0, float(np.sin(yaw / 2))


def course(duration_s: float = 20.0, rate_hz: float = 20.0) -> Iterator[tuple[float, ...]]:
    """Stamps, tread speeds and the ideal pose: t, left, right [m/s], x, y, yaw."""
    x = y = yaw = 0.0
    for step in range(round(duration_s * rate_hz)):
        t_s = step / rate_hz
        ahead, turn = 0.6 + 0.3 * np.sin(t_s), 0.5 * np.cos(0.7 * t_s)
        left, right = ahead - turn * TRACK_M / 2, ahead + turn * TRACK_M / 2
        yield t_s, left, right, x, y, yaw
        middle = yaw + turn / rate_hz / 2
        chord = ahead / rate_hz * np.sinc(turn / rate_hz / (2 * np.pi))
        x, y, yaw = x + chord * np.cos(middle), y + chord * np.sin(middle), yaw + turn / rate_hz
