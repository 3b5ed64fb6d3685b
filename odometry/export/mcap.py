"""The odometer, the estimate and the terrain of a result as one MCAP file (extra `bags`).

Topics: `/terrain_odometry/odometer` and `/terrain_odometry/estimate` (nav_msgs/Odometry, in the
frame of pose.csv, named `map`), `/terrain_odometry/terrain` (std_msgs/String: the terrain in force)
and `/terrain_odometry/seen` (the label of each image). A pose of the plane says nothing of z, roll
and pitch: their variance is 1e6, as drivers of ROS write it. The twist is that of the motion to the
next pose; its covariance is not known, and as large.
"""

import shutil
from collections.abc import Callable, Iterator
from heapq import merge
from operator import itemgetter
from pathlib import Path
from typing import Any

import numpy as np

from odometry.arrays import AnyArray, FloatArray
from odometry.errors import ExportError
from odometry.export.source import ExportSource
from odometry.geometry import se2, se3
from odometry.installed import extra_module
from odometry.io.euroc import NANOSECONDS, nanoseconds
from odometry.tables.table import Table

TOPICS = "/terrain_odometry"
FRAME, BODY = "map", "base_link"
NOT_MEASURED = 1e6  # variance of what is not known
LAST_S = 2**31  # seconds of a ROS 2 stamp are signed 32-bit
PLANE = (0, 1, 5)  # x, y and yaw of x y z roll pitch yaw
ODOMETRY, STRING = "nav_msgs/msg/Odometry", "std_msgs/msg/String"
Message = tuple[str, float, Any]  # topic, stamp, message


def write(source: ExportSource, folder: Path) -> None:
    """Write results.mcap, its messages in order of time.

    Raises
    ------
    ExtraError
        If rosbags is not installed.
    ExportError
        If a stamp is none that ROS has.
    """
    rosbag2 = extra_module("rosbags.rosbag2", "bags", "MCAP")
    store = _typestore()
    streams = _streams(source, store.types)
    bag = folder / "results"
    with rosbag2.Writer(bag, version=9, storage_plugin=rosbag2.StoragePlugin.MCAP) as writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=store)
            for topic, (kind, _) in streams.items()
        }
        ordered = merge(*(messages for _, messages in streams.values()), key=itemgetter(1))
        for topic, stamp_s, message in ordered:
            data = store.serialize_cdr(message, message.__msgtype__)
            writer.write(connections[topic], nanoseconds(stamp_s), data)
    (bag / "results.mcap").replace(folder / "results.mcap")
    shutil.rmtree(bag)


def _typestore() -> Any:
    typesys = extra_module("rosbags.typesys", "bags", "MCAP")
    return typesys.get_typestore(typesys.Stores.ROS2_JAZZY)


def _streams(source: ExportSource, types: Any) -> dict[str, tuple[str, Iterator[Message]]]:
    """Type and messages in order of time, by topic; made one at a time."""
    streams = {}
    for name in ("odometer", "estimate"):
        topic = f"{TOPICS}/{name}"
        streams[topic] = ODOMETRY, _odometry(topic, source.table(name), types)
    if (source.folder / "terrain.csv").exists():
        table = source.table("terrain")
        for name, column in (("terrain", "terrain_in_force"), ("seen", "label")):
            topic = f"{TOPICS}/{name}"
            streams[topic] = STRING, _labels(topic, table.stamps_s, table[column], types[STRING])
    return streams


def _labels(
    topic: str, stamps_s: FloatArray, labels: AnyArray, string: Callable[[str], Any]
) -> Iterator[Message]:
    for stamp_s, label in zip(stamps_s.tolist(), labels, strict=True):
        if str(label):
            yield topic, stamp_s, string(str(label))


def _odometry(topic: str, table: Table, types: Any) -> Iterator[Message]:
    poses = table.stack("x", "y", "yaw")
    covariances = _covariances(table)
    twists = _twists(table.stamps_s, poses)
    zero = np.zeros(len(poses))
    places = np.column_stack([poses[:, :2], zero])
    rotations = se3.rotation_from_roll_pitch_yaw(np.column_stack([zero, zero, poses[:, 2]]))
    quaternions = se3.quaternion_wxyz(rotations).tolist()
    stamp, frame = types["builtin_interfaces/msg/Time"], types["std_msgs/msg/Header"]
    pose, twist = _pose_maker(types), _twist_maker(types)
    for k, stamp_s in enumerate(table.stamps_s.tolist()):
        header = frame(stamp(*_whole_and_rest(stamp_s)), FRAME)
        posed = pose(places[k], quaternions[k], covariances[k])
        yield topic, stamp_s, types[ODOMETRY](header, BODY, posed, twist(twists[k]))


def _pose_maker(types: Any) -> Callable[[FloatArray, list[float], FloatArray], Any]:
    """Makes geometry_msgs/PoseWithCovariance of place, quaternion w first and covariance."""
    point, quaternion, pose, whole = (
        types[f"geometry_msgs/msg/{name}"]
        for name in ("Point", "Quaternion", "Pose", "PoseWithCovariance")
    )

    def make(place: FloatArray, wxyz: list[float], covariance: FloatArray) -> Any:
        w, x, y, z = wxyz
        return whole(pose(point(*place.tolist()), quaternion(x, y, z, w)), covariance)

    return make


def _twist_maker(types: Any) -> Callable[[FloatArray], Any]:
    """Makes geometry_msgs/TwistWithCovariance of v_x, v_y, omega."""
    vector, twist, whole = (
        types[f"geometry_msgs/msg/{name}"] for name in ("Vector3", "Twist", "TwistWithCovariance")
    )
    unknown = NOT_MEASURED * np.eye(6).ravel()

    def make(moving: FloatArray) -> Any:
        v_x, v_y, omega = moving.tolist()
        return whole(twist(vector(v_x, v_y, 0.0), vector(0.0, 0.0, omega)), unknown)

    return make


def _whole_and_rest(stamp_s: float) -> tuple[int, int]:
    """Seconds and nanoseconds of a ROS 2 stamp."""
    if not 0 <= stamp_s < LAST_S:
        raise ExportError(f"stamp {stamp_s!r} s; ROS 2 has stamps from 0 to {LAST_S} s")
    return divmod(nanoseconds(stamp_s), NANOSECONDS)


def _twists(stamps_s: FloatArray, poses: FloatArray) -> FloatArray:
    """Body twists (N, 3) from each pose to the next; the last one holds on."""
    if len(poses) < 2:
        return np.zeros((len(poses), 3))
    twists = se2.log(se2.between(poses[:-1], poses[1:])) / np.diff(stamps_s)[:, None]
    return np.concatenate([twists, twists[-1:]])


def _covariances(table: Table) -> FloatArray:
    """Covariances (N, 36) of x y z roll pitch yaw, by rows."""
    plane = np.zeros((len(table), 3, 3))
    names = ("x", "y", "yaw")
    for row, first in enumerate(names):
        plane[:, row, row] = table[f"sigma_{first}"] ** 2
        for column, second in enumerate(names[row + 1 :], row + 1):
            name = f"covariance_{first}_{second}"
            if name in table:
                plane[:, row, column] = plane[:, column, row] = table[name]
    return _six_by_six(plane)


def _six_by_six(plane: FloatArray) -> FloatArray:
    whole = np.tile(NOT_MEASURED * np.eye(6), (len(plane), 1, 1))
    whole[:, np.array(PLANE)[:, None], PLANE] = plane
    return whole.reshape(-1, 36)
